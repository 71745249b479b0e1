// SPDX-License-Identifier: BSD-3-Clause
// Selects the values of a record that the page needs, with no more digits than it shows.
#include "report/page.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "core/mission/end_schedule.h"
#include "core/mission/station.h"
#include "core/motion/vehicle.h"
#include "core/motion/way_home.h"
#include "report/page_mission.h"
#include "report/track_grid.h"
#include "report/web_page.h"

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

/// All rows of a short mission; the first and then every few rows of a long one.
Json metrics(const RunData& run) {
  constexpr std::size_t kFirst = 500, kMost = 4000;
  const std::size_t every = run.metrics.size() / kMost + 1;
  Json t = Json::array(), phi = Json::array(), found = Json::array(), spread = Json::array(),
       age = Json::array(), received = Json::array(), lost = Json::array();
  for (std::size_t i = 0; i < run.metrics.size(); ++i) {
    if (i > kFirst && i % every != 0 && i + 1 != run.metrics.size()) continue;
    const MetricsRow& row = run.metrics[i];
    t.push_back(page_number(row.t_s, 9));
    phi.push_back(page_number(row.ergodic_metric));
    found.push_back(page_number(row.detection_probability));
    spread.push_back(page_number(row.spread, 3));
    age.push_back(page_number(row.max_staleness_s, 4));
    received.push_back(row.received);
    lost.push_back(row.lost);
  }
  return {{"t", std::move(t)},           {"phi", std::move(phi)}, {"found", std::move(found)},
          {"spread", std::move(spread)}, {"age", std::move(age)}, {"received", std::move(received)},
          {"lost", std::move(lost)}};
}

/// The first tick at which the track's positions send the agent home; nullopt if there is none.
std::optional<Tick> home_from(const RunData& run, const Mission& mission, AgentId id,
                              const Track& track) {
  WayHome way(mission, id);
  const EndSchedule ends(mission, run.holds(), run.amendments.ends());
  std::optional<Tick> since;
  for (const TrackPoint& at : track) {
    if (is_held(run.holds(), at.tick)) continue;
    const Tick counted = counted_ticks(run.holds(), at.tick);
    way.set_rest(ends.rest_from(mission, id, counted));
    const bool goes = way.begun(counted, at.x_m);
    if (!goes) since.reset();  // a later end was named
    if (goes && !since) since = at.tick;
  }
  return since;
}

Json homes_from(const RunData& run, const Mission& mission) {
  Json list = Json::object();
  for (const auto& [id, track] : run.tracks) {
    if (!station_of(mission, id)) continue;
    if (const auto tick = home_from(run, mission, id, track)) list[std::to_string(id)] = *tick;
  }
  return list;
}

/// The amendments of the record, and the targets that it has.
void add_amendments(const ReceivedAmendments& heard, const Mission& mission, Json& record) {
  if (heard.empty()) return;
  std::vector<Amendment> list;
  std::vector<Zone> zones;
  std::vector<LawChange> laws;
  std::vector<SearchNote> notes;
  Json targets = Json::object();
  for (const ReceivedAmendment& one : heard.all()) {
    if (one.is_void) continue;
    list.push_back(one.amendment);
    if (one.target) targets[page_target_name(one.amendment.hash)] = page_target(*one.target);
    if (one.zone) zones.push_back(*one.zone);
    if (one.law) laws.push_back(*one.law);
    if (one.note) notes.push_back(*one.note);
  }
  record["amendments"] = page_amendments(list, laws, notes, mission);
  record["targets"] = std::move(targets);
  if (!zones.empty()) record["zones"] = page_zones(zones, mission.domain);
}

/// The agents that stand in the last state that the record has of them.
Json standing_at_the_end(const RunData& run, const Mission& mission) {
  Json list = Json::array();
  for (const auto& [agent, track] : run.tracks)
    if (stands(motion_of(mission, agent), track.back().v_mps)) list.push_back(agent);
  return list;
}

/// The command of a vehicle that turns is its velocity at the tick's end.
void put(TrackGrid& grid, AgentId agent, const Track& track) {
  const TrackPoint* before = nullptr;
  for (const TrackPoint& point : track) {
    const bool follows = before != nullptr && before->tick + 1 == point.tick;
    grid.put(agent, point.tick, point.x_m, follows ? before->v_mps : point.v_mps);
    before = &point;
  }
}

}  // namespace

Json page_record(const RunData& run, const Mission& mission, const Json& summary,
                 const Field& density, const Json& team) {
  Tick ticks = 0;
  for (const auto& [agent, track] : run.tracks) ticks = std::max(ticks, track.back().tick + 1);
  TrackGrid grid(mission.domain, run.tracks.size(), any_that_turn(mission));
  for (const auto& [agent, track] : run.tracks) put(grid, agent, track);
  const auto law = fit_last_decade(run);
  Json record = {{"mission", page_mission(mission, density)},
                 {"summary", summary},
                 {"metrics", metrics(run)},
                 {"slope", law ? page_number(law->slope, 3) : Json(nullptr)},
                 {"ticks", ticks},
                 {"stride", grid.stride()},
                 {"rows", grid.rows()},
                 {"tracks", grid.encode(0, grid.rows())},
                 {"standing", standing_at_the_end(run, mission)},
                 {"team", team}};
  if (team.is_null() && any_station(mission)) record["home_from"] = homes_from(run, mission);
  add_amendments(run.amendments, mission, record);
  return record;
}

std::string report_page(const RunData& run, const Mission& mission, const Json& summary,
                        const Field& density, const Json& team) {
  return html_file(run_web_page(), title_of(mission),
                   {{"record", page_record(run, mission, summary, density, team)}});
}

}  // namespace ergocast
