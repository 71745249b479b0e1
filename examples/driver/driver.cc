// SPDX-License-Identifier: BSD-3-Clause
// Drives robots that exist only as numbers, and moves them once a tick.
#include "examples/driver/driver.h"

#include <algorithm>
#include <vector>

#include "core/motion/starts.h"

namespace ergocast::example {
namespace {

bool drives_unicycle(const Motion& motion) { return motion.vehicle.kind == VehicleKind::kUnicycle; }

/// Whether the robots can move as all kinds of agents expect.
bool has_vehicles_for(const Mission& mission) {
  bool all = true;
  for (int kind = 0; kind < std::max<int>(1, static_cast<int>(mission.kinds.size())); ++kind) {
    const Motion motion = motion_of_kind(mission, kind);
    all = all && (motion.is_point() || (drives_unicycle(motion) &&
                                        motion.vehicle.max_turn_radps <= Robot::kTurnLimit_radps));
  }
  return all;
}

}  // namespace

Driver::Driver(RunId run, Incarnation incarnation, double speed_limit_mps,
               std::optional<AgentId> only)
    : RobotDriver(run, incarnation, only ? std::vector{*only} : std::vector<AgentId>{}),
      speed_limit_mps_(speed_limit_mps),
      only_(only) {}

std::optional<std::string> Driver::why_not(const Mission& mission) const {
  if (has_vehicles_for(mission)) return std::nullopt;
  return "the mission is for other vehicles: give it vehicle { kind: POINT }, or UNICYCLE and at "
         "most the robots' 2 rad/s";
}

/// Here robots are made at the plan's starts; real robots already stand somewhere.
void Driver::join(const Mission& mission, AgentId id) {
  robots_.try_emplace(id, start_of(mission, id), speed_limit_mps_);
}

void Driver::begin(const Mission& mission) {
  if (only_) join(mission, *only_);
}

std::optional<RobotFix> Driver::fix_of(AgentId id, Instant now) const {
  const auto at = robots_.find(id);
  if (at == robots_.end()) return std::nullopt;
  return RobotFix{at->second.position_m(), at->second.velocity_mps(), now};
}

void Driver::go(AgentId id, const Eigen::Vector3d& velocity_mps) {
  const auto at = robots_.find(id);
  if (at != robots_.end()) at->second.drive(velocity_mps, is_exact());
}

void Driver::move(const Mission& mission) {
  for (auto& [id, robot] : robots_) {
    const Motion motion = motion_of(mission, id);
    if (drives_unicycle(motion)) {
      robot.move_as_unicycle(motion);
    } else {
      robot.move(mission.timing.dt_s);
    }
  }
}

}  // namespace ergocast::example
