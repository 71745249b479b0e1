// SPDX-License-Identifier: BSD-3-Clause
// How a robot with cmd_vel follows the velocity of its agent, which is that of a point.
//
// HOLONOMIC: the velocity itself, in the robot's axes. It does not turn.
// DIFFERENTIAL: with the angle e from its heading to the velocity,
//
//     ω = e/τ, at most max_turn_radps;   v = |velocity| · share(e), at most max_speed_mps
//
//   share(e) = max(0, cos e). Where distances are kept or walls stand, only the commanded direction
//   is safe. Then share(e) = max(0, 1 − |e|/0.2): it turns on the spot first, and its speed aside
//   is at most 5 % of |velocity|. It never moves backwards.
#pragma once

#include <Eigen/Core>

namespace ergocast::ros2 {

enum class DriveKind { kDifferential, kHolonomic };

struct DriveLimits {
  DriveKind kind = DriveKind::kDifferential;
  double max_speed_mps = 1;
  double max_turn_radps = 1;  ///< of kDifferential
};

/// As geometry_msgs/Twist, in the robot's axes: x ahead, y to the left, z up.
struct BodyVelocity {
  Eigen::Vector3d linear_mps{0, 0, 0};
  double turn_radps = 0;  ///< counter-clockwise, about z

  bool stands() const { return linear_mps.isZero(0) && turn_radps == 0; }
};

/// τ: a robot turns by e in about this time [s].
inline constexpr double kTurnTime_s = 0.3;
/// Where only the commanded direction is safe: it drives if e is smaller [rad].
inline constexpr double kGreatestSlant_rad = 0.2;

/// @param heading_rad  from the scenario's x to the robot's x
/// @param exactly  whether only the direction of `velocity_mps` is safe
/// @pre all are finite
BodyVelocity body_velocity(const DriveLimits& limits, double heading_rad,
                           const Eigen::Vector3d& velocity_mps, bool exactly);

}  // namespace ergocast::ros2
