#include "logger/recorder.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "core/require.h"
#include "team/silence.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kAckPeriod = 100ms;
/// When a state is missing that has been sent: the sooner the world knows, the sooner it repeats it.
constexpr auto kImpatientAckPeriod = 20ms;
constexpr Tick kAckEveryTicks = 16;
constexpr double kMetricsPeriod_s = 1.0;
/// Real time does not repeat a state: after so many newer ones, a missing one is given up.
constexpr std::size_t kGiveUpAfterStates = 16;
/// Lockstep: states beyond this many ticks ahead cannot be honest, or nothing can be written. In
/// real time the record may be behind by any number.
constexpr Tick kLeadTicks = 1024;
/// States that wait to become rows.
constexpr std::size_t kMaxStates = static_cast<std::size_t>(kLeadTicks);
/// Lockstep: how long a state may take to be repeated that may be gone for good.
constexpr auto kRepeatPatience = 500ms;
/// How long after the end, or the last row, a missing state or an agent's last status may still come.
constexpr auto kFarewell = 1s;

/// 17 significant digits: the double comes back bit for bit.
void append_number(std::string& line, double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17);
  line.append(text, end.ptr);
}

}  // namespace

bool Recorder::State::complete() const {
  return !parts.empty() && std::all_of(parts.begin(), parts.end(), [](bool part) { return part; });
}

Recorder::Recorder(RunId run, Incarnation incarnation, std::ostream& trajectory,
                   std::ostream& metrics)
    : run_(run),
      incarnation_(incarnation),
      trajectory_(trajectory),
      metrics_(metrics) {
  ERGOCAST_REQUIRE(writing());
  trajectory_ << kTrajectoryHeader << '\n';
  metrics_ << kMetricsHeader << '\n';
}

void Recorder::resume(RunData past, std::vector<std::byte> plan) {
  follower_.expect_plan(std::move(plan));
  resumed_ = true;
  for (const auto& [agent, track] : past.tracks) next_row_ = std::max(next_row_, track.back().tick);
  past_ = std::move(past);
}

void Recorder::go_on(Instant now) {
  ++incarnation_;
  lost_before_ = std::max(lost_before_, newest_);
  progress_ = now;
  next_ack_ = now;
}

void Recorder::receive(const Message& message, Instant now) {
  const Header& from = header_of(message);
  if (finished_ || (run_ != 0 && from.run != run_)) return;
  if (const auto* world = std::get_if<WorldState>(&message)) return on(*world, now);
  if (const auto* status = std::get_if<AgentStatus>(&message)) {
    const Author author{from.sender, from.incarnation};
    if (statuses_.size() >= kMaxStatuses && !statuses_.contains(author)) return;
    AgentStatus& latest = statuses_[author];
    if (from.sequence <= latest.header.sequence) return;
    const double worst_lag_s = std::max(latest.loop_lag_s, status->loop_lag_s);
    latest = *status;
    latest.loop_lag_s = worst_lag_s;
    return;
  }
  if (const auto* part = std::get_if<MissionPart>(&message)) {
    if (run_ == 0) run_ = from.run;
    if (freshness_.is_news(from)) heard_ = now;
    const bool had_mission = follower_.mission().has_value();
    if (!follower_.receive(*part)) return;
    if (follower_.plan_problem()) return fail(*follower_.plan_problem());
    if (!had_mission && follower_.mission()) begin();
    if (follower_.over() && !over_since_) {
      over_since_ = now;
      failed_ = follower_.state() == MissionState::kFailed;
      reason_ = follower_.reason();
    }
    return;
  }
  if (const auto* stop = std::get_if<Stop>(&message); stop && stop->now && run_ != 0 && !over_since_) {
    over_since_ = now;
    facts_.halted = true;
    failed_ = stop->failed;
    reason_ = stop->reason;
  }
}

void Recorder::begin() {
  const Mission& mission = *follower_.mission();
  weights_ = sobolev_weights(mission.basis, mission.domain);
  sums_s_ = Coefficients::Zero(mission.basis.modes_x, mission.basis.modes_y);
  if (past_) replay(*past_);
  past_.reset();
  states_.erase(states_.begin(), states_.lower_bound(next_row_));
}

