#include "logger/recorder.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

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
/// Lockstep: states beyond this many ticks ahead cannot be honest. In real time the record may be
/// behind by any number.
constexpr Tick kLeadTicks = 1024;
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

Recorder::Recorder(RunId run, Incarnation incarnation, PlanDecoder decode_plan,
                   std::ostream& trajectory, std::ostream& metrics)
    : run_(run),
      incarnation_(incarnation),
      follower_(std::move(decode_plan)),
      trajectory_(trajectory),
      metrics_(metrics) {
  trajectory_ << kTrajectoryHeader << '\n';
  metrics_ << kMetricsHeader << '\n';
}

void Recorder::receive(const Message& message, Instant now) {
  const Header& from = header_of(message);
  if (finished_ || (run_ != 0 && from.run != run_)) return;
  if (const auto* world = std::get_if<WorldState>(&message)) return on(*world);
  if (const auto* status = std::get_if<AgentStatus>(&message)) {
    if (statuses_.size() > static_cast<std::size_t>(kMaxAgents) * kMaxIncarnationsPerAgent) return;
    AgentStatus& latest = statuses_[{from.sender, from.incarnation}];
    if (from.sequence > latest.header.sequence) latest = *status;
    return;
  }
  if (const auto* part = std::get_if<MissionPart>(&message)) {
    if (run_ == 0) run_ = from.run;
    const bool had_mission = follower_.mission().has_value();
    if (!follower_.receive(*part)) return;
    if (!had_mission && follower_.mission()) {
      const Mission& mission = *follower_.mission();
      weights_ = sobolev_weights(mission.basis, mission.domain);
      sums_s_ = Coefficients::Zero(mission.basis.modes_x, mission.basis.modes_y);
    }
    if (follower_.over() && !over_since_) {
      over_since_ = now;
      failed_ = follower_.state() == MissionState::kFailed;
      reason_ = follower_.reason();
    }
    return;
  }
  if (const auto* stop = std::get_if<Stop>(&message); stop && !over_since_) {
    over_since_ = now;
    failed_ = stop->failed;
    reason_ = stop->reason;
  }
}

void Recorder::on(const WorldState& world) {
  const Tick tick = world.header.tick;
  const auto& mission = follower_.mission();
  const bool lockstep = !mission || mission->timing.pace == Pace::kLockstep;
  if (tick < next_row_ || (lockstep && tick > next_row_ + kLeadTicks)) return;
  facts_.missed_deadlines = std::max(facts_.missed_deadlines, world.missed_deadlines);
  facts_.skipped_ticks = std::max(facts_.skipped_ticks, world.skipped_ticks);
  State& state = states_[tick];
  if (state.parts.size() != static_cast<std::size_t>(world.parts)) {
    state.parts.assign(static_cast<std::size_t>(world.parts), false);
  }
  state.parts[static_cast<std::size_t>(world.part)] = true;
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    state.vehicles[vehicle.id] = vehicle;
  }
}

void Recorder::advance(Instant now, Outbox& out) {
  if (finished_) return;
  const std::optional<Mission>& mission = follower_.mission();
  if (mission) {
    while (write_next_row()) last_row_ = now;
    const bool given_up = states_.size() >= kGiveUpAfterStates;
    if (mission->timing.pace == Pace::kRealtime && given_up) skip_gap();
    if (next_row_ >= mission->timing.tick_count && !over_since_) {
      over_since_ = now;
      reason_ = "mission complete";
    }
  }
  if (over_since_ && now - std::max(*over_since_, last_row_) >= kFarewell) close();
  const Tick recorded = next_row_ - 1;
  const bool progress = recorded > acked_ + kAckEveryTicks - 1 || (finished_ && recorded > acked_);
  if (mission && (progress || now >= next_ack_)) {
    acked_ = recorded;
    const bool hole = !states_.empty() && states_.rbegin()->first > next_row_ + 1;
    next_ack_ = now + (hole ? kImpatientAckPeriod : kAckPeriod);
    out.push_back({Bus::kCommand, RecordAck{{run_, kLogger, incarnation_,
                                            sequencer_.next(Bus::kCommand), recorded}}});
  }
}

Instant Recorder::next_wakeup() const {
  return finished_ || !follower_.mission() ? Instant::max() : next_ack_;
}

void Recorder::stop(std::string reason) {
  if (!over_since_) reason_ = std::move(reason);
  close();
}

void Recorder::close() {
  if (finished_) return;
  finished_ = true;
  const std::optional<Mission>& mission = follower_.mission();
  if (!mission || mission->timing.pace != Pace::kRealtime) return;
  // What stands behind a gap is written now or never.
  while (next_row_ < mission->timing.tick_count && !states_.empty() &&
         states_.rbegin()->first > next_row_) {
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

bool Recorder::write_next_row() {
  if (next_row_ >= follower_.mission()->timing.tick_count) return false;
  const auto now = states_.find(next_row_);
  const auto next = states_.find(next_row_ + 1);
  if (now == states_.end() || next == states_.end() || !now->second.complete() ||
      !next->second.complete()) {
    return false;
  }
  write_trajectory(now->second, next->second);
  observe(now->second);
  states_.erase(now);
  ++next_row_;
  ++facts_.ticks;
  return true;
}

void Recorder::skip_gap() {
  // The first pair of successive states is where the record can go on.
  const auto pair = std::adjacent_find(states_.begin(), states_.end(), [](const auto& a, const auto& b) {
    return b.first == a.first + 1 && a.second.complete() && b.second.complete();
  });
  const Tick resume = pair == states_.end() ? std::prev(states_.end())->first : pair->first;
  facts_.gaps += resume - next_row_;
  next_row_ = resume;
  states_.erase(states_.begin(), states_.lower_bound(resume));
}

void Recorder::write_trajectory(const State& now, const State& next) {
  const double t_s = static_cast<double>(next_row_) * follower_.mission()->timing.dt_s;
  std::string line;
  for (const auto& [id, vehicle] : now.vehicles) {
    const auto after = next.vehicles.find(id);
    if (after == next.vehicles.end()) continue;
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

void Recorder::observe(const State& now) {
  const Mission& mission = *follower_.mission();
  for (const auto& [id, vehicle] : now.vehicles) {
    const Eigen::Vector2d x_m = vehicle.position_m.head<2>();
    if (!is_member(id) || !mission.domain.contains(x_m)) continue;
    accumulate_basis(BasisAt(x_m, mission.domain, mission.basis), mission.basis,
                     mission.timing.dt_s, sums_s_.data());
    covered_s_ += mission.timing.dt_s;
  }
  const auto period = std::max<Tick>(1, std::llround(kMetricsPeriod_s / mission.timing.dt_s));
  const bool last = next_row_ + 1 == mission.timing.tick_count;
  if (covered_s_ == 0 || (next_row_ % period != 0 && !last)) return;
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
