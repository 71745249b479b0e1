// SPDX-License-Identifier: BSD-3-Clause
// Writes what a tick adds to the two tables, and adds it to the facts.
#include "logger/record_tables.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/require.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/home.h"
#include "core/motion/starts.h"

namespace ergocast {
namespace {

constexpr double kMetricsPeriod_s = 1.0;

/// 17 significant digits: reading them back gives the same double.
void append_number(std::string& line, double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17);
  line.append(text, end.ptr);
}

/// The member that drives this vehicle at `tick`; null if none does. Other vehicles stand still and
/// cover nothing.
const RosterEntry* member(const MissionFollower& follower, AgentId id, Tick tick) {
  const auto entries = entries_of(id, follower.roster());
  const auto at = std::ranges::find_if(
      entries, [&](const RosterEntry& entry) { return entry.active_at(tick); });
  return at == entries.end() ? nullptr : &*at;
}

/// What a row of the metrics has from the agents' reports.
struct ReportedFigures {
  double low = 0, high = 0;  // of the agents' own φ²
  double staleness_s = 0;
  std::int64_t received = 0, lost = 0;
};

ReportedFigures figures_of(const AgentReports& reports, const MissionFollower& follower,
                           Tick tick) {
  ReportedFigures team;
  bool first = true;
  for (const auto& [author, status] : reports.statuses()) {
    team.received += status.contributions_received;
    team.lost += status.contributions_lost;
    const RosterEntry* entry = follower.entry_of(author.incarnation);
    if (entry == nullptr || !entry->active_at(tick)) continue;
    team.staleness_s = std::max(team.staleness_s, status.max_staleness_s);
    if (status.answered_tick < 0) continue;  // it has no coverage yet
    team.low = first ? status.ergodic_metric : std::min(team.low, status.ergodic_metric);
    team.high = first ? status.ergodic_metric : std::max(team.high, status.ergodic_metric);
    first = false;
  }
  return team;
}

}  // namespace

const char* trajectory_header(const Mission& mission) {
  if (mission.sensor.has_false_alarms()) return kTrajectoryHeaderWithReports;
  if (mission.objects.total() > 0) return kTrajectoryHeaderWithObjects;
  return mission.domain.planar() ? kTrajectoryHeader : kTrajectoryHeaderInSpace;
}

RecordTables::RecordTables(std::ostream& trajectory, std::ostream& metrics)
    : trajectory_(trajectory), metrics_(metrics) {
  ERGOCAST_REQUIRE(good());
  metrics_ << kMetricsHeader << '\n';
}

void RecordTables::flush() {
  trajectory_.flush();
  metrics_.flush();
}

void RecordTables::begin(const Mission& mission) {
  observer_.begin(mission);
  if (mission.basis.free_domain) {
    in_cosines_ = in_cosines(mission);
    cosines_.begin(*in_cosines_);
  }
  measures_ = TeamMeasures(in_cosines_ ? *in_cosines_ : mission);
  confirmations_ = Confirmations(mission);
  facts_.finds = Finds(mission.objects.total());
  trajectory_ << trajectory_header(mission) << '\n';
}

void RecordTables::begin_without_mission() {
  if (!begun()) trajectory_ << kTrajectoryHeader << '\n';
}

RowTick RecordTables::replay(const RunData& past, const MissionKnowledge& known) {
  const Mission& mission = *known.follower.mission();
  const std::span<const Hold> holds = known.follower.holds();
  const auto counted = [&](Tick tick) { return counted_ticks(holds, tick); };
  for (const MetricsRow& metrics : past.metrics) {
    facts_.t_s.push_back(static_cast<double>(counted(metrics.tick)) * mission.timing.dt_s);
    facts_.ergodic_metric.push_back(metrics.ergodic_metric);
  }
  if (!past.metrics.empty()) {
    former_metrics_ = past.metrics.back();
    facts_.ergodic_metric_first = facts_.ergodic_metric.front();
    facts_.ergodic_metric_last = facts_.ergodic_metric.back();
  }
  facts_.recalls = past.recalls;
  RowTick row;
  const Context context{row, known, {mission, known.follower.amendments()}};
  std::size_t vehicles = 0, expected = mission.starts_m.size();
  for_each_row(past, [&](AgentId id, const TrackPoint& point) {
    if (point.tick > former_end_.first) {
      if (vehicles > 0) end_row(context);
      expected = std::max(expected, vehicles);
      row = {point.tick, point.tick - counted(point.tick), !is_held(holds, point.tick)};
      begin_row(context);
      vehicles = 0;
      ++facts_.ticks;
      facts_.held_ticks += row.counts ? 0 : 1;
    }
    observe(context, id, {point.x_m, came_with_mps(past.tracks.at(id), point.tick)},
            {point.detected, point.reported_cell});
    row_places_m_.push_back(point.x_m);
    ++vehicles;
    former_end_ = {point.tick, id};
  });
  facts_.former_ticks = facts_.ticks;
  facts_.gaps = former_end_.first + 1 - facts_.ticks;
  // With fewer rows, the last tick may be incomplete, and is recorded to its end.
  if (vehicles == 0 || vehicles < expected) return row;
  end_row(context);
  row.pass();
  return row;
}

