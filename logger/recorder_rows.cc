// SPDX-License-Identifier: BSD-3-Clause
// Writes what a tick adds to the two tables and to the facts.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/mission/station.h"
#include "core/motion/starts.h"
#include "logger/recorder.h"

namespace ergocast {
namespace {

constexpr double kMetricsPeriod_s = 1.0;

/// 17 significant digits: reading them back gives the same double.
void append_number(std::string& line, double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17);
  line.append(text, end.ptr);
}

}  // namespace

void Recorder::write_trajectory(const State& now, const State& next) {
  const double t_s = static_cast<double>(next_row_) * mission().timing.dt_s;
  const int axes = mission().domain.planar() ? 2 : 3;
  std::string line;
  for (const auto& [id, vehicle] : now.vehicles) {
    const auto after = next.vehicles.find(id);
    if (after == next.vehicles.end() || std::pair(next_row_, id) <= former_.end) continue;
    observe(id, vehicle.position_m);
    if (ends_after_row()) note_home(id, after->second.position_m);
    line += std::to_string(next_row_) + ',';
    append_number(line, t_s);
    line += ',' + std::to_string(id);
    for (const Eigen::Vector3d& vector : {vehicle.position_m, after->second.velocity_mps}) {
      for (int axis = 0; axis < axes; ++axis) {
        line += ',';
        append_number(line, vector[axis]);
      }
    }
    line += '\n';
  }
  trajectory_ << line;
}

/// The member that drives this vehicle at the next row; null if none does.
const RosterEntry* Recorder::member(AgentId id) const {
  const auto& roster = follower().roster();
  const auto at = std::find_if(roster.begin(), roster.end(), [&](const RosterEntry& entry) {
    return entry.author.agent == id && entry.active_at(next_row_);
  });
  return at == roster.end() ? nullptr : &*at;
}

/// Notes how far an agent that must be at home is from its station.
void Recorder::note_home(AgentId id, const Eigen::Vector3d& x_m) {
  const auto home_m = station_of(mission(), id);
  if (!home_m) return;
  double& farthest_m = facts_.from_home_m[id];
  farthest_m = std::max(farthest_m, (x_m - *home_m).norm());
}

void Recorder::observe(AgentId id, const Eigen::Vector3d& x_m) {
  const RosterEntry* entry = member(id);
  if (rests(mission(), id, counted())) {
    note_home(id, x_m);
  } else if (entry != nullptr && row_counts_) {
    observer_.see(mission(), entry->kind, x_m);
    if (in_cosines_) cosines_.see(*in_cosines_, entry->kind, x_m);
  }
  if (mission().separation.distance_m > 0) row_places_m_.push_back(x_m);
}

void Recorder::end_row() {
  facts_.nearest_m = std::min(facts_.nearest_m, least_distance_m(row_places_m_));
  row_places_m_.clear();
  write_due_metrics();
}

void Recorder::write_due_metrics() {
  const Mission& mission = me_.mission();
  const auto period = std::max<Tick>(1, std::llround(kMetricsPeriod_s / mission.timing.dt_s));
  if (!observer_.has_seen_any() || !row_counts_) return;
  if (counted() % period != 0 && !ends_after_row()) return;
  // No table has this metric, so a resumed record computes it from the rows.
  if (in_cosines_) facts_.cosine_metric_last = cosines_.metric(*in_cosines_);
  if (next_row_ <= former_.metrics.tick) return;
  write_metrics(observer_.metric(mission));
}

Blocks Recorder::blocks() const {
  std::int64_t blocked = 0, answered = 0;
  Blocks blocks;
  for (const auto& [author, status] : statuses_) {
    const RosterEntry* entry = follower().entry_of(author.incarnation);
    const Tick from = entry == nullptr ? 0 : entry->active_from;
    answered += std::max<std::int64_t>(0, status.answered_tick + 1 - from);
    blocked += status.blocked_ticks;
    blocks.longest_ticks = std::max(blocks.longest_ticks, status.longest_block_ticks);
  }
  if (answered > 0) blocks.share = static_cast<double>(blocked) / static_cast<double>(answered);
  return blocks;
}

void Recorder::write_metrics(double metric) {
  const double t_s = static_cast<double>(next_row_) * mission().timing.dt_s;
  double low = 0, high = 0, staleness_s = 0;
  std::int64_t received = 0, lost = 0;
  bool first = true;
  for (const auto& [author, status] : statuses_) {
    received += status.contributions_received;
    lost += status.contributions_lost;
    const RosterEntry* entry = follower().entry_of(author.incarnation);
    if (entry == nullptr || !entry->active_at(next_row_)) continue;
    staleness_s = std::max(staleness_s, status.max_staleness_s);
    if (status.answered_tick < 0) continue;  // it has no coverage yet
    low = first ? status.ergodic_metric : std::min(low, status.ergodic_metric);
    high = first ? status.ergodic_metric : std::max(high, status.ergodic_metric);
    first = false;
  }
  // A former process's counts are better until all agents have sent a status.
  received = std::max(received, static_cast<std::int64_t>(former_.metrics.received));
  lost = std::max(lost, static_cast<std::int64_t>(former_.metrics.lost));
  std::string line = std::to_string(next_row_);
  for (const double value : {t_s, metric, high - low, staleness_s}) {
    line += ',';
    append_number(line, value);
  }
  line += ',' + std::to_string(received) + ',' + std::to_string(lost) + ',';
  append_number(line, blocks().share);
  metrics_ << line << '\n';
  if (facts_.t_s.empty()) facts_.ergodic_metric_first = metric;
  facts_.ergodic_metric_last = metric;
  if (!std::isfinite(metric) && !facts_.no_metric_from) facts_.no_metric_from = next_row_;
  facts_.t_s.push_back(static_cast<double>(counted()) * mission().timing.dt_s);
  facts_.ergodic_metric.push_back(metric);
}

}  // namespace ergocast
