// SPDX-License-Identifier: BSD-3-Clause
// The physics engine's model as MuJoCo's MJCF text: a walled room with robots in it.
//
// A robot's position is its centre. Centres may be anywhere in the domain. So the room's walls
// stand a robot's radius outside the domain's edges: a robot whose centre leaves the domain touches
// a wall. The mission's own walls keep their places; bodies keep wall_clearance_m from them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast::mujoco {

/// Differential-drive discs roll on two wheels and two slippery casters. Quadrotors fly at one
/// height, by four rotors.
enum class RobotKind { kDisc, kQuadrotor };

struct RobotDesign {
  RobotKind kind = RobotKind::kDisc;
  double radius_m = 0.2;  ///< of the disc that a robot takes up
  double lag_s = 0.1;     ///< time constant with which wheels or rotors follow their set value
};
inline constexpr RobotDesign kDiscs, kQuadrotors{RobotKind::kQuadrotor, 0.2, 0.03};

// All discs:
inline constexpr double kWheelRadius_m = 0.05;
/// Half of the distance between the wheels, as a share of the robot's radius.
inline constexpr double kTrackShare = 0.7;
inline constexpr double kWheelSpeedLimit_radps = 30, kWheelTorqueLimit_nm = 0.5;
// All quadrotors:
inline constexpr double kQuadrotorMass_kg = 0.8;
inline constexpr double kHoverHeight_m = 1;
/// The rotors' distance from the centre, as a share of the robot's radius; and torque for each
/// newton of thrust.
inline constexpr double kArmShare = 0.6, kRotorTorque_m = 0.02;
inline constexpr double kThrustLimit_n = 6;
/// The moments of inertia of the body without rotors: a flat box, about its centre.
inline constexpr double kInertiaX_kgm2 = 0.006, kInertiaZ_kgm2 = 0.011;

/// One step of the engine. A tick is a whole number of steps, none of which is longer.
inline constexpr double kLongestStep_s = 0.005;

struct Placement {
  AgentId id = kUnassigned;
  Eigen::Vector3d position_m{0, 0, 0};
};

/// Names: body, chassis and free joint of robot 7 are robot7, chassis7, joint7; its actuators
/// left7 and right7, or rotor7_0 to rotor7_3. Geometry of walls is named wall and a number.
/// @param step_s  of the engine
std::string room_mjcf(const RobotDesign& design, const Box& domain, const Rings& walls,
                      double step_s, const std::vector<Placement>& robots);

}  // namespace ergocast::mujoco
