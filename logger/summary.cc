// SPDX-License-Identifier: BSD-3-Clause
// Collects the data of recorder, plan and process in one JSON object with a fixed order of keys.
#include "logger/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/home.h"
#include "core/motion/vehicle.h"
#include "logger/amendments_file.h"
#include "logger/json_file.h"
#include "logger/run_record.h"
#include "logger/slope.h"

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

/// Real time: the least share of late commands that the summary mentions.
constexpr double kNotableShare = 0.01;
/// The relative tolerance of a distance, for rounding.
constexpr double kRounding = 1e-9;
/// The limits of a summary that is read again: several times the size for the largest roster.
/// Limit (Record): length of `summary.json` and `recalls.json` [bytes]. Beyond it: `verify`,
/// `report` and other commands refuse the record.
constexpr std::size_t kMostSummaryBytes = std::size_t{16} << 20;
/// Limit (Record): values in `summary.json` and `recalls.json`. Beyond it: `verify`, `report` and
/// other commands refuse the record.
constexpr std::size_t kMostSummaryValues = 1'000'000;
constexpr JsonLimits kLimits{kMostSummaryBytes, kMostSummaryValues};

/// JSON has no infinity and no NaN.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json agents(const Recorder& recorder) {
  Json list = Json::array();
  const auto& mission = recorder.follower().mission();
  for (const RosterEntry& entry : recorder.follower().roster()) {
    Json agent{
        {"id", entry.author.agent},
        {"incarnation", to_hex(entry.author.incarnation)},
        {"active_from", entry.active_from},
        {"active_until", entry.active_until < 0 ? Json(nullptr) : Json(entry.active_until)},
        {"forgotten", entry.forgotten},
        {"coverage_switched_at", entry.since_tick > 0 ? Json(entry.since_tick) : Json(nullptr)}};
    if (!mission->kinds.empty()) agent["kind"] = name_of_kind(*mission, entry.kind);
    const auto known = recorder.statuses().find(entry.author);
    if (known != recorder.statuses().end()) {
      const AgentStatus& status = known->second;
      agent["host"] = status.host;
      agent["ergodic_metric"] = number(status.ergodic_metric);
      if (mission->basis.free_domain) agent["ergodic_metric_basis"] = name_of_basis(mission->basis);
      agent["max_staleness_s"] = number(status.max_staleness_s);
      agent["messages_sent"] = status.messages_sent;
      agent["messages_received"] = status.messages_received;
      agent["contributions_received"] = status.contributions_received;
      agent["contributions_lost"] = status.contributions_lost;
      agent["contributions_relayed"] = status.contributions_relayed;
      agent["missed_ticks"] = status.missed_ticks;
      if (keeps_distance(*mission)) {
        agent["blocked_ticks"] = status.blocked_ticks;
        agent["longest_block_ticks"] = status.longest_block_ticks;
      }
      agent["kernel_drops"] = status.kernel_drops;
      agent["loop_lag_max_s"] = number(status.loop_lag_s);
    }
    list.push_back(std::move(agent));
  }
  return list;
}

/// Sums over the agents' last statuses, plus what the recording process refused or lost.
Json messages(const Recorder& recorder, const RunContext& context) {
  std::int64_t sent = 0, received = 0, lost = 0, drops = context.kernel_drops;
  RefusalCounts refused = context.refused;
  for (const auto& [author, status] : recorder.statuses()) {
    sent += status.messages_sent;
    received += status.messages_received;
    lost += status.contributions_lost;
    drops += status.kernel_drops;
    for (std::size_t i = 0; i < refused.size(); ++i) refused[i] += status.refused[i];
  }
  Json reasons;
  for (std::size_t i = 0; i < refused.size(); ++i) {
    reasons[to_string(static_cast<Refusal>(i))] = refused[i];
  }
  return {{"sent", sent},
          {"received", received},
          {"lost", lost},
          {"kernel_drops", drops},
          {"refused", std::move(reasons)}};
}

Json conventions(const Basis& basis) {
  const std::string s = Json(basis.sobolev_exponent).dump();
  const bool squared = basis.sobolev_form == SobolevForm::kSquaredNorm;
  if (basis.free_domain) {
    return {{"basis", name_of_basis(basis)},
            {"table", to_hex(basis.table_hash)},
            {"h_k", basis.normalized ? "f_k divided by h_k = sqrt(integral of f_k^2)" : "1"},
            {"lambda", (squared ? "(1 + nu_k L^2 / pi^2)^-" : "(1 + sqrt(nu_k) L / pi)^-") + s}};
  }
  return {{"h_k", basis.normalized ? "f_k divided by h_k = sqrt(prod L_i (1/2)^[k_i > 0])" : "1"},
          {"lambda", (squared ? "(1 + |k|^2)^-" : "(1 + |k|)^-") + s}};
}

