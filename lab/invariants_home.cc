// SPDX-License-Identifier: BSD-3-Clause
// Checks the places of agents that have a station, and computes them again.
#include <algorithm>
#include <cmath>
#include <string>

#include "core/mission/kinds.h"
#include "core/motion/vehicle.h"
#include "lab/invariants.h"

namespace ergocast::lab {
namespace {

/// Where agent `id` is to be.
Eigen::Vector3d home_of(const Mission& mission, AgentId id) {
  int place = id;
  for (const AgentKind& kind : mission.kinds) {
    if (place < kind.count)
      return kind.stations_m.size() == 1 ? kind.stations_m.front()
                                         : kind.stations_m[static_cast<std::size_t>(place)];
    place -= kind.count;
  }
  return mission.domain.center_m();
}

/// Two steps; across the circle of a fixed wing; two pushes of the world, by 6 deviations each; and
/// two errors of what it knows of its place.
double tolerated_m(const Mission& mission, AgentId id) {
  const Motion motion = motion_of(mission, id);
  const double dt_s = mission.timing.dt_s;
  const double v_mps = law_of(mission, planned_kind(mission, id)).u_max_mps;
  const VehicleLimits& vehicle = motion.vehicle;
  const double across_m = vehicle.kind == VehicleKind::kFixedWing
                              ? 2 * vehicle.min_speed_mps / vehicle.max_turn_radps
                              : 0;
  return 2 * v_mps * dt_s + across_m + 12 * mission.disturbance_intensity * std::sqrt(dt_s) +
         2 * mission.separation.position_error_m;
}

}  // namespace

/// Checks the agents that the mission began with, in lockstep, where no tick is lost.
void Invariants::check_home(double t_s, const WorldState& world) {
  const Timing& timing = mission_.timing;
  if (home_from_.empty() || timing.pace == Pace::kRealtime ||
      timing.on_timeout == OnTimeout::kEvict)
    return;
  const Tick counted = counted_ticks(truth_.holds(), world.header.tick);
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    const auto from = home_from_.find(vehicle.id);
    if (from == home_from_.end() || counted < from->second) continue;
    const bool from_the_start = std::ranges::any_of(truth_.roster(), [&](const RosterEntry& entry) {
      return entry.author.agent == vehicle.id && entry.active_from == 0;
    });
    if (!from_the_start) continue;
    const double apart_m = (vehicle.position_m - home_of(mission_, vehicle.id)).norm();
    const double most_m = tolerated_m(mission_, vehicle.id);
    if (apart_m <= most_m * (1 + 1e-9)) continue;
    violate(t_s, Invariant::kHomeInTime, "vehicle " + std::to_string(vehicle.id),
            text("is ", apart_m, " m from its station at tick ", world.header.tick, ", and ",
                 most_m, " m are tolerated"));
  }
}

}  // namespace ergocast::lab
