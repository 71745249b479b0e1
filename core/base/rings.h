// SPDX-License-Identifier: BSD-3-Clause
// Closed rings in the plane: which edges touch, and what is inside.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace ergocast {

/// The corners in order [m]; the last is joined to the first.
using Ring = std::vector<Eigen::Vector2d>;
using Rings = std::vector<Ring>;

/// An edge of a ring.
struct Segment {
  Eigen::Vector2d from_m, to_m;

  /// The point of the edge that is nearest to `x_m`.
  Eigen::Vector2d nearest_m(const Eigen::Vector2d& x_m) const {
    const Eigen::Vector2d along_m = to_m - from_m;
    const double square = along_m.squaredNorm(), share = along_m.dot(x_m - from_m);
    if (!(share > 0)) return from_m;
    return share >= square ? to_m : Eigen::Vector2d(from_m + share / square * along_m);
  }
};

/// Whether the ray from `x_m` to the right crosses an edge.
inline bool crosses_ray(const Segment& edge, const Eigen::Vector2d& x_m) {
  const Eigen::Vector2d &a = edge.from_m, &b = edge.to_m;
  if ((a.y() > x_m.y()) == (b.y() > x_m.y())) return false;
  const double share = (x_m.y() - a.y()) / (b.y() - a.y());
  return x_m.x() < a.x() + share * (b.x() - a.x());
}

/// Calls `each(segment)` for every edge of every ring, in order.
void for_segments(const Rings& rings, auto&& each) {
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      each(Segment{ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]});
  }
}

/// Whether two segments have a point in common. The sign of every small difference is right.
bool touch(const Segment& one, const Segment& other);

/// Least distance between two segments [m]; 0 if they touch.
double distance_m(const Segment& one, const Segment& other);

/// Two edges by their rings and first corners, the later one first.
struct EdgePair {
  std::size_t ring, corner, other_ring, other_corner;
};
class IndexedRings;
/// The first pair of edges that cross or touch. Neighbours may touch at their common corner, unless
/// one goes back along the other.
std::optional<EdgePair> touching_edges(const IndexedRings& rings);

/// Area of a ring that does not cross itself [m²], positive in either orientation.
double area_m2(const Ring& ring);

/// Whether `x_m` is inside. On the edge the result may be either.
bool contains(const Ring& ring, const Eigen::Vector2d& x_m);

/// Where a line across `axis` (0: x, 1: y), at `at_m` along it, crosses edges: along the other
/// axis, ascending [m].
std::vector<double> crossings_m(const Rings& rings, int axis, double at_m);

/// How many other rings each ring is inside of.
/// @pre no edges touch
std::vector<int> depths(const IndexedRings& rings);

}  // namespace ergocast
