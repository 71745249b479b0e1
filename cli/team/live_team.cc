// SPDX-License-Identifier: BSD-3-Clause
// Keeps positions on a grid, and compares each picture of the team with the previous one. Divides
// the new data for a browser into frames.
#include "cli/team/live_team.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/team/team_text.h"
#include "core/motion/vehicle.h"
#include "report/page_mission.h"

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

/// A gap of at most twice this mission time is not reported.
constexpr double kShortGap_s = 1;
/// As the page averages the velocity of a point (report/web/data/motion.js).
constexpr double kMeanOfCommands_s = 1;
/// The most commands of an agent in this mean.
constexpr std::size_t kMostCommands = 256;
constexpr std::int64_t kPositionsPerFrame = 20'000;

std::string event(const char* name, const Json& data) {
  return std::string("event: ") + name +
         "\ndata: " + data.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n\n";
}

}  // namespace

LiveTeam::LiveTeam(RunId run, Instant since, bool authenticated, bool replay)
    : me_(kRole, {run, kUnassigned, 0}),
      view_(run, since, authenticated, replay),
      authenticated_(authenticated),
      replay_(replay) {}

void LiveTeam::begin(const Mission& mission, const Field& density) {
  if (grid_) return;
  grid_.emplace(mission.domain, mission.starts_m.size(), any_that_turn(mission));
  mission_ = page_mission(mission, density);
}

void LiveTeam::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  view_.receive(message, bus, transmitter, now);
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  if (me_.knows_mission()) begin(me_.mission(), {});
  std::visit([&](const auto& m) { on(m); }, message);
}

void LiveTeam::on(const WorldState& world) {
  world_tick_ = std::max(world_tick_, world.header.tick);
  if (world.roster_revision > used_revision_) {
    used_revision_ = world.roster_revision;
    used_since_ = world.header.tick;
    note_recalls();
  }
  if (!grid_) return;
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    grid_->put(vehicle.id, world.header.tick, vehicle.position_m, vehicle.velocity_mps);
  }
}

/// A command for a tick far ahead of the world would be the newest one for long.
void LiveTeam::on(const Command& command) {
  const Tick tick = command.header.tick;
  if (!me_.knows_mission() || command.header.sender < 0 || tick < 0) return;
  const Tick second = std::max<Tick>(1, std::llround(kMeanOfCommands_s / me_.timing().dt_s));
  if (tick > world_tick_ + second) return;
  auto& commands = commands_mps_[command.header.sender];
  commands[tick] = command.velocity_mps;
  commands.erase(commands.begin(), commands.upper_bound(commands.rbegin()->first - second));
  while (commands.size() > kMostCommands) commands.erase(commands.begin());
}

void LiveTeam::on(const MissionPart&) {
  if (me_.knows_mission()) amendments_.note(me_.follower().amendments());
  note_recalls();
}

/// An agent rests from when the world uses the revision that recalls it.
void LiveTeam::note_recalls() {
  for (const RosterEntry& entry : me_.follower().roster()) {
    if (entry.recalled_at(used_revision_) &&
        recalled_from_.try_emplace(entry.author.agent, used_since_).second)
      ++rosters_;
  }
}

void LiveTeam::log(std::string line) {
  lines_.push_back(std::move(line));
  ++line_count_;
  if (lines_.size() > kMostLines) lines_.pop_front();
}

TeamPicture LiveTeam::notice(Instant now) {
  TeamPicture picture = view_.picture(now);
  if (!grid_ || picture.over) return picture;
  const double t_s = static_cast<double>(picture.tick) * picture.dt_s;
  note_holds(picture.tick, picture.dt_s);
  for (const AgentRow& row : picture.agents) compare(row, t_s, picture.dt_s);
  for (const ProcessRow& row : picture.processes) compare(row, t_s);
  return picture;
}

