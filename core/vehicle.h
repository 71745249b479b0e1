// SPDX-License-Identifier: BSD-3-Clause
// How a vehicle executes a command in one tick: the same for agents, world, laboratory, ideal team
// and driver.
//
// kPoint: the command is the velocity of the whole tick, x' = x + v dt.
// kAcceleration: the command is the velocity v' at the tick's end. The acceleration a = (v' − v)/dt
//   is constant within the tick, ‖a‖ ≤ A, and x' = x + (v + v')/2 dt. Its state is (x, v).
//
// ‖v‖ ≤ V, the mission's speed limit, at every moment.
#pragma once

#include <Eigen/Core>

#include "core/mission.h"

namespace ergocast {

/// The velocity at the tick's end that comes nearest to the command `wanted_mps`, for a vehicle
/// that now has `now_mps`. A velocity that it can reach is returned bit for bit. In a plane nothing
/// is executed of v_z.
/// @pre both are finite
Eigen::Vector3d executed(const Mission& mission, const Eigen::Vector3d& now_mps,
                         const Eigen::Vector3d& wanted_mps);

/// (x' − x)/dt of a step whose velocity changes from `now_mps` to `then_mps`.
Eigen::Vector3d mean_velocity(const Mission& mission, const Eigen::Vector3d& now_mps,
                              const Eigen::Vector3d& then_mps);

/// From where a vehicle is to where it stands if it brakes as evenly as A allows, in k whole ticks:
/// ½ v dt k. Commands of 0 bring it to a stop on this way.
Eigen::Vector3d braking_path_m(const Mission& mission, const Eigen::Vector3d& v_mps);

/// The length of the longest braking path, at the speed limit [m].
double longest_braking_path_m(const Mission& mission);

/// By how much the path of a vehicle within a tick departs from the straight and even way between
/// its ends, at most [m].
double bulge_m(const Mission& mission);

}  // namespace ergocast
