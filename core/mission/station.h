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
// plan alone, until the mission gets another end (core/mission/end_schedule.h). The agent itself
// decides when it goes home, core/motion/way_home.h.
//
// An agent that the operator sends home rests from another tick on (RosterEntry::recalled_at). It
// then goes home whether it has a station or not.
//
// An agent whose battery is charged rests meanwhile, too (charges(), core/motion/home.h). It goes
// on to broadcast when that is due, because teammates cannot know when it will be full. At its
// first tick an agent covers in any case: without a step it has nothing to send.
//
// A station belongs to an agent's number, as a vehicle does, whichever process drives it. Numbers
// beyond the plan have none.
#pragma once

#include <optional>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Where agent `id` is at the end, if it has a station.
std::optional<Eigen::Vector3d> station_of(const Mission& mission, AgentId id);

/// Where agent `id` goes when the operator sends it home: to its station, or else where it begins
/// by the plan. Nothing for a number beyond the plan.
std::optional<Eigen::Vector3d> home_of(const Mission& mission, AgentId id);

/// The battery of agent `id`; null if it has none.
const Battery* battery_of(const Mission& mission, AgentId id);

/// Whether any agent has a station, or a battery.
bool any_station(const Mission& mission);
bool any_battery(const Mission& mission);

/// R of agent `id`; the greatest number if it has no station.
Tick rest_from(const Mission& mission, AgentId id);

/// Whether agent `id` rests at a tick, by its number among those that count.
inline bool rests(const Mission& mission, AgentId id, Tick counted) {
  return !mission.kinds.empty() && counted >= rest_from(mission, id);
}

}  // namespace ergocast
