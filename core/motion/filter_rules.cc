// SPDX-License-Identifier: BSD-3-Clause
// Reads the rules of filtering off the mission.
#include "core/motion/filter_rules.h"

#include <cmath>

#include "core/motion/vehicle.h"

namespace ergocast {

Tick command_hold_ticks(const Timing& timing) {
  // A command that is exactly as old as command_hold_s is still executed.
  return static_cast<Tick>(std::floor(timing.command_hold_s / timing.dt_s + 1e-6));
}

bool world_guards(const Mission& mission) {
  return keeps_distance(mission) && mission.separation.guard &&
         mission.timing.pace == Pace::kRealtime;
}

bool sure_of_bodies(const Mission& mission) {
  const Separation& rule = mission.separation;
  return rule.position_error_m == 0 && rule.disturbance_m == 0 && rule.response_s == 0 &&
         (rule.guard || mission.timing.pace == Pace::kLockstep);
}

Tick unguarded_hold_ticks(const Mission& mission) {
  const bool held = mission.timing.pace == Pace::kRealtime && !world_guards(mission);
  return held ? command_hold_ticks(mission.timing) + (uses_beacons(mission) ? 1 : 0) : 0;
}

bool uses_beacons(const Mission& mission) {
  return keeps_distance(mission) && mission.separation.lease_s > 0 &&
         mission.timing.pace == Pace::kRealtime;
}

Tick lease_ticks(const Mission& mission) {
  return static_cast<Tick>(std::floor(mission.separation.lease_s / mission.timing.dt_s + 1e-6));
}

bool filters_again(const Mission& mission) {
  return world_guards(mission) || !mission.walls.empty();
}

bool any_filtered(const Mission& mission) {
  return keeps_distance(mission) || !mission.walls.empty() || any_but_points(mission);
}

bool filters_commands(const Mission& mission, AgentId id) {
  return keeps_distance(mission) || !mission.walls.empty() || !motion_of(mission, id).is_point();
}

double late_edge_margin_m(const Mission& mission, AgentId id) {
  const Separation& rule = mission.separation;
  if (rule.response_s == 0) return 0;
  return rule.response_s * motion_of(mission, id).speed_limit_mps + 2 * rule.position_error_m;
}

}  // namespace ergocast
