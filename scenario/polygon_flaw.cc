// SPDX-License-Identifier: BSD-3-Clause
// Tests every pair of edges in extended precision, then whether each hole lies inside the
// outline.
#include "scenario/polygon_flaw.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenario/findings.h"

namespace ergocast {
namespace {

/// The side of the line through a and b on which the point lies: 1 left, −1 right, 0 on it. In
/// extended precision, because the sign of a small difference must be right.
int side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& point) {
  using Wide = long double;
  const Wide cross = (Wide{b.x()} - a.x()) * (Wide{point.y()} - a.y()) -
                     (Wide{b.y()} - a.y()) * (Wide{point.x()} - a.x());
  return (cross > 0) - (cross < 0);
}

struct Edge {
  Eigen::Vector2d from, to;
  int ring;    // 0: the outline; then the holes
  int number;  // its index in the ring
};

bool boxes_apart(const Edge& e, const Edge& f) {
  const Eigen::Array2d e_low = e.from.cwiseMin(e.to), e_high = e.from.cwiseMax(e.to);
  const Eigen::Array2d f_low = f.from.cwiseMin(f.to), f_high = f.from.cwiseMax(f.to);
  return (e_high < f_low).any() || (f_high < e_low).any();
}

bool touch(const Edge& e, const Edge& f) {
  return !boxes_apart(e, f) && side(e.from, e.to, f.from) * side(e.from, e.to, f.to) <= 0 &&
         side(f.from, f.to, e.from) * side(f.from, f.to, e.to) <= 0;
}

/// Whether `next`, which begins at the end of `edge`, goes back along it.
bool folds_back(const Edge& edge, const Edge& next) {
  return side(edge.from, edge.to, next.to) == 0 &&
         (edge.to - edge.from).dot(next.to - next.from) < 0;
}

const Ring& ring_of(const Polygon& polygon, int ring) {
  return ring == 0 ? polygon.outline : polygon.holes[static_cast<std::size_t>(ring - 1)];
}

std::vector<Edge> edges_of(const Polygon& polygon) {
  std::vector<Edge> edges;
  for (int ring = 0; ring <= static_cast<int>(polygon.holes.size()); ++ring) {
    const Ring& corners = ring_of(polygon, ring);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      edges.push_back({corners[i], corners[(i + 1) % corners.size()], ring, static_cast<int>(i)});
    }
  }
  return edges;
}

/// Whether the position of two edges to each other is allowed; `count` is the size of a ring.
bool may_meet(const Edge& e, const Edge& f, int count) {
  if (e.ring != f.ring) return !touch(e, f);
  if ((e.number + 1) % count == f.number) return !folds_back(e, f);
  if ((f.number + 1) % count == e.number) return !folds_back(f, e);
  return !touch(e, f);
}

std::string name_of(const Edge& edge) {
  return std::string(edge.ring == 0 ? "" : "holes[" + std::to_string(edge.ring - 1) + "].") +
         "vertices[" + std::to_string(edge.number) + "]";
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
        next == 0 ? "leave out the last: a ring closes by itself" : "leave out one of them"};
  }
  return {};
}

std::optional<PolygonFlaw> flaw_of_edges(const Polygon& polygon) {
  const std::vector<Edge> edges = edges_of(polygon);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const int count = static_cast<int>(ring_of(polygon, edges[i].ring).size());
    for (std::size_t j = 0; j < i; ++j) {
      if (may_meet(edges[i], edges[j], count)) continue;
      return PolygonFlaw{edges[i].ring - 1,
                         "the edges that begin at " + name_of(edges[j]) + " and " +
                             name_of(edges[i]) + " cross or touch",
                         "move one of them, or write two polygons"};
    }
  }
  return {};
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
