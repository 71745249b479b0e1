// SPDX-License-Identifier: BSD-3-Clause
// Heading and speed of a disc; acceleration, attitude and thrust of a quadrotor.
#include "examples/mujoco/pilot.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ergocast::mujoco {
namespace {

/// A disc whose heading differs from the wanted direction by more than this turns on the spot.
constexpr double kLooksThere = 0.8;  // a cosine
/// It changes between forwards and backwards only if the other direction is better by this much.
constexpr double kUndecided = 0.2;

// A quadrotor's loops, each slow enough for the one inside.
constexpr double kSpeedTime_s = 0.3, kHeightGain = 9, kClimbGain = 5;
constexpr double kGreatestAcceleration_mps2 = 3, kGravity_mps2 = 9.81;
constexpr double kAttitudeGain = 200, kTurningGain = 25, kHeadingGain = 4, kHeadingTurnGain = 4;

}  // namespace

std::array<double, 2> wheels_radps(const RobotDesign& design, double ahead_mps, double turn_radps) {
  const double turn_mps = turn_radps * kTrackShare * design.radius_m;
  return {(ahead_mps - turn_mps) / kWheelRadius_m, (ahead_mps + turn_mps) / kWheelRadius_m};
}

std::array<double, 2> DiscPilot::wheels_radps(const RobotState& state,
                                              const Eigen::Vector3d& wanted_mps) {
  const double speed_mps = wanted_mps.head<2>().norm();
  if (speed_mps < 1e-6) return {0, 0};
  const Eigen::Vector2d look = state.attitude.col(0).head<2>().normalized();
  const Eigen::Vector2d way = wanted_mps.head<2>() / speed_mps;
  const double along = look.dot(way);
  if (backwards_ ? along > kUndecided : along < -kUndecided) backwards_ = !backwards_;
  const double direction = backwards_ ? -1 : 1;
  const double ahead = direction * along;
  const double aside = direction * (look.x() * way.y() - look.y() * way.x());
  const double turn_radps = std::clamp(std::atan2(aside, ahead) / (4 * design_.lag_s),
                                       -kTurnLimit_radps, kTurnLimit_radps);
  const double share = std::max(0.0, (ahead - kLooksThere) / (1 - kLooksThere));
  return mujoco::wheels_radps(design_, direction * speed_mps * share, turn_radps);
}

std::array<double, 4> QuadrotorPilot::thrusts_n(const RobotState& state,
                                                const Eigen::Vector3d& wanted_mps) const {
  Eigen::Vector3d push = (wanted_mps - state.velocity_mps) / kSpeedTime_s;
  push.z() = 0;
  if (push.norm() > kGreatestAcceleration_mps2) push *= kGreatestAcceleration_mps2 / push.norm();
  push.z() = kGravity_mps2 + kHeightGain * (kHoverHeight_m - state.position_m.z()) -
             kClimbGain * state.velocity_mps.z();
  const Eigen::Matrix3d to_own = state.attitude.transpose();
  const Eigen::Vector3d up = to_own * push.normalized();  // the wanted direction of its own z
  const double thrust_n = kQuadrotorMass_kg * std::max(0.0, (to_own * push).z());
  const double heading_rad = std::atan2(state.attitude(1, 0), state.attitude(0, 0));
  const Eigen::Vector3d& turning = state.turning_radps;
  const double roll_nm = kInertiaX_kgm2 * (-kAttitudeGain * up.y() - kTurningGain * turning.x());
  const double pitch_nm = kInertiaX_kgm2 * (kAttitudeGain * up.x() - kTurningGain * turning.y());
  const double yaw_nm =
      kInertiaZ_kgm2 * (-kHeadingGain * heading_rad - kHeadingTurnGain * turning.z());
  const double arm_m = kArmShare * design_.radius_m;
  std::array<double, 4> thrusts{};
  for (std::size_t rotor = 0; rotor < 4; ++rotor) {
    const double x = rotor % 2 == 0 ? 1 : -1, y = rotor < 2 ? 1 : -1;
    thrusts[rotor] =
        (thrust_n + y * roll_nm / arm_m - x * pitch_nm / arm_m + x * y * yaw_nm / kRotorTorque_m) /
        4;
  }
  return thrusts;
}

}  // namespace ergocast::mujoco