void Recorder::replay(const RunData& past) {
  for (const MetricsRow& row : past.metrics) {
    facts_.t_s.push_back(row.t_s);
    facts_.ergodic_metric.push_back(row.ergodic_metric);
  }
  if (!past.metrics.empty()) {
    former_metrics_ = past.metrics.back();
    facts_.ergodic_metric_first = facts_.ergodic_metric.front();
    facts_.ergodic_metric_last = facts_.ergodic_metric.back();
  }
  std::size_t vehicles = 0, expected = follower_.mission()->starts_m.size();
  for_each_row(past, [&](AgentId id, const TrackPoint& row) {
    if (row.tick > former_end_.first) {
      if (vehicles > 0) write_due_metrics();
      expected = std::max(expected, vehicles);
      next_row_ = row.tick;
      vehicles = 0;
      ++facts_.ticks;
    }
    observe(id, row.x_m);
    ++vehicles;
    former_end_ = {row.tick, id};
  });
  facts_.former_ticks = facts_.ticks;
  facts_.gaps = former_end_.first + 1 - facts_.ticks;
  // With fewer, the last tick may have been cut off amid its rows, and is recorded to its end.
  if (vehicles == 0 || vehicles < expected) return;
  write_due_metrics();
  ++next_row_;
}

bool Recorder::is_lockstep() const {
  return !follower_.mission() || follower_.mission()->timing.pace == Pace::kLockstep;
}

void Recorder::on(const WorldState& world, Instant now) {
  const Tick tick = world.header.tick;
  const bool is_news = freshness_.is_news(world.header);
  if (is_news) heard_ = now;
  if (follower_.mission()) {
    if (tick > follower_.mission()->timing.tick_count) return;
    newest_ = std::max(newest_, tick);
    if (is_news) meet(world.header, now);
  }
  const Tick horizon = std::max(next_row_, lost_before_) + kLeadTicks;
  if (tick < next_row_ || (is_lockstep() && tick > horizon)) return;
  facts_.missed_deadlines = std::max(facts_.missed_deadlines, world.missed_deadlines);
  facts_.skipped_ticks = std::max(facts_.skipped_ticks, world.skipped_ticks);
  facts_.clamped_commands = std::max(facts_.clamped_commands, world.clamped_commands);
  if (states_.size() >= kMaxStates && !states_.contains(tick)) return;
  State& state = states_[tick];
  // A repeat says nothing new; a restarted world may even have forgotten the velocities.
  if (state.complete()) return;
  const auto parts = static_cast<std::size_t>(world.parts);
  if (state.world != world.header.incarnation || state.parts.size() != parts) {
    state = {world.header.incarnation, std::vector<bool>(parts), {}};
  }
  state.parts[static_cast<std::size_t>(world.part)] = true;
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    state.vehicles[vehicle.id] = vehicle;
  }
}

void Recorder::meet(const Header& world, Instant now) {
  if (world.incarnation == world_) return;
  const bool from_the_start = world_ == 0 && !resumed_;
  world_ = world.incarnation;
  if (from_the_start) return;
  lost_before_ = std::max(lost_before_, world.tick);
  progress_ = now;
}

void Recorder::advance(Instant now, Outbox& out) {
  if (finished_) return;
  if (follower_.mission()) {
    if (given_up(now)) go_on(now);
    write_rows(now);
    if (next_row_ >= follower_.mission()->timing.tick_count && !over_since_) {
      over_since_ = now;
      reason_ = "mission complete";
    }
  }
  if (over_since_ && now - std::max(*over_since_, progress_) >= kFarewell) close();
  if (abandoned(now)) {
    stop("neither the world nor the coordinator can be heard, and the mission must be over by now");
  }
  if (follower_.mission()) acknowledge(now, out);
}

void Recorder::write_rows(Instant now) {
  while (true) {
    while (write_next_row()) progress_ = now;
    if (!writing() || !gap_ahead() || !gap_is_final(now)) return;
    skip_gap();
  }
}

