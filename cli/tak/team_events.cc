// SPDX-License-Identifier: BSD-3-Clause
// Chooses the types of events by what the scenario knows of vehicles, and the time of each event.
#include "cli/tak/team_events.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/mission/kinds.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kRobotPeriod = 1s, kOtherPeriod = 5s;
constexpr auto kRobotLasts = 5s, kOtherLasts = 15s;
/// A place that is older is not sent.
constexpr double kOldestPlace_s = 3;

constexpr int kRed = -65536, kYellow = -256, kGreen = -16711936;  // ARGB

bool world_sends(const TeamPicture& picture) {
  const auto world = std::ranges::find(picture.processes, "world", &ProcessRow::name);
  return world != picture.processes.end() && world->heard && world->silent_s <= kOldestPlace_s;
}

bool has_new_place(const TeamPicture& picture, const AgentRow& row) {
  const auto behind = static_cast<double>(picture.tick - row.position_tick);
  return !row.position_m.empty() && behind * picture.dt_s <= kOldestPlace_s;
}

/// A friend; then fixed wing or rotary wing without a crew, a ground unit, or anything on the
/// ground.
const char* type_of(const Mission& mission, const AgentRow& row) {
  switch (vehicle_of(mission, kind_named(mission, row.kind).value_or(0)).kind) {
    case VehicleKind::kFixedWing:
      return "a-f-A-M-F-Q";
    case VehicleKind::kUnicycle:
      return "a-f-G-U-C";
    default:
      return mission.domain.planar() ? "a-f-G" : "a-f-A-M-H-Q";
  }
}

double course_deg(const std::vector<double>& velocity_mps) {
  const double east_mps = velocity_mps[0], north_mps = velocity_mps[1];
  const double course_deg = std::atan2(east_mps, north_mps) * 180 / std::numbers::pi;
  return course_deg < 0 ? course_deg + 360 : course_deg;
}

}  // namespace

bool TeamEvents::is_due(const CotEvent& event, PacingClock::duration period, Instant now) {
  const auto [at, is_new] = sent_.try_emplace(event.uid, now);
  if (!is_new && now - at->second < period) return false;
  at->second = now;
  return true;
}

CotEvent TeamEvents::event(const TeamPicture& picture, const std::string& what,
                           const Eigen::Vector2d& x_m) const {
  const std::string replay = picture.replay ? "replay-" : "";
  CotEvent event;
  event.uid = "ergocast-" + replay + to_hex(picture.run) + '-' + what;
  event.place = plane_.to_place(x_m);
  event.callsign = (picture.replay ? "replay of " : "") + picture.scenario + ' ';
  event.lasts = kOtherLasts;
  return event;
}

CotEvent TeamEvents::robot(const TeamPicture& picture, const Mission& mission,
                           const AgentRow& row) {
  const AgentId id = row.author.agent;
  CotEvent robot = event(picture, "agent-" + std::to_string(id),
                         Eigen::Vector2d(row.position_m[0], row.position_m[1]));
  robot.type = type_of(mission, row);
  robot.callsign += std::to_string(id);
  robot.lasts = kRobotLasts;
  const double speed_mps = std::hypot(row.velocity_mps[0], row.velocity_mps[1]);
  if (speed_mps > 0) courses_deg_[id] = course_deg(row.velocity_mps);
  if (const auto course = courses_deg_.find(id); course != courses_deg_.end())
    robot.track = {course->second, speed_mps};
  robot.remarks = std::string("agent ") + to_string(row.condition);
  if (!row.kind.empty()) robot.remarks += ", kind " + row.kind;
  if (row.position_m.size() > 2) robot.remarks += ", height " + shortest(row.position_m[2]) + " m";
  return robot;
}

CotEvent TeamEvents::zone(const TeamPicture& picture, const Mission& mission,
                          const Zone& zone) const {
  Eigen::Vector2d sum_m(0, 0);
  for (const Eigen::Vector2d& corner_m : zone.corners_m) sum_m += corner_m;
  CotEvent shape = event(picture, "zone-" + std::to_string(zone.number),
                         sum_m / static_cast<double>(zone.corners_m.size()));
  shape.type = "u-d-f";
  shape.how = "h-e";
  shape.callsign += "zone " + std::to_string(zone.number);
  shape.argb = kRed;
  for (const Eigen::Vector2d& corner_m : zone.corners_m)
    shape.outline.push_back(plane_.to_place(corner_m));
  shape.remarks = "robots keep out";
  if (!mission.domain.planar())
    shape.remarks +=
        ", heights from " + shortest(zone.low_m) + " to " + shortest(zone.high_m) + " m";
  return shape;
}

CotEvent TeamEvents::find(const TeamPicture& picture, const Find& find) const {
  CotEvent point = event(picture, "object-" + std::to_string(find.object), find.x_m.head<2>());
  point.type = "b-m-p-s-m";
  point.callsign += "object " + std::to_string(find.object);
  point.argb = kGreen;
  point.remarks = to_text(find);
  return point;
}

CotEvent TeamEvents::contact(const TeamPicture& picture, const Contact& contact) const {
  CotEvent point = event(picture, "contact-" + std::to_string(contact.cell), contact.x_m);
  point.type = "b-m-p-s-m";
  point.callsign += "contact";
  point.argb = kYellow;
  point.remarks = to_text(contact);
  return point;
}

std::vector<CotEvent> TeamEvents::due(const TeamPicture& picture, const Mission& mission,
                                      Instant now) {
  std::vector<CotEvent> events;
  if (picture.over || !world_sends(picture)) return events;
  const auto add = [&](CotEvent event, PacingClock::duration period) {
    if (is_due(event, period, now)) events.push_back(std::move(event));
  };
  for (const AgentRow& row : picture.agents)
    if (has_new_place(picture, row)) add(robot(picture, mission, row), kRobotPeriod);
  for (const Zone& one : picture.zones) add(zone(picture, mission, one), kOtherPeriod);
  for (const Find& one : picture.finds) add(find(picture, one), kOtherPeriod);
  for (const Contact& one : picture.contacts) add(contact(picture, one), kOtherPeriod);
  std::erase_if(sent_, [now](const auto& one) { return now - one.second > 2 * kOtherPeriod; });
  return events;
}

}  // namespace ergocast::cli
