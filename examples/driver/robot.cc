// SPDX-License-Identifier: BSD-3-Clause
// Turns towards the commanded velocity at a limited rate and drives along the heading.
#include "examples/driver/robot.h"

#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"

namespace ergocast::example {

void Robot::move(double dt_s) {
  if (wanted_mps_.isZero()) {
    velocity_mps_.setZero();
    return;
  }
  const double wanted_heading_rad = std::atan2(wanted_mps_.y(), wanted_mps_.x());
  const double error_rad = std::remainder(wanted_heading_rad - heading_rad_, 2 * M_PI);
  const double turn_limit_rad = kTurnLimit_radps * dt_s;
  heading_rad_ += std::clamp(error_rad, -turn_limit_rad, turn_limit_rad);
  // The forward speed is the wanted velocity's component along the heading, never backwards.
  const bool looks_there = std::abs(error_rad) <= turn_limit_rad;
  const double share = exactly_ ? (looks_there ? 1 : 0) : std::max(0.0, std::cos(error_rad));
  const double speed_mps = std::min(wanted_mps_.norm(), speed_limit_mps_) * share;
  velocity_mps_ = speed_mps * Eigen::Vector3d(std::cos(heading_rad_), std::sin(heading_rad_), 0);
  position_m_ += velocity_mps_ * dt_s;
}

void Robot::move_as_unicycle(const Motion& motion) {
  const Eigen::Vector3d next_mps =
      executed(motion, velocity_mps_, within_speed(wanted_mps_, speed_limit_mps_));
  position_m_ += mean_velocity(motion, velocity_mps_, next_mps) * motion.dt_s;
  velocity_mps_ = next_mps;
}

}  // namespace ergocast::example