/// The highest speed limit, the limits that kinds have of their own, and how often one was
/// exceeded.
Json speed_limit(const Mission& mission, std::int64_t clamped_commands) {
  Json limits{{"mps", fastest_mps(mission)}, {"clamped_commands", clamped_commands}};
  for (const AgentKind& kind : mission.kinds) {
    if (kind.speed_limit_mps > 0) limits["kinds"][kind.name] = kind.speed_limit_mps;
  }
  return limits;
}

/// The least distance that occurred, and the cost of keeping a distance.
Json separation(const Recorder& recorder, const Mission& mission) {
  const Blocks blocks = recorder.blocks();
  const double nearest_m = recorder.facts().nearest_m;
  const bool measured = nearest_m < std::numeric_limits<double>::max();
  return {{"distance_m", mission.separation.distance_m},
          {"nearest_m", measured ? number(nearest_m) : Json(nullptr)},
          {"blocked_share", blocks.share},
          {"longest_block_s", static_cast<double>(blocks.longest_ticks) * mission.timing.dt_s}};
}

/// How many agents were home in time, and which were late. An agent is in time if it is at its
/// station in every row since its rest began, and at the mission's end. Agents without such a row
/// are not judged.
Json stations(const Recorder& recorder, const Mission& mission) {
  Json late = Json::array();
  double farthest_m = 0;
  const auto& from_home_m = recorder.facts().from_home_m;
  for (const auto& [id, apart_m] : from_home_m) {
    farthest_m = std::max(farthest_m, apart_m);
    if (!(apart_m <= home_m(mission, id) * (1 + kRounding))) late.push_back(id);
  }
  const std::size_t home = from_home_m.size() - late.size();
  return {{"agents", from_home_m.size()},
          {"home", home},
          {"late", std::move(late)},
          {"farthest_m", from_home_m.empty() ? Json(nullptr) : number(farthest_m)}};
}

/// The recorder's reason, with important remarks on the result.
std::string reason_of(const Recorder& recorder) {
  const RunFacts& facts = recorder.facts();
  if (facts.no_metric_from) {
    return recorder.reason() + ", but phi^2 is not a number from tick " +
           std::to_string(*facts.no_metric_from) + " on";
  }
  const auto agents = static_cast<double>(recorder.follower().roster().size());
  const double share = static_cast<double>(facts.missed_deadlines) /
                       std::max(1.0, static_cast<double>(facts.ticks) * agents);
  if (share < kNotableShare) return recorder.reason();
  char text[80];
  std::snprintf(text, sizeof text, "; %.0f %% of the commands came too late for their tick",
                std::min(100.0, 100 * share));
  return recorder.reason() + text;
}

// ---- the sections of the summary, in their order ----

/// Which run it was, how it ended, and what recorded it.
Json run_section(const Recorder& recorder, const RunContext& context) {
  return {{"run_id", to_hex(context.run)}, {"result", recorder.result()},
          {"reason", reason_of(recorder)}, {"started", context.started},
          {"version", context.version},    {"build", context.build},
          {"cpu_fma", context.cpu_has_fma}};
}

void add_mission(const Mission& mission, Tick tick_count, const RunContext& context,
                 Json& summary) {
  const bool lockstep = mission.timing.pace == Pace::kLockstep;
  summary["scenario"] = mission.name;
  summary["scenario_hash"] = context.scenario_hash;
  summary["seed"] = mission.seed;
  summary["mode"] = context.simulated ? "simulate" : lockstep ? "lockstep" : "realtime";
  if (!context.own_law.empty()) summary["own_law"] = context.own_law;
  if (!lockstep) summary["realtime_factor"] = mission.timing.realtime_factor;
  summary["dt_s"] = mission.timing.dt_s;
  summary["tick_count"] = tick_count;
}

