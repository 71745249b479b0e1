// SPDX-License-Identifier: BSD-3-Clause
// The controller on a robot: it turns a wanted velocity into wheel speeds or thrusts. It uses only
// the robot's own sensors.
#pragma once

#include <Eigen/Core>
#include <array>

#include "examples/mujoco/room.h"

namespace ergocast::mujoco {

/// A robot's measurements of itself.
struct RobotState {
  Eigen::Vector3d position_m{0, 0, 0}, velocity_mps{0, 0, 0};
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();  ///< from its axes to those of the room
  Eigen::Vector3d turning_radps{0, 0, 0};                  ///< in its own axes
};

/// Speeds of a disc's left and right wheel [rad/s], for its speed ahead and its turn to the left.
std::array<double, 2> wheels_radps(const RobotDesign& design, double ahead_mps, double turn_radps);

/// A disc turns towards the line of the wanted velocity, at most at kTurnLimit_radps. It rolls
/// along that line, forwards or backwards, and more slowly the less it is aligned.
class DiscPilot {
 public:
  static constexpr double kTurnLimit_radps = 4;

  explicit DiscPilot(const RobotDesign& design) : design_(design) {}
  /// Speeds of the left and the right wheel [rad/s].
  std::array<double, 2> wheels_radps(const RobotState& state, const Eigen::Vector3d& wanted_mps);

 private:
  RobotDesign design_;
  bool backwards_ = false;
};

/// A quadrotor tilts towards the wanted acceleration, and keeps height and heading.
class QuadrotorPilot {
 public:
  explicit QuadrotorPilot(const RobotDesign& design) : design_(design) {}
  /// Thrust of each rotor [N], before the rotors' own limits.
  std::array<double, 4> thrusts_n(const RobotState& state, const Eigen::Vector3d& wanted_mps) const;

 private:
  RobotDesign design_;
};

}  // namespace ergocast::mujoco