void Recorder::acknowledge(Instant now, Outbox& out) {
  const Tick recorded = next_row_ - 1;
  const bool progress = recorded > acked_ + kAckEveryTicks - 1 || (finished_ && recorded > acked_);
  if (!progress && now < next_ack_) return;
  trajectory_.flush();
  metrics_.flush();
  const bool hole = !states_.empty() && states_.rbegin()->first > next_row_ + 1;
  next_ack_ = now + (hole ? kImpatientAckPeriod : kAckPeriod);
  if (!writing()) return;
  acked_ = recorded;
  out.push_back({Bus::kCommand, RecordAck{{run_, kLogger, incarnation_,
                                          sequencer_.next(Bus::kCommand), recorded}}});
}

bool Recorder::abandoned(Instant now) const {
  if (finished_ || over_since_ || !follower_.mission()) return false;
  if (follower_.state() != MissionState::kRunning) return false;
  const Tick newest = states_.empty() ? next_row_ : states_.rbegin()->first;
  return must_be_over(follower_.mission()->timing, newest, now - heard_);
}

Instant Recorder::next_wakeup() const {
  return finished_ || !follower_.mission() ? Instant::max() : next_ack_;
}

void Recorder::stop(std::string reason) {
  if (!over_since_) reason_ = std::move(reason);
  close();
}

void Recorder::fail(std::string reason) {
  failed_ = true;
  stop(std::move(reason));
}

void Recorder::close() {
  if (finished_) return;
  finished_ = true;
  // What stands behind a gap is written now or never.
  lost_before_ = std::max(lost_before_, newest_);
  while (writing() && gap_ahead() && next_pair() != states_.end()) {
    skip_gap();
    while (write_next_row()) {
    }
  }
}

const char* Recorder::result() const {
  if (failed_) return "failed";
  const bool complete = follower_.mission() && next_row_ >= follower_.mission()->timing.tick_count;
  return complete ? "done" : "stopped";
}

bool Recorder::holds(Tick tick) const {
  const auto state = states_.find(tick);
  return state != states_.end() && state->second.complete();
}

bool Recorder::write_next_row() {
  if (!writing() || next_row_ >= follower_.mission()->timing.tick_count) return false;
  if (!holds(next_row_) || !holds(next_row_ + 1)) return false;
  write_trajectory(states_.at(next_row_), states_.at(next_row_ + 1));
  write_due_metrics();
  states_.erase(next_row_);
  if (next_row_ > former_end_.first) ++facts_.ticks;
  ++next_row_;
  return true;
}

/// Whether a state is missing that may never come, and newer ones are there.
bool Recorder::gap_ahead() const {
  const auto& mission = follower_.mission();
  if (!mission || next_row_ >= mission->timing.tick_count || states_.empty()) return false;
  const Tick missing = holds(next_row_) ? next_row_ + 1 : next_row_;
  return states_.rbegin()->first > missing && (!is_lockstep() || missing < lost_before_);
}

bool Recorder::gap_is_final(Instant now) const {
  return is_lockstep() ? now - progress_ >= kRepeatPatience : states_.size() >= kGiveUpAfterStates;
}

/// Whether the world goes on without us, as it does in lockstep when it has not heard of a row for half
/// of the time-out: we were cut off, and what was said meanwhile nobody repeats.
bool Recorder::given_up(Instant now) const {
  const Tick expected = std::max(next_row_, lost_before_) + kRecordWindowTicks;
  return is_lockstep() && writing() && newest_ > expected &&
         now - progress_ > seconds(follower_.mission()->timing.lockstep_timeout_s / 2);
}

/// The first two successive states, with which the record can go on behind a gap.
std::map<Tick, Recorder::State>::const_iterator Recorder::next_pair() const {
  return std::adjacent_find(states_.begin(), states_.end(), [](const auto& a, const auto& b) {
    return b.first == a.first + 1 && a.second.complete() && b.second.complete();
  });
}

