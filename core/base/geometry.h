// SPDX-License-Identifier: BSD-3-Clause
// The domain: a box with its own origin, whose sides reflect. A plane is a box of height 0.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace ergocast {

/// Axis-parallel box [origin, origin + size] in metres. A box of height 0 is a plane. Nothing moves
/// along z there: contains() ignores z, and reflect() returns the plane's z.
struct Box {
  Eigen::Vector3d origin_m{0, 0, 0};
  Eigen::Vector3d size_m{1, 1, 0};

  bool planar() const { return size_m.z() == 0; }
  bool contains(const Eigen::Vector3d& x_m) const;
  /// The place of the box that is nearest to `x_m`. A place inside is returned bit for bit.
  Eigen::Vector3d nearest(const Eigen::Vector3d& x_m) const;
  Eigen::Vector3d center_m() const { return origin_m + 0.5 * size_m; }

  /// The shortest of the sides along which something moves.
  double shortest_side_m() const;
  /// Area of a plane [m²], volume of any other box [m³].
  double content() const;
  /// Largest distance from `point_m` to a point of the box: one of the corners.
  double farthest_distance_m(const Eigen::Vector3d& point_m) const;
};

/// ‖v‖ by + × √ alone: the same bits on every machine, unless a square overflows.
inline double length_of(const Eigen::Vector3d& v) { return std::sqrt(v.squaredNorm()); }

/// (x, y, 0): a place in the plane z = 0.
inline Eigen::Vector3d on_ground(const Eigen::Vector2d& x_m) { return {x_m.x(), x_m.y(), 0}; }

/// `v_mps` bit for bit, or a vector of length `limit_mps` in its direction. @pre limit_mps > 0
Eigen::Vector3d within_speed(const Eigen::Vector3d& v_mps, double limit_mps);

/// `x_m` folded back into `domain` at its sides: below the low side, 2·low − x; above the high
/// side, 2·high − x; repeated for steps longer than the domain. Points inside are returned bit for
/// bit. Otherwise a side would capture an agent that is a rounding error away from it.
/// @pre x_m is finite.
Eigen::Vector3d reflect(const Eigen::Vector3d& x_m, const Box& domain);

}  // namespace ergocast
