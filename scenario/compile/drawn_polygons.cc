// SPDX-License-Identifier: BSD-3-Clause
// Scales the rings, then finds which rings contain which.
#include "scenario/compile/drawn_polygons.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/indexed_rings.h"
#include "scenario/parse/findings.h"
#include "target/contour/contour.h"
#include "target/geo/svg_painter.h"

namespace ergocast {
namespace {

/// How much the ratio of a drawing's sides may differ from the domain's.
constexpr double kSameRatio = 1e-3;

constexpr double kMostSolid = 0.9;
/// Corners of exact shapes that are compared with each other; more are refused later.
constexpr std::size_t kMostCompared = 4096;

/// The rings around ring `inner`.
std::vector<std::size_t> around(const std::vector<Ring>& rings, std::size_t inner) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (i != inner && contains(rings[i], rings[inner].front())) found.push_back(i);
  }
  return found;
}

/// Twice the area; positive if the ring goes round anticlockwise.
double turn_of(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// The rings that have solid on one side only, by the fill-rule nonzero.
std::vector<Ring> edges_of(const std::vector<Ring>& rings) {
  std::vector<Ring> edges;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    int outside = 0;
    for (const std::size_t other : around(rings, i)) outside += turn_of(rings[other]) > 0 ? 1 : -1;
    const int inside = outside + (turn_of(rings[i]) > 0 ? 1 : -1);
    if ((inside == 0) != (outside == 0)) edges.push_back(rings[i]);
  }
  return edges;
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

using Placed = Result<std::vector<PlacedPolygon>, PolygonFileProblem>;

tl::unexpected<PolygonFileProblem> refuse(std::string what, std::string remedy) {
  return failure(PolygonFileProblem{"", std::move(what), std::move(remedy)});
}

/// From units of the drawing to metres.
class Placement {
 public:
  Placement(const Drawing& drawing, const Box& domain)
      : origin_m_(domain.origin_m.head<2>()),
        scale_(domain.size_m.head<2>().array() / drawing.size.array()) {}

  bool same_ratio() const { return std::abs(scale_.x() / scale_.y() - 1) <= kSameRatio; }
  Ring ring(const Ring& drawn, double unit = 1) const {
    Ring ring;
    for (const Eigen::Vector2d& corner : drawn)
      ring.emplace_back(origin_m_.array() + scale_ * unit * corner.array());
    return ring;
  }

 private:
  Eigen::Vector2d origin_m_;
  Eigen::Array2d scale_;
};

std::vector<PlacedPolygon> exact(const Drawing& drawing, const Placement& place) {
  std::vector<PlacedPolygon> placed;
  for (const DrawnShape& shape : drawing.shapes) {
    std::vector<Ring> rings;
    for (const auto& drawn : shape.rings) rings.push_back(place.ring(drawn));
    if (!shape.even_odd) rings = edges_of(rings);
    for (Polygon& polygon : polygons_of(rings))
      placed.push_back({shape.element, std::move(polygon)});
  }
  return placed;
}

/// Why exact polygons have to be painted to be right; nothing if they do not.
std::optional<std::string> conflict(const Drawing& drawing,
                                    const std::vector<PlacedPolygon>& placed, bool joined) {
  std::size_t corners = 0;
  for (const DrawnShape& shape : drawing.shapes) {
    const std::vector<Ring>& rings = shape.rings;
    for (const Ring& ring : rings) corners += ring.size();
    if (corners <= kMostCompared && touching_edges(rings)) return shape.element + " crosses itself";
  }
  if (!joined || corners > kMostCompared) return std::nullopt;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Rings rings = rings_of(placed[i].polygon);
    for (std::size_t j = 0; j < i; ++j) {
      Rings both = rings_of(placed[j].polygon);
      const bool inside = contains(placed[i].polygon, both.front().front()) ||
                          contains(placed[j].polygon, rings.front().front());
      both.insert(both.end(), rings.begin(), rings.end());
      if (inside || touching_edges(both))
        return placed[i].member + " touches or overlaps " + placed[j].member;
    }
  }
  return std::nullopt;
}

Placed painted(const Drawing& drawing, const Placement& place, bool solid_white) {
  const auto paint = paint_svg(drawing.to_paint, drawing.size, solid_white);
  if (!paint) return failure(paint.error());
  // Rows of cells begin at the top.
  const double below = drawing.size.y() - paint->cell * static_cast<double>(paint->solid.rows());
  if (paint->hair) {
    const auto [column, row] = *paint->hair;
    const Ring at = place.ring({{column + 0.5, row + 0.5 + below / paint->cell}}, paint->cell);
    const auto about = [](double at_m) { return shortest(std::round(at_m * 100) / 100); };
    return refuse("shows something at x " + about(at[0].x()) + ", y " + about(at[0].y()) +
                      " m that is too thin and bright to be solid",
                  "paint it darker or wider, or delete it");
  }
  std::size_t solid = 0;
  for (std::size_t i = 0; i < paint->solid.size(); ++i) solid += paint->solid[i];
  if (solid == 0)
    return refuse("shows nothing that is solid: paint darker than nearly white",
                  "draw inside the page, or write solid_white: true");
  if (static_cast<double>(solid) > kMostSolid * static_cast<double>(paint->solid.size()))
    return refuse("more than 90 % of it is solid", "remove its background, or paint it white");
  const auto polygons = polygons_around(paint->solid, Straightening::kOutwards);
  if (!polygons) return refuse("is full of specks", "leave out hatches and textures");
  std::vector<PlacedPolygon> placed;
  for (const Polygon& polygon : *polygons) {
    const auto put = [&](Ring ring) {
      for (Eigen::Vector2d& corner : ring) corner.y() += below / paint->cell;
      return place.ring(ring, paint->cell);
    };
    PlacedPolygon& one = placed.emplace_back();
    one.polygon.outline = put(polygon.outline);
    for (const Ring& hole : polygon.holes) one.polygon.holes.push_back(put(hole));
    const Eigen::Vector2d& at_m = one.polygon.outline.front();
    one.member = "the shape at x " + shortest(at_m.x()) + ", y " + shortest(at_m.y()) + " m";
  }
  return placed;
}

}  // namespace

Result<std::vector<PlacedPolygon>, PolygonFileProblem> place_drawing(const Drawing& drawing,
                                                                     const Box& domain,
                                                                     const DrawnAs& as) {
  const Placement place(drawing, domain);
  const Eigen::Vector2d size_m = domain.size_m.head<2>();
  if (!place.same_ratio()) {
    return refuse("its viewBox is " + shortest(drawing.size.x()) + " by " +
                      shortest(drawing.size.y()) + ", and the domain has another shape",
                  "set domain.size_y_m to " +
                      shortest(size_m.x() * drawing.size.y() / drawing.size.x()) +
                      ", or the drawing's size to the domain's");
  }
  std::string because = drawing.paint_because;
  if (because.empty()) {
    auto placed = exact(drawing, place);
    const auto why = conflict(drawing, placed, as.joined);
    if (!why) return placed;
    because = *why;
  }
  auto placed = painted(drawing, place, as.solid_white);
  if (!placed) placed.error().what += " (it is painted because " + because + ")";
  return placed;
}

}  // namespace ergocast