void RecordTables::write(const RowTick& row, const TickState& now, const TickState& next,
                         const MissionKnowledge& known) {
  // A pause that only the world received is lost if its coordinator stops: its ticks then count.
  facts_.held_ticks = std::min(facts_.held_ticks, now.uncounted_ticks);
  const Context context{
      row, known, {*known.follower.mission(), known.follower.amendments()}, now.roster_revision};
  begin_row(context);
  write_trajectory(context, now, next);
  end_row(context);
  if (row.tick <= former_end_.first) return;
  ++facts_.ticks;
  facts_.held_ticks += row.counts ? 0 : 1;
}

void RecordTables::skip(const RowTick& row, Tick tick) {
  facts_.gaps += tick - std::max(row.tick, former_end_.first + 1);
}

void RecordTables::write_trajectory(const Context& context, const TickState& now,
                                    const TickState& next) {
  const Mission& mission = context.mission();
  const Tick tick = context.row.tick;
  const double t_s = static_cast<double>(tick) * mission.timing.dt_s;
  const int axes = mission.domain.planar() ? 2 : 3;
  std::string line;
  for (const auto& [id, vehicle] : now.vehicles) {
    const auto after = next.vehicles.find(id);
    if (after == next.vehicles.end() || std::pair(tick, id) <= former_end_) continue;
    const Seen seen = observe(context, id, {vehicle.position_m, vehicle.velocity_mps},
                              {vehicle.detected, vehicle.reported_cell});
    // Two bodies may pass each other where the lines between their places cross.
    if (!now.lost.contains(id)) row_places_m_.push_back(vehicle.position_m);
    if (context.row.is_last(context.ends.tick_count()))
      note_home(mission, id, after->second.position_m);
    line += std::to_string(tick) + ',';
    append_number(line, t_s);
    line += ',' + std::to_string(id);
    for (const Eigen::Vector3d& vector : {vehicle.position_m, after->second.velocity_mps}) {
      for (int axis = 0; axis < axes; ++axis) {
        line += ',';
        append_number(line, vector[axis]);
      }
    }
    if (mission.objects.total() > 0 || mission.sensor.has_false_alarms())
      line += ',' + std::to_string(seen.detected);
    if (mission.sensor.has_false_alarms()) line += ',' + std::to_string(seen.cell);
    line += '\n';
  }
  trajectory_ << line;
}

/// Notes how far an agent that must be at home is from its station.
void RecordTables::note_home(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m) {
  const auto home_m = station_of(mission, id);
  if (!home_m) return;
  double& farthest_m = facts_.from_home_m[id];
  farthest_m = std::max(farthest_m, (x_m - *home_m).norm());
}

/// Whether an agent rests because it was recalled. It then rests in all later rows, too.
bool RecordTables::is_recalled(const Context& context, AgentId id) {
  const Tick tick = context.row.tick;
  if (const auto known = facts_.recalls.find(id); known != facts_.recalls.end())
    return tick >= known->second;
  const bool recalled = std::ranges::any_of(
      entries_of(id, context.known.follower.roster()),
      [&](const RosterEntry& entry) { return entry.recalled_at(context.roster_revision); });
  if (recalled) facts_.recalls.emplace(id, tick);
  return recalled;
}

/// Returns what of `seen` counts: an agent that covers nothing finds nothing.
RecordTables::Seen RecordTables::observe(const Context& context, AgentId id, const Pose& at,
                                         Seen seen) {
  const Mission& mission = context.mission();
  const Eigen::Vector3d& x_m = at.x_m;
  const RosterEntry* entry = member(context.known.follower, id, context.row.tick);
  const bool charging = entry != nullptr && entry->active_from < context.row.tick &&
                        charges(mission, id, x_m, at.v_mps);
  const bool covers =
      entry != nullptr && context.row.counts && !is_recalled(context, id) && !charging;
  const Tick counted = context.row.counted();
  const bool rests = context.ends.rests(mission, id, counted);
  measures_.see(id, counted, x_m, covers && !rests);
  if (rests) {
    note_home(mission, id, x_m);
  } else if (covers) {
    observer_.see(mission, counted, entry->kind, x_m);
    if (in_cosines_) cosines_.see(*in_cosines_, counted, entry->kind, x_m);
  }
  if (!covers || rests) return {0, kNoCell};
  seen.detected = facts_.finds.known(seen.detected);
  const double t_s = static_cast<double>(counted) * mission.timing.dt_s;
  facts_.finds.note(confirmations_.see(id, counted, x_m, seen.detected, seen.cell),
                    {.agent = id, .tick = context.row.tick, .t_s = t_s, .x_m = x_m});
  if (mission.sensor.has_false_alarms()) facts_.wrong_confirmations = confirmations_.wrong();
  return seen;
}

