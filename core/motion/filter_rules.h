// SPDX-License-Identifier: BSD-3-Clause
// What the mission alone determines about filtered commands: which commands are filtered, where,
// and for how long the world may hold one.
#pragma once

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// For how many ticks after its own one the world may execute a command.
Tick command_hold_ticks(const Timing& timing);

/// H of an agent's own filter: 0 in lockstep, and where the world filters all commands again; else
/// command_hold_ticks(), and one more where bodies have no common ticks.
Tick unguarded_hold_ticks(const Mission& mission);

/// Whether bodies keep a distance from each other.
inline bool keeps_distance(const Mission& mission) { return mission.separation.distance_m > 0; }

/// Whether the world filters commands again, with true positions.
bool world_guards(const Mission& mission);

/// Whether agents know the places of others only from their beacons, team/beacon_book.h.
bool uses_beacons(const Mission& mission);
/// separation.lease_s in ticks, rounded down.
Tick lease_ticks(const Mission& mission);
/// Limit (Scenario): `separation { lease_s }`, at least [steps]. Below it: the scenario is refused.
inline constexpr Tick kLeastLeaseTicks = 5;
/// Limit (Scenario): `separation { lease_s }`, at most [steps]. Beyond it: the scenario is refused.
inline constexpr Tick kMostLeaseTicks = 10000;

/// Whether the world, or one driver of the whole team, filters the commands of points again: it
/// guards, or there are walls, which a held command does not know.
bool filters_again(const Mission& mission);

/// Whether the commands of any body pass through a SeparationFilter.
bool any_filtered(const Mission& mission);

/// Whether bodies know each other's state exactly. Vehicles that are no points require it.
bool sure_of_bodies(const Mission& mission);

/// Whether commands of body `id` pass through a SeparationFilter. They do where a distance is kept,
/// where there are walls, and for vehicles that are no points, because no edge can reflect those.
bool filters_commands(const Mission& mission, AgentId id);

/// The distance that body `id` keeps from edges and walls if it follows late: V T + 2 e; else 0
/// [m].
double late_edge_margin_m(const Mission& mission, AgentId id);

/// In this many ticks of unbroken contact, rounding takes no more than the margins that are added
/// to distances.
inline constexpr double kContactTicks = 1e6;

}  // namespace ergocast
