// SPDX-License-Identifier: BSD-3-Clause
// A small wheeled robot that exists only as numbers. Replace this file by your vehicle's interface:
// a position to read, a velocity to ask for.
#pragma once

#include <Eigen/Core>

#include "core/motion/vehicle.h"

namespace ergocast::example {

/// Stays on its plane, turns on the spot at most at kTurnLimit_radps and drives forwards at most at
/// `speed_limit_mps`. Unlike a vehicle of ergocast-sim, it cannot change its velocity at once.
class Robot {
 public:
  Robot(const Eigen::Vector3d& position_m, double speed_limit_mps)
      : position_m_(position_m), speed_limit_mps_(speed_limit_mps) {}

  /// Sets the velocity to drive at from now on; zero: stop.
  /// @param exactly  whether it turns on the spot until it points there, because no other direction
  /// is safe
  void drive(const Eigen::Vector3d& velocity_mps, bool exactly = false) {
    wanted_mps_ = velocity_mps;
    exactly_ = exactly;
  }

  Eigen::Vector3d position_m() const { return position_m_; }
  Eigen::Vector3d velocity_mps() const { return velocity_mps_; }

  /// Simulates `dt_s`. A real robot moves by itself.
  void move(double dt_s);

  /// Simulates a tick with the unicycle model of core/motion/vehicle.h, which the agents expect.
  /// @pre the mission's unicycles turn no faster than kTurnLimit_radps
  void move_as_unicycle(const Motion& motion);

  static constexpr double kTurnLimit_radps = 2;

 private:
  Eigen::Vector3d position_m_;
  Eigen::Vector3d velocity_mps_{0, 0, 0}, wanted_mps_{0, 0, 0};
  double heading_rad_ = 0;
  bool exactly_ = false;
  double speed_limit_mps_;
};

}  // namespace ergocast::example
