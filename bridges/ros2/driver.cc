// SPDX-License-Identifier: BSD-3-Clause
// Gives the robots the mission's commands, and the team those positions that can be trusted.
#include "bridges/ros2/driver.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/motion/filter_rules.h"
#include "core/motion/vehicle.h"

namespace ergocast::ros2 {
namespace {

std::vector<AgentId> ids_of(const std::map<AgentId, Robot>& robots) {
  std::vector<AgentId> ids;
  for (const auto& [id, robot] : robots) ids.push_back(id);
  return ids;
}

std::optional<std::string> why_not_robot(const Mission& mission, AgentId id, const Robot& robot) {
  const std::string name = "robot " + std::to_string(id);
  if (!motion_of(mission, id).is_point())
    return name +
           " follows velocities of points: give the mission vehicle { kind: POINT }, and "
           "separation { response_s } for how late robots follow";
  if (!mission.domain.planar() && robot.limits().kind == DriveKind::kDifferential)
    return name + " cannot climb, and the mission is in a box: leave out size_z_m";
  return std::nullopt;
}

}  // namespace

Driver::Driver(RunId run, Incarnation incarnation, std::map<AgentId, Robot> robots)
    : RobotDriver(run, incarnation, ids_of(robots)), robots_(std::move(robots)) {}

std::optional<std::string> Driver::why_not(const Mission& mission) const {
  if (mission.timing.realtime_factor != 1)
    return "the mission's seconds are not those of the clock: leave out realtime_factor";
  for (const auto& [id, robot] : robots_) {
    if (auto why = why_not_robot(mission, id, robot)) return why;
  }
  return std::nullopt;
}

void Driver::begin(const Mission& mission) {
  // The separation assumes that a robot follows a command at most so late after its position.
  const double oldest_fix_s = mission.separation.response_s + mission.timing.dt_s;
  for (auto& [id, robot] : robots_)
    robot.begin(mission.domain, keeps_distance(mission) ? oldest_fix_s : kOldestFix_s, is_exact());
}

std::optional<RobotFix> Driver::fix_of(AgentId id, Instant now) const {
  const Robot& robot = robots_.at(id);
  const auto fix = robot.fix(now);
  if (!fix) return std::nullopt;
  return RobotFix{fix->position_m, fix->velocity_mps, fix->measured, robot.stands(now)};
}

void Driver::finish() {
  for (auto& [id, robot] : robots_) robot.finish();
}

bool Driver::have_stopped() const {
  return std::ranges::all_of(robots_, [](const auto& one) { return one.second.done(); });
}

void Driver::advance(Instant now, Outbox& out) {
  RobotDriver::advance(now, out);
  for (auto& [id, robot] : robots_) robot.note_change(now);
}

Instant Driver::next_wakeup() const {
  Instant next = RobotDriver::next_wakeup();
  for (const auto& [id, robot] : robots_) next = std::min(next, robot.next_wakeup());
  return next;
}

}  // namespace ergocast::ros2
