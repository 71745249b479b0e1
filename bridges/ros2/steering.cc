// SPDX-License-Identifier: BSD-3-Clause
// Turns a velocity into the robot's axes, or into a speed ahead and a rate of turn.
#include "bridges/ros2/steering.h"

#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"

namespace ergocast::ros2 {

BodyVelocity body_velocity(const DriveLimits& limits, double heading_rad,
                           const Eigen::Vector3d& velocity_mps, bool exactly) {
  BodyVelocity body;
  if (velocity_mps.isZero(0)) return body;
  const Eigen::Vector3d allowed_mps = within_speed(velocity_mps, limits.max_speed_mps);
  const double cosine = std::cos(heading_rad), sine = std::sin(heading_rad);
  if (limits.kind == DriveKind::kHolonomic) {
    body.linear_mps = {cosine * allowed_mps.x() + sine * allowed_mps.y(),
                       cosine * allowed_mps.y() - sine * allowed_mps.x(), allowed_mps.z()};
    return body;
  }
  const double wanted_rad = std::atan2(allowed_mps.y(), allowed_mps.x());
  const double slant_rad = std::remainder(wanted_rad - heading_rad, 2 * M_PI);
  const double share = exactly ? 1 - std::abs(slant_rad) / kGreatestSlant_rad : std::cos(slant_rad);
  body.linear_mps.x() = allowed_mps.head<2>().norm() * std::max(0.0, share);
  body.turn_radps =
      std::clamp(slant_rad / kTurnTime_s, -limits.max_turn_radps, limits.max_turn_radps);
  return body;
}

}  // namespace ergocast::ros2