TeamPicture LiveTeam::look(Instant now) {
  TeamPicture picture = notice(now);
  if (!grid_) return picture;
  end_text_ = picture.reason;
  picture.clients = clients_;
  status_ = Json::parse(team_json(picture));
  // The page's time continues in a pause, as in the record.
  status_["t_s"] = static_cast<double>(picture.tick) * picture.dt_s;
  status_["commands_mps"] = commands_json();
  history_.add(picture);
  agents_.add(picture, now);
  ++statuses_;
  if (me_.follower().revision() != roster_revision_) {
    roster_revision_ = me_.follower().revision();
    ++rosters_;
  }
  return picture;
}

bool LiveTeam::joined_late(const Author& author) const {
  const RosterEntry* entry = me_.follower().entry_of(author.incarnation);
  return entry != nullptr && entry->active_from > 0;
}

void LiveTeam::compare(const AgentRow& row, double t_s, double dt_s) {
  const std::string name = std::to_string(row.author.agent);
  const auto [at, is_new] = last_looks_.try_emplace(row.author.agent);
  LastLook& last = at->second;
  const auto gone = [](Condition c) { return c == Condition::kGone; };
  if (!is_new && row.author.incarnation != last.incarnation) {
    const bool was_away = outages_.contains(name);
    if (!was_away && t_s - last.heard_s > 2 * kShortGap_s) {
      outages_[name] = last.heard_s;
      add_incident({last.heard_s, "silent", "×", name + " silent", row.author.agent, {}});
    }
    add_incident({t_s,
                  "ok",
                  was_away ? "+" : "↻",
                  name + (was_away ? " back" : " restarted"),
                  row.author.agent,
                  {}});
    close_outage(name, t_s);
  } else if (is_new && row.restarts == 0 && joined_late(row.author)) {
    add_incident({t_s, "ok", "+", name + " joined", row.author.agent, {}});
  }
  if (row.condition == Condition::kSilent && !outages_.contains(name)) {
    outages_[name] = std::max(0.0, t_s);
    add_incident({t_s, "silent", "×", name + " silent", row.author.agent, {}});
  } else if (gone(row.condition) && (is_new || !gone(last.condition))) {
    outages_.try_emplace(name, t_s);
    add_incident({t_s, "gone", "–", name + " left", row.author.agent, {}});
  } else if (row.condition >= Condition::kOk && !gone(row.condition) && outages_.contains(name)) {
    add_incident({t_s, "ok", "+", name + " back", row.author.agent, {}});
    close_outage(name, t_s);
  }
  const double heard_s = row.status ? static_cast<double>(row.status->header.tick) * dt_s : 0;
  last = {row.condition, row.author.incarnation, heard_s};
}

/// Uses the ticks that MISSION names, not the time at which they arrive.
void LiveTeam::note_holds(Tick tick, double dt_s) {
  const auto holds = me_.follower().holds();
  const auto named = static_cast<std::size_t>(named_changes(holds));
  for (; changes_noted_ < named; ++changes_noted_) {
    const Hold& hold = holds[changes_noted_ / 2];
    const bool begins = changes_noted_ % 2 == 0;
    if (tick < (begins ? hold.from : hold.until)) return;
    const double from_s = static_cast<double>(hold.from) * dt_s;
    if (begins) {
      outages_["paused"] = from_s;
      add_incident({from_s, "paused", "‖", "paused by an operator", {}, {}});
    } else {
      close_outage("paused", static_cast<double>(hold.until) * dt_s);
      ++incident_changes_;
    }
  }
}

void LiveTeam::compare(const ProcessRow& row, double t_s) {
  bool& was = trouble_[row.name];
  if (row.trouble && !was) {
    outages_[row.name] = t_s;
    add_incident({t_s, "silent", "×", row.name + " silent", {}, {}});
  } else if (!row.trouble && was) {
    add_incident({t_s, "ok", "+", row.name + " back", {}, {}});
    close_outage(row.name, t_s);
  }
  was = row.trouble;
}

void LiveTeam::add_incident(Incident incident) {
  incidents_.push_back(std::move(incident));
  if (incidents_.size() > kMostIncidents) incidents_.pop_front();
  ++incident_changes_;
}

