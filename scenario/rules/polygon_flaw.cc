// SPDX-License-Identifier: BSD-3-Clause
// Tests every ring and every pair of edges, then whether each hole lies inside the outline.
#include "scenario/rules/polygon_flaw.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "scenario/parse/findings.h"

namespace ergocast {
namespace {

const Ring& ring_of(const Polygon& polygon, int ring) {
  return ring == 0 ? polygon.outline : polygon.holes[static_cast<std::size_t>(ring - 1)];
}

std::string name_of(std::size_t ring, std::size_t corner) {
  return std::string(ring == 0 ? "" : "holes[" + std::to_string(ring - 1) + "].") + "vertices[" +
         std::to_string(corner) + "]";
}

/// Whether all corners are on one line, up to rounding.
bool on_a_line(const Ring& ring) {
  Eigen::Vector2d along(0, 0);
  for (const Eigen::Vector2d& corner : ring)
    if ((corner - ring[0]).squaredNorm() > along.squaredNorm()) along = corner - ring[0];
  const double most = 1e-12 * along.squaredNorm();
  return std::ranges::all_of(ring, [&](const Eigen::Vector2d& corner) {
    const Eigen::Vector2d to = corner - ring[0];
    return std::abs(along.x() * to.y() - along.y() * to.x()) <= most;
  });
}

std::optional<PolygonFlaw> flaw_of_ring(const Ring& ring, int hole) {
  if (ring.size() < 3) {
    return PolygonFlaw{hole, std::to_string(ring.size()) + " vertices enclose nothing",
                       "give it at least three vertices"};
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t next = (i + 1) % ring.size();
    if (ring[i] != ring[next]) continue;
    return PolygonFlaw{
        hole,
        "vertices[" + std::to_string(i) + "] and vertices[" + std::to_string(next) +
            "] are the same",
        next == 0 ? "leave out the last: a ring closes by itself" : "leave out one of them",
        static_cast<int>(next == 0 ? i : next)};
  }
  if (on_a_line(ring))
    return PolygonFlaw{hole, "all its vertices are on one line", "move one of them off the line"};
  return {};
}

std::optional<PolygonFlaw> flaw_of_edges(const Polygon& polygon) {
  Rings rings = {polygon.outline};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  const auto found = touching_edges(rings);
  if (!found) return {};
  return PolygonFlaw{static_cast<int>(found->ring) - 1,
                     "the edges that begin at " + name_of(found->other_ring, found->other_corner) +
                         " and " + name_of(found->ring, found->corner) + " cross or touch",
                     "move one of them, or write two polygons"};
}

/// @pre no edges touch, so that a ring is inside another entirely or not at all
std::optional<PolygonFlaw> flaw_of_holes(const Polygon& polygon) {
  const int holes = static_cast<int>(polygon.holes.size());
  for (int i = 0; i < holes; ++i) {
    const Eigen::Vector2d& corner = ring_of(polygon, i + 1)[0];
    if (!contains(polygon.outline, corner)) {
      return PolygonFlaw{i, "the hole is outside the polygon", "move it inside, or remove it"};
    }
    for (int j = 0; j < holes; ++j) {
      if (i == j || !contains(ring_of(polygon, j + 1), corner)) continue;
      return PolygonFlaw{i, "the hole is inside holes[" + std::to_string(j) + "]", "remove it"};
    }
  }
  return {};
}

}  // namespace

std::optional<PolygonFlaw> flaw_of(const Polygon& polygon, double min_area_m2) {
  for (int ring = 0; ring <= static_cast<int>(polygon.holes.size()); ++ring) {
    if (auto flaw = flaw_of_ring(ring_of(polygon, ring), ring - 1)) return flaw;
  }
  if (auto flaw = flaw_of_edges(polygon)) return flaw;
  if (auto flaw = flaw_of_holes(polygon)) return flaw;
  const double area = area_m2(polygon);
  if (area >= min_area_m2) return {};
  return PolygonFlaw{
      -1,
      "its area, " + shortest(area) + " m², is below the limit " + shortest(min_area_m2) + " m²",
      "widen it"};
}

}  // namespace ergocast