void add_ticks(const Recorder& recorder, Json& summary) {
  const RunFacts& facts = recorder.facts();
  summary["ticks"] = facts.ticks - facts.held_ticks;
  if (Json recalls = recalls_json(recorder); !recalls.empty()) summary["recalls"] = recalls;
  if (recorder.amendments().empty()) return;
  const auto& mission = recorder.follower().mission();
  summary["amendments"] =
      amendments_json(recorder.amendments(), mission ? mission->timing.dt_s : 0);
  const auto holds = recorder.follower().holds();
  if (holds.empty()) return;
  summary["held_ticks"] = facts.held_ticks;
  summary["holds"] = holds_json(holds);
}

/// What the team made of each target: φ² of the time in which it held, against it.
Json targets(const RunFacts& facts, const std::optional<Mission>& mission) {
  Json list = Json::array();
  for (const TargetFacts& target : facts.targets) {
    Json& one = list.emplace_back();
    one = {{"amendment", target.amendment ? Json(target.amendment->number) : Json(nullptr)},
           {"from_tick", target.from},
           {"until_tick", target.until},
           {"ergodic_metric", number(target.ergodic_metric)}};
    if (mission && mission->basis.free_domain)
      one["ergodic_metric_in_cosines"] = number(target.cosine_metric);
  }
  return list;
}

/// φ², the goal that it had, and its slope.
void add_metric(const RunFacts& facts, const std::optional<Mission>& mission, Json& summary) {
  const bool observed = !facts.t_s.empty();
  const auto if_observed = [&](double value) { return observed ? number(value) : Json(nullptr); };
  summary["ergodic_metric"] = {{"first", if_observed(facts.ergodic_metric_first)},
                               {"last", if_observed(facts.ergodic_metric_last)}};
  if (mission && mission->basis.free_domain) {
    summary["ergodic_metric"]["basis"] = name_of_basis(mission->basis);
    summary["ergodic_metric_in_cosines"] = {{"last", if_observed(facts.cosine_metric_last)}};
  }
  if (!facts.targets.empty()) summary["targets"] = targets(facts, mission);
  if (mission && mission->goal_ergodic_metric > 0) {
    summary["goal"] = {
        {"ergodic_metric", mission->goal_ergodic_metric},
        {"reached", observed && facts.ergodic_metric_last <= mission->goal_ergodic_metric}};
    if (mission->basis.free_domain) summary["goal"]["basis"] = name_of_basis(mission->basis);
  }
  const auto slope = log_log_slope(facts.t_s, facts.ergodic_metric);
  summary["log_log_slope"] = slope ? number(*slope) : Json(nullptr);
}

/// What the team has achieved, core/measure/team_measures.h.
void add_team(const Recorder& recorder, const Mission& mission, Json& summary) {
  const auto team = recorder.team_figures();
  if (!team) return;
  const auto time = [](std::optional<double> time_s) { return time_s ? Json(*time_s) : Json(); };
  summary["sensor"] = {{"radius_m", sensor_radius_m(mission)},
                       {"detections_per_s", mission.sensor.detections_per_s}};
  summary["detection"] = {{"probability", number(team->detection_probability)},
                          {"time_to_half_s", time(team->half_time_s)},
                          {"time_to_four_fifths_s", time(team->four_fifths_time_s)}};
  summary["greatest_age_s"] = number(team->greatest_age_s);
  summary["sliced_wasserstein_m"] = number(team->wasserstein_m);
  summary["path_m"] = number(team->path_m);
}

/// With false alarms: what is confirmed, and what may still be an object.
void add_contacts(const Recorder& recorder, Json& summary) {
  Json list = Json::array();
  for (const Contact& contact : recorder.contacts()) {
    list.push_back({{"x_m", contact.x_m.x()},
                    {"y_m", contact.x_m.y()},
                    {"probability", contact.probability},
                    {"reports", contact.reports},
                    {"t_s", contact.t_s},
                    {"confirmed", contact.confirmed}});
  }
  summary["contacts"] = std::move(list);
}

/// Which of the mission's objects the team has found, in the order of the finds.
void add_objects(const RunFacts& facts, Json& summary) {
  if (facts.wrong_confirmations) summary["wrong_confirmations"] = *facts.wrong_confirmations;
  const Finds& finds = facts.finds;
  if (finds.objects() == 0) return;
  Json list = Json::array();
  for (const Find& find : finds.list()) {
    list.push_back({{"object", find.object},
                    {"agent", find.agent},
                    {"tick", find.tick},
                    {"t_s", find.t_s},
                    {"x_m", find.x_m.x()},
                    {"y_m", find.x_m.y()}});
  }
  summary["objects"] = {
      {"count", finds.objects()}, {"found", finds.list().size()}, {"finds", std::move(list)}};
}

