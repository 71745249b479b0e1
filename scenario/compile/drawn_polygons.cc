// SPDX-License-Identifier: BSD-3-Clause
// Scales the rings, then finds which rings contain which.
#include "scenario/compile/drawn_polygons.h"

#include <algorithm>
#include <cmath>

#include "scenario/parse/findings.h"

namespace ergocast {
namespace {

/// How much the ratio of a drawing's sides may differ from the domain's.
constexpr double kSameRatio = 1e-3;

/// The rings around ring `inner`.
std::vector<std::size_t> around(const std::vector<Ring>& rings, std::size_t inner) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (i != inner && contains(rings[i], rings[inner].front())) found.push_back(i);
  }
  return found;
}

/// Rings that touch or cross come out in any order: the check of the polygons refuses them.
std::vector<Polygon> polygons_of(const std::vector<Ring>& rings) {
  std::vector<std::vector<std::size_t>> outer;
  for (std::size_t i = 0; i < rings.size(); ++i) outer.push_back(around(rings, i));
  std::vector<Polygon> polygons;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (outer[i].size() % 2 != 0) continue;
    Polygon& polygon = polygons.emplace_back();
    polygon.outline = rings[i];
    for (std::size_t hole = 0; hole < rings.size(); ++hole) {
      const bool inside = std::find(outer[hole].begin(), outer[hole].end(), i) != outer[hole].end();
      if (inside && outer[hole].size() == outer[i].size() + 1) polygon.holes.push_back(rings[hole]);
    }
  }
  return polygons;
}

}  // namespace

Result<std::vector<PlacedPolygon>, PolygonFileProblem> place_drawing(const Drawing& drawing,
                                                                     const Box& domain) {
  const Eigen::Vector2d size_m = domain.size_m.head<2>();
  const Eigen::Array2d scale = size_m.array() / drawing.size.array();
  if (!(std::abs(scale.x() / scale.y() - 1) <= kSameRatio)) {
    return failure(PolygonFileProblem{
        "",
        "its viewBox is " + shortest(drawing.size.x()) + " by " + shortest(drawing.size.y()) +
            ", and the domain has another shape",
        "set domain.size_y_m to " + shortest(size_m.x() * drawing.size.y() / drawing.size.x()) +
            ", or the drawing's size to the domain's"});
  }
  std::vector<PlacedPolygon> placed;
  for (const DrawnShape& shape : drawing.shapes) {
    std::vector<Ring> rings;
    for (const auto& drawn : shape.rings) {
      Ring& ring = rings.emplace_back();
      for (const Eigen::Vector2d& corner : drawn)
        ring.emplace_back(domain.origin_m.head<2>().array() + scale * corner.array());
    }
    for (Polygon& polygon : polygons_of(rings))
      placed.push_back({shape.element, std::move(polygon)});
  }
  return placed;
}

}  // namespace ergocast