/// Has the observers count against the target that holds at the row's tick.
void RecordTables::begin_row(const Context& context) {
  const ReceivedAmendment* const change = context.known.amendments.target_at(context.row.tick);
  const std::optional<Amendment> wanted =
      change != nullptr ? std::optional(change->amendment) : std::nullopt;
  const std::optional<Amendment> present =
      facts_.targets.empty() ? std::nullopt : facts_.targets.back().amendment;
  if (wanted != present) begin_target(context, change);
  confirmations_.note(context.known.amendments.notes(), context.known.follower.holds());
}

/// @param change  null: the plan's target, because the change that held is void
void RecordTables::begin_target(const Context& context, const ReceivedAmendment* change) {
  const Mission& mission = context.mission();
  if (facts_.targets.empty()) facts_.targets.emplace_back();
  const Tick named = change != nullptr ? change->amendment.from : context.row.tick;
  const Tick from = std::max(named, facts_.targets.back().until);
  note_target(mission, from);
  const Coefficients& target =
      change != nullptr ? change->target->target : mission.target_coefficients;
  observer_.begin_target(mission, target);
  const Mission& judged = in_cosines_ ? *in_cosines_ : mission;
  const Coefficients& cosines =
      change != nullptr ? change->target->in_cosines() : judged.target_coefficients;
  if (in_cosines_) cosines_.begin_target(judged, cosines);
  measures_.begin_target(judged, cosines, context.row.counted());
  confirmations_.begin_target(cosines);
  TargetFacts& facts = facts_.targets.emplace_back();
  if (change != nullptr) facts.amendment = change->amendment;
  facts.from = facts.until = from;
}

/// Notes what was made of the present target, whose time lasts to `until` at least.
void RecordTables::note_target(const Mission& mission, Tick until) {
  TargetFacts& facts = facts_.targets.back();
  facts.until = until;
  if (!observer_.has_seen_any_of_target()) return;
  facts.ergodic_metric = observer_.metric_of_target(mission);
  if (in_cosines_) facts.cosine_metric = cosines_.metric_of_target(*in_cosines_);
}

void RecordTables::end_row(const Context& context) {
  if (!facts_.targets.empty()) note_target(context.mission(), context.row.tick + 1);
  if (context.row.counts) measures_.pass(context.row.counted());
  if (keeps_distance(context.mission()))
    facts_.nearest_m = std::min(facts_.nearest_m, least_distance_m(row_places_m_));
  row_places_m_.clear();
  write_due_metrics(context);
}

void RecordTables::write_due_metrics(const Context& context) {
  const Mission& mission = context.mission();
  const auto period = std::max<Tick>(1, std::llround(kMetricsPeriod_s / mission.timing.dt_s));
  if (!observer_.has_seen_any() || !context.row.counts) return;
  if (context.row.counted() % period != 0 && !context.row.is_last(context.ends.tick_count()))
    return;
  // No table has this metric, so a resumed record computes it from the rows.
  if (in_cosines_) facts_.cosine_metric_last = cosines_.metric(*in_cosines_);
  if (context.row.tick <= former_metrics_.tick) return;
  const double metric = observer_.metric(mission);
  write_metrics(context, metric);
  note_metric(context, metric);
}

void RecordTables::write_metrics(const Context& context, double metric) {
  const Tick tick = context.row.tick;
  const double t_s = static_cast<double>(tick) * context.mission().timing.dt_s;
  ReportedFigures team = figures_of(context.known.reports, context.known.follower, tick);
  // A former process's counts are better until all agents have sent a status.
  team.received = std::max(team.received, static_cast<std::int64_t>(former_metrics_.received));
  team.lost = std::max(team.lost, static_cast<std::int64_t>(former_metrics_.lost));
  std::string line = std::to_string(tick);
  for (const double value :
       {t_s, metric, measures_.detection().probability(), team.high - team.low, team.staleness_s}) {
    line += ',';
    append_number(line, value);
  }
  line += ',' + std::to_string(team.received) + ',' + std::to_string(team.lost) + ',';
  append_number(line, context.known.reports.blocks(context.known.follower).share);
  metrics_ << line << '\n';
}

void RecordTables::note_metric(const Context& context, double metric) {
  if (facts_.t_s.empty()) facts_.ergodic_metric_first = metric;
  facts_.ergodic_metric_last = metric;
  if (!std::isfinite(metric) && !facts_.no_metric_from) facts_.no_metric_from = context.row.tick;
  facts_.t_s.push_back(static_cast<double>(context.row.counted()) * context.mission().timing.dt_s);
  facts_.ergodic_metric.push_back(metric);
}

}  // namespace ergocast
