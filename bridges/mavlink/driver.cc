// SPDX-License-Identifier: BSD-3-Clause
// Gives the vehicle the mission's limits and commands, and the team the vehicle's position.
#include "bridges/mavlink/driver.h"

#include <ergocast/core/motion/filter_rules.h>
#include <ergocast/core/motion/vehicle.h>

namespace ergocast::mavlink {

Driver::Driver(RunId run, Incarnation incarnation, AgentId id, const VehicleOptions& options)
    : RobotDriver(run, incarnation, {id}),
      id_(id),
      vehicle_(options, static_cast<std::uint32_t>(incarnation)) {}

std::optional<std::string> Driver::why_not(const Mission& mission) const {
  if (mission.timing.realtime_factor != 1)
    return "the mission's seconds are not those of the clock: leave out realtime_factor";
  if (!motion_of(mission, id_).is_point())
    return "the mission is for other vehicles: give it vehicle { kind: POINT }, and "
           "separation { response_s } for how late they follow";
  return std::nullopt;
}

void Driver::begin(const Mission& mission) {
  const double limit_mps = motion_of(mission, id_).speed_limit_mps;
  // The separation assumes that a vehicle follows a command at most so late after its position.
  const double oldest_fix_s = mission.separation.response_s + mission.timing.dt_s;
  vehicle_.begin(mission.domain, limit_mps > 0 ? limit_mps : mission.law.u_max_mps,
                 keeps_distance(mission) ? oldest_fix_s : kOldestFix_s, mission.walls);
}

std::optional<RobotFix> Driver::fix_of(AgentId, Instant now) const {
  const auto fix = vehicle_.fix(now);
  if (!fix) return std::nullopt;
  return RobotFix{fix->position_m, fix->velocity_mps, fix->not_before, vehicle_.stands(now),
                  vehicle_.charge_ppm(now)};
}

void Driver::advance(Instant now, Outbox& out, std::vector<Packet>& to_vehicle) {
  RobotDriver::advance(now, out);
  vehicle_.advance(now, to_vehicle);
  if (!vehicle_.fatal().empty()) fail(vehicle_.fatal());
}

}  // namespace ergocast::mavlink