void add_wall_time(const RunFacts& facts, const RunContext& context, Json& summary) {
  const auto ticks = static_cast<double>(facts.ticks - facts.former_ticks);
  summary["wall_time_s"] = context.wall_time_s;
  summary["ticks_per_s"] =
      context.wall_time_s > 0 ? number(ticks / context.wall_time_s) : Json(nullptr);
}

/// What the record lacks, and what the world could not do in time.
void add_losses(const RunFacts& facts, const RunContext& context, Json& summary) {
  summary["gaps"] = facts.gaps;
  summary["lost_positions"] = facts.lost_positions;
  summary["missing_positions"] = facts.missing_positions;
  if (facts.halted) summary["emergency_stop"] = true;
  summary["segments"] = context.segments;
  summary["interruptions"] = context.interruptions;
  summary["events_removed"] = context.events_removed;
  summary["missed_deadlines"] = facts.missed_deadlines;
  summary["skipped_ticks"] = facts.skipped_ticks;
}

/// What bounded the motion of the vehicles.
void add_motion(const Recorder& recorder, const Mission& mission, Json& summary) {
  if (fastest_mps(mission) > 0)
    summary["speed_limit"] = speed_limit(mission, recorder.facts().clamped_commands);
  if (keeps_distance(mission)) summary["separation"] = separation(recorder, mission);
  if (any_station(mission)) summary["stations"] = stations(recorder, mission);
}

// ---- reading ----

/// Reads a list of recalls_json(); empty if its content is impossible.
std::map<AgentId, Tick> recalls_in(const Json& list) {
  std::map<AgentId, Tick> recalls;
  if (!list.is_array()) return recalls;
  for (const Json& recall : list) {
    const auto number = [&](const char* key) {
      const Json value = recall.is_object() ? recall.value(key, Json()) : Json();
      return value.is_number_unsigned() ? value.get<Tick>() : -1;
    };
    const Tick agent = number("agent"), from = number("from_tick");
    if (agent < 0 || agent >= kMaxAgents || from < 0) return {};
    recalls.emplace(static_cast<AgentId>(agent), from);
  }
  return recalls;
}

}  // namespace

Json summarize(const Recorder& recorder, const RunContext& context) {
  const RunFacts& facts = recorder.facts();
  const auto& mission = recorder.follower().mission();
  Json summary = run_section(recorder, context);
  if (mission)
    add_mission(*mission, tick_count_of(mission->timing, recorder.follower().amendments().ends),
                context, summary);
  add_ticks(recorder, summary);
  add_metric(facts, mission, summary);
  if (mission) add_team(recorder, *mission, summary);
  if (facts.wrong_confirmations) add_contacts(recorder, summary);
  add_objects(facts, summary);
  if (mission) summary["conventions"] = conventions(mission->basis);
  add_wall_time(facts, context, summary);
  summary["agents"] = agents(recorder);
  summary["messages"] = messages(recorder, context);
  add_losses(facts, context, summary);
  if (mission) add_motion(recorder, *mission, summary);
  return summary;
}

const char* name_of_basis(const Basis& basis) {
  return basis.free_domain ? "modes of the free domain" : "cosines";
}

Result<Json> read_summary(const std::filesystem::path& run_dir) {
  return read_json(run_dir / kSummaryFile, kLimits);
}

Json recalls_json(const Recorder& recorder) {
  std::map<AgentId, Tick> from_ticks = recorder.facts().recalls;
  std::set<AgentId> sent_out;
  for (const RosterEntry& entry : recorder.follower().roster()) {
    if (!entry.leaves) continue;
    sent_out.insert(entry.author.agent);
    // An agent that left at once has no row in which it rests.
    if (entry.active_until >= 0) from_ticks.try_emplace(entry.author.agent, entry.active_until);
  }
  Json list = Json::array();
  for (const auto& [id, from_tick] : from_ticks)
    list.push_back({{"agent", id}, {"from_tick", from_tick}, {"sent_out", sent_out.contains(id)}});
  return list;
}

std::map<AgentId, Tick> recorded_recalls(const std::filesystem::path& run_dir,
                                         const Json& summary) {
  const auto early = read_json(run_dir / kRecallsFile, kLimits);
  if (early && early->is_array()) return recalls_in(*early);
  return summary.is_object() ? recalls_in(summary.value("recalls", Json()))
                             : std::map<AgentId, Tick>();
}

std::string to_text(const Json& summary) {
  return summary.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace ergocast
