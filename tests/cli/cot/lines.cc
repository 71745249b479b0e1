// SPDX-License-Identifier: BSD-3-Clause
// Prints events of a team as lines of JSON, for a comparison with another program's reading: the
// XML, and what it means.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/tak/team_events.h"
#include "tests/support/team.h"

namespace ergocast::cli {
namespace {

using Json = nlohmann::ordered_json;

AgentRow robot(AgentId id, std::vector<double> x_m, std::vector<double> velocity_mps) {
  AgentRow row;
  row.author = test::author_of(id);
  row.position_m = std::move(x_m);
  row.velocity_mps = std::move(velocity_mps);
  row.position_tick = 0;
  return row;
}

/// A team with all that there is to show, and a name that has to be escaped.
TeamPicture picture() {
  TeamPicture picture;
  picture.run = test::kRun;
  picture.scenario = "R&D <\"sea\"> 'ä' ]]>";
  picture.dt_s = 0.1;
  picture.processes.resize(1);
  picture.processes[0].name = "world";
  picture.processes[0].heard = true;
  picture.agents = {robot(0, {10, 20}, {3, -4}), robot(1, {-500, 900}, {0, 0})};
  Zone zone;
  zone.number = 2;
  zone.corners_m = {{0, 0}, {300, 0}, {300, 200}, {0, 200}};
  picture.zones = {zone};
  picture.finds = {{.object = 5, .agent = 1, .t_s = 12, .x_m = {40, 50, 0}}};
  picture.contacts = {{.cell = 77, .reports = 3, .x_m = {60, 70}}};
  return picture;
}

Json position(const GeoPlace& place) { return {place.longitude_deg, place.latitude_deg}; }

Json line_of(const CotEvent& event, WallTime time) {
  const auto ms = [](WallTime at) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(at.time_since_epoch()).count();
  };
  Json line = {{"xml", cot_xml(event, time)},
               {"uid", event.uid},
               {"type", event.type},
               {"how", event.how},
               {"callsign", event.callsign},
               {"remarks", event.remarks},
               {"place", position(event.place)},
               {"time_ms", ms(time)},
               {"stale_ms", ms(time + event.lasts)}};
  if (event.track) {
    line["course_deg"] = event.track->course_deg;
    line["speed_mps"] = event.track->speed_mps;
  }
  for (const GeoPlace& corner : event.outline) line["outline"].push_back(position(corner));
  return line;
}

void print() {
  const WallTime time(std::chrono::milliseconds(1'769'860'800'250));
  for (const GeoPlace& origin : {GeoPlace{47.5, 9.2}, GeoPlace{-33.9, 18.4}, GeoPlace{0, 180}})
    for (const CotEvent& event : TeamEvents(origin).due(picture(), test::small_mission(2), {}))
      std::printf("%s\n", line_of(event, time).dump().c_str());
}

}  // namespace
}  // namespace ergocast::cli

int main() { ergocast::cli::print(); }