void Recorder::skip_gap() {
  const auto pair = next_pair();
  Tick resume = pair == states_.end() ? std::prev(states_.end())->first : pair->first;
  if (is_lockstep()) resume = std::min(resume, lost_before_);
  facts_.gaps += resume - std::max(next_row_, former_end_.first + 1);
  next_row_ = resume;
  states_.erase(states_.begin(), states_.lower_bound(resume));
}

void Recorder::write_trajectory(const State& now, const State& next) {
  const double t_s = static_cast<double>(next_row_) * follower_.mission()->timing.dt_s;
  std::string line;
  for (const auto& [id, vehicle] : now.vehicles) {
    const auto after = next.vehicles.find(id);
    if (after == next.vehicles.end() || std::pair(next_row_, id) <= former_end_) continue;
    observe(id, vehicle.position_m.head<2>());
    line += std::to_string(next_row_) + ',';
    append_number(line, t_s);
    line += ',' + std::to_string(id);
    for (const double value : {vehicle.position_m.x(), vehicle.position_m.y(),
                               after->second.velocity_mps.x(), after->second.velocity_mps.y()}) {
      line += ',';
      append_number(line, value);
    }
    line += '\n';
  }
  trajectory_ << line;
}

bool Recorder::is_member(AgentId id) const {
  const auto& roster = follower_.roster();
  return std::any_of(roster.begin(), roster.end(), [&](const RosterEntry& entry) {
    return entry.author.agent == id && entry.active_at(next_row_);
  });
}

void Recorder::observe(AgentId id, const Eigen::Vector2d& x_m) {
  const Mission& mission = *follower_.mission();
  if (!is_member(id) || !mission.domain.contains(x_m)) return;
  accumulate_basis(BasisAt(x_m, mission.domain, mission.basis), mission.basis,
                   mission.timing.dt_s, sums_s_.data());
  covered_s_ += mission.timing.dt_s;
}

void Recorder::write_due_metrics() {
  const Mission& mission = *follower_.mission();
  const auto period = std::max<Tick>(1, std::llround(kMetricsPeriod_s / mission.timing.dt_s));
  const bool last = next_row_ + 1 == mission.timing.tick_count;
  if (covered_s_ == 0 || (next_row_ % period != 0 && !last)) return;
  if (next_row_ <= former_metrics_.tick) return;
  write_metrics(ergodic_metric(sums_s_ / covered_s_, mission.target_coefficients, weights_));
}

void Recorder::write_metrics(double metric) {
  const double t_s = static_cast<double>(next_row_) * follower_.mission()->timing.dt_s;
  double low = 0, high = 0, staleness_s = 0;
  std::int64_t received = 0, lost = 0;
  bool first = true;
  for (const auto& [author, status] : statuses_) {
    received += status.contributions_received;
    lost += status.contributions_lost;
    const RosterEntry* entry = follower_.entry_of(author.incarnation);
    if (entry == nullptr || !entry->active_at(next_row_)) continue;
    staleness_s = std::max(staleness_s, status.max_staleness_s);
    if (status.answered_tick < 0) continue;  // it knows of no coverage yet
    low = first ? status.ergodic_metric : std::min(low, status.ergodic_metric);
    high = first ? status.ergodic_metric : std::max(high, status.ergodic_metric);
    first = false;
  }
  // Until everybody has spoken again, what a former process had counted is nearer the truth.
  received = std::max(received, static_cast<std::int64_t>(former_metrics_.received));
  lost = std::max(lost, static_cast<std::int64_t>(former_metrics_.lost));
  std::string line = std::to_string(next_row_);
  for (const double value : {t_s, metric, high - low, staleness_s}) {
    line += ',';
    append_number(line, value);
  }
  metrics_ << line << ',' << received << ',' << lost << '\n';
  if (facts_.t_s.empty()) facts_.ergodic_metric_first = metric;
  facts_.ergodic_metric_last = metric;
  facts_.t_s.push_back(t_s);
  facts_.ergodic_metric.push_back(metric);
}

}  // namespace ergocast
