// SPDX-License-Identifier: BSD-3-Clause
// The domain: a rectangle with its own origin, whose edges reflect.
#pragma once

#include <Eigen/Core>

namespace ergocast {

/// Axis-parallel rectangle [origin, origin + size] in metres.
struct Rectangle {
  Eigen::Vector2d origin_m{0, 0};
  Eigen::Vector2d size_m{1, 1};

  bool contains(const Eigen::Vector2d& x_m) const;
  Eigen::Vector2d center_m() const { return origin_m + 0.5 * size_m; }

  /// Largest distance from `point_m` to a point of the rectangle: one of the corners.
  double farthest_distance_m(const Eigen::Vector2d& point_m) const;
};

/// `x_m` folded back into `domain` at its edges: below the low edge, 2·low − x; above the high
/// edge, 2·high − x; repeated for steps longer than the domain. Points inside are returned bit for
/// bit, so that an agent a rounding error away from an edge is not captured by it.
/// @pre x_m is finite.
Eigen::Vector2d reflect(const Eigen::Vector2d& x_m, const Rectangle& domain);

}  // namespace ergocast