/// Ends the bar of the outage, which is drawn at its first incident.
void LiveTeam::close_outage(const std::string& of, double t_s) {
  const auto outage = outages_.find(of);
  if (outage == outages_.end()) return;
  const auto begin = std::find_if(incidents_.begin(), incidents_.end(), [&](const Incident& one) {
    return one.t_s == outage->second && !one.until_s && one.text.starts_with(of + ' ');
  });
  if (begin != incidents_.end()) begin->until_s = t_s;
  outages_.erase(outage);
}

Json LiveTeam::incidents_json() const {
  Json list = Json::array();
  for (const Incident& one : incidents_) {
    Json json = {{"t", one.t_s}, {"kind", one.kind}, {"sign", one.sign}, {"text", one.text}};
    if (one.agent) json["agent"] = *one.agent;
    if (one.until_s) json["until"] = *one.until_s;
    list.push_back(std::move(json));
  }
  return list;
}

Json LiveTeam::roster_json() const {
  Json list = Json::array();
  for (const RosterEntry& entry : me_.follower().roster()) {
    Json json = {{"id", entry.author.agent}, {"active_from", entry.active_from}};
    if (entry.active_until >= 0) json["active_until"] = entry.active_until;
    if (const auto recall = recalled_from_.find(entry.author.agent); recall != recalled_from_.end())
      json["recalled_from"] = recall->second;
    list.push_back(std::move(json));
  }
  return list;
}

/// {"0": [x, y], …}: what each agent commands. A point's single commands are mostly noise, so the
/// mean of the newest second is shown.
Json LiveTeam::commands_json() const {
  Json json = Json::object();
  const int axes = me_.knows_mission() && !me_.mission().domain.planar() ? 3 : 2;
  for (const auto& [agent, commands] : commands_mps_) {
    Eigen::Vector3d mean_mps = commands.rbegin()->second;
    if (motion_of(me_.mission(), agent).is_point()) {
      mean_mps.setZero();
      for (const auto& [tick, v_mps] : commands) mean_mps += v_mps;
      mean_mps /= static_cast<double>(commands.size());
    }
    json[std::to_string(agent)] = std::vector<double>(mean_mps.data(), mean_mps.data() + axes);
  }
  return json;
}

std::string LiveTeam::frame(Cursor& cursor, bool& more) const {
  more = false;
  std::string text;
  if (grid_ && cursor.stride != grid_->stride()) {
    cursor = {.stride = grid_->stride(), .lines = cursor.lines};
    text += event("mission", {{"mission", mission_},
                              {"stride", grid_->stride()},
                              {"run_id", to_hex(run())},
                              {"past", history_.json()},
                              {"team", agents_.json()},
                              {"authenticated", authenticated_},
                              {"replay", replay_}});
  }
  Json frame = Json::object();
  if (cursor.rosters != rosters_) frame["roster"] = roster_json();
  if (grid_) amendments_.add_new(cursor.amendments, me_.mission(), frame);
  // The newest row may lack a part of the world's message.
  const std::int64_t complete = grid_ ? grid_->rows() - (over() ? 0 : 1) : 0;
  if (complete > cursor.row) {
    const auto agents = std::max<std::int64_t>(1, std::ssize(last_looks_));
    const std::int64_t most = std::max<std::int64_t>(1, kPositionsPerFrame / agents);
    const std::int64_t to = std::min(complete, cursor.row + most);
    frame["tracks"] = grid_->encode(cursor.row, to);
    more = to < complete;
    cursor.row = to;
  }
  if (cursor.statuses != statuses_ && !more) {
    frame["team"] = status_;
    cursor.statuses = statuses_;
  }
  if (cursor.incidents != incident_changes_) frame["incidents"] = incidents_json();
  if (cursor.lines != line_count_) {
    const std::size_t fresh = std::min<std::size_t>(line_count_ - cursor.lines, lines_.size());
    frame["log"] =
        std::vector<std::string>(lines_.end() - static_cast<std::ptrdiff_t>(fresh), lines_.end());
  }
  cursor.rosters = rosters_;
  cursor.incidents = incident_changes_;
  cursor.lines = line_count_;
  if (!frame.empty()) text += event("frame", frame);
  return text;
}

}  // namespace ergocast
