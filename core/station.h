// SPDX-License-Identifier: BSD-3-Clause
// Stations: where agents are when the mission ends, and the tick from which they rest.
//
// An agent's endurance lasts for the mission. With reserve_s the agent has to be at its station
// from the tick
//
//   R = tick_count − ⌈reserve_s / dt⌉
//
// on, in ticks that count, so a pause takes nothing of it. From R on the agent rests: it covers and
// broadcasts no more, and no teammate forecasts it. Its coverage still counts. R follows from the
// plan alone, so all processes know it without a message. The agent itself decides when it goes
// home, core/way_home.h.
//
// A station belongs to an agent's number, as a vehicle does, whichever process drives it. Numbers
// beyond the plan have none.
#pragma once

#include <limits>
#include <optional>
#include <utility>

#include "core/ids.h"
#include "core/mission.h"

namespace ergocast {

/// Where agent `id` is at the end, if it has a station.
std::optional<Eigen::Vector3d> station_of(const Mission& mission, AgentId id);

/// Whether any agent has one.
bool any_station(const Mission& mission);

/// R of agent `id`; the greatest number if it has no station.
Tick rest_from(const Mission& mission, AgentId id);

/// Whether agent `id` rests at a tick, by its number among those that count.
inline bool rests(const Mission& mission, AgentId id, Tick counted) {
  return !mission.kinds.empty() && counted >= rest_from(mission, id);
}

/// By how much a station at `x_m` is farther from all walls than required [m]. The requirement is
/// that of the agent's vehicle, or of the centre of its loiter circle.
double spare_at_home_m(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m);

/// How fast agent `id` goes home: by its law's u_max_mps, or its vehicle's limit if that is less.
double home_speed_mps(const Mission& mission, AgentId id);

/// How far from its station agent `id` may come to rest [m]: 2 steps, for a fixed wing also the
/// diameter of its loiter circle, and in addition what disturbances and position errors may add.
double home_m(const Mission& mission, AgentId id);

/// The first two of the first `team` agents whose stations are nearer to each other than
/// start_distance_m(), the later one first; nothing if there are none.
std::optional<std::pair<AgentId, AgentId>> too_near_at_home(const Mission& mission, AgentId team);

/// Whether each kind has a station for each agent, one for all, or none; whether a vehicle can stay
/// there, within the domain and as far from walls and from others as it has to be; and whether the
/// reserve leaves a tick of the mission.
bool stations_fit(const Mission& mission);

}  // namespace ergocast
