// SPDX-License-Identifier: BSD-3-Clause
// How a vehicle stays at its station: where it can, how fast it gets there, and how far from the
// station it may come to rest. The stations themselves are in core/mission/station.h.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// By how much a station at `x_m` is farther from all walls than required [m]. The requirement is
/// that of the agent's vehicle, or of the centre of its loiter circle.
double spare_at_home_m(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m);

/// How fast agent `id` goes home: by its law's u_max_mps, or its vehicle's limit if that is less.
double home_speed_mps(const Mission& mission, AgentId id);

/// How far from its station agent `id` may come to rest [m]: 2 steps, for a fixed wing also the
/// diameter of its loiter circle, and in addition what disturbances and position errors may add.
double home_m(const Mission& mission, AgentId id);

/// Whether the battery of agent `id` is charged at a tick, by what the world's state has of its
/// vehicle: it is at its station (home_m()), and slower than half of home_speed_mps(). A fixed wing
/// has its loiter centre there instead. Nothing else decides it, so all that receive the state
/// agree. Such an agent rests, but for its first tick: core/mission/station.h.
bool charges(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m,
             const Eigen::Vector3d& v_mps);

/// The first two of the first `team` agents whose stations are nearer to each other than
/// start_distance_m(), the later one first; nothing if there are none.
std::optional<std::pair<AgentId, AgentId>> too_near_at_home(const Mission& mission, AgentId team);

/// Whether each kind has a station for each agent, one for all, or none; whether a vehicle can stay
/// there, within the domain and as far from walls and from others as it has to be; and whether the
/// reserve leaves a tick of the mission.
bool stations_fit(const Mission& mission);

}  // namespace ergocast
