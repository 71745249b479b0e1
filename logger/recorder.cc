// SPDX-License-Identifier: BSD-3-Clause
// Holds states until a tick and its successor are complete, then writes the row and acknowledges
// the tick.
#include "logger/recorder.h"

#include <algorithm>
#include <chrono>

#include "core/require.h"
#include "core/separation.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kAckPeriod = 100ms;
/// The period while a sent state is missing: an early acknowledgement lets the world repeat it
/// early.
constexpr auto kImpatientAckPeriod = 20ms;
constexpr Tick kAckEveryTicks = 16;
/// In real time no state is repeated: a missing one is given up after so many newer ones.
constexpr std::size_t kGiveUpAfterStates = 16;
/// A missing part of a state, from one driver of many, is given up after so many newer states.
constexpr std::size_t kDriverPatience = kGiveUpAfterStates / 2;
/// Lockstep: a state that is more than so many ticks ahead is forged, or no row can be written. In
/// real time the record may be behind by any number of ticks.
/// Limit (Record): states that wait to become rows. Beyond it: newer ones are dropped, which leaves
/// a gap.
constexpr Tick kLeadTicks = 1024;
/// The maximum number of states that wait to become rows.
constexpr std::size_t kMaxStates = static_cast<std::size_t>(kLeadTicks);
/// Lockstep: how long to wait for the repetition of a state that may be lost for good.
constexpr auto kRepeatPatience = 500ms;
/// How long after the end, or the last row, a missing state or an agent's last status may arrive.
constexpr auto kLinger = 1s;

}  // namespace

bool Recorder::State::complete() const {
  return !parts.empty() && std::all_of(parts.begin(), parts.end(), [](bool part) { return part; });
}

Recorder::Recorder(RunId run, Incarnation incarnation, std::ostream& trajectory,
                   std::ostream& metrics)
    : me_(kRole, {run, kLogger, incarnation}), trajectory_(trajectory), metrics_(metrics) {
  ERGOCAST_REQUIRE(writing());
  metrics_ << kMetricsHeader << '\n';
}

void Recorder::resume(RunData past, std::vector<std::byte> plan) {
  me_.expect_plan(std::move(plan));
  former_.resumed = true;
  for (const auto& [agent, track] : past.tracks) next_row_ = std::max(next_row_, track.back().tick);
  former_.rows = std::move(past);
}

void Recorder::go_on(Instant now) {
  me_.set_incarnation(me_.incarnation() + 1);
  received_.lost_before = std::max(received_.lost_before, received_.newest);
  progress_ = now;
  acked_.next = now;
}

void Recorder::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (ending_.finished) return;
  // On this bus an agent repeats a former world's state for a restarted world.
  if (bus == Bus::kCommand && std::holds_alternative<WorldState>(message)) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

void Recorder::on(const AgentStatus& status, const Arrival& arrival) {
  if (!arrival.fresh) return;
  AgentStatus& latest = statuses_[{arrival.from.sender, arrival.from.incarnation}];
  const double worst_lag_s = std::max(latest.loop_lag_s, status.loop_lag_s);
  latest = status;
  latest.loop_lag_s = worst_lag_s;
}

void Recorder::on(const MissionPart&, const Arrival& arrival) {
  if (!arrival.mission_changed) return;
  if (follower().plan_problem()) return fail(*follower().plan_problem());
  if (me_.knows_mission() && !observer_.begun()) begin();
  if (!follower().over() || ending_.since) return;
  ending_.since = arrival.now;
  ending_.failed = follower().state() == MissionState::kFailed;
  ending_.reason = follower().reason();
}

void Recorder::on(const Stop& stop, const Arrival& arrival) {
  if (!stop.now || me_.run() == 0 || ending_.since) return;
  ending_.since = arrival.now;
  facts_.halted = true;
  ending_.failed = stop.failed;
  ending_.reason = stop.reason;
}

void Recorder::begin() {
  observer_.begin(mission());
  if (mission().basis.free_domain) {
    in_cosines_ = in_cosines(mission());
    cosines_.begin(*in_cosines_);
  }
  trajectory_ << (mission().domain.planar() ? kTrajectoryHeader : kTrajectoryHeaderInSpace) << '\n';
  if (former_.rows) replay(*former_.rows);
  former_.rows.reset();
  states_.erase(states_.begin(), states_.lower_bound(next_row_));
}

void Recorder::replay(const RunData& past) {
  for (const MetricsRow& row : past.metrics) {
    facts_.t_s.push_back(static_cast<double>(me_.counted(row.tick)) * mission().timing.dt_s);
    facts_.ergodic_metric.push_back(row.ergodic_metric);
  }
  if (!past.metrics.empty()) {
    former_.metrics = past.metrics.back();
    facts_.ergodic_metric_first = facts_.ergodic_metric.front();
    facts_.ergodic_metric_last = facts_.ergodic_metric.back();
  }
  std::size_t vehicles = 0, expected = mission().starts_m.size();
  for_each_row(past, [&](AgentId id, const TrackPoint& row) {
    if (row.tick > former_.end.first) {
      if (vehicles > 0) end_row();
      expected = std::max(expected, vehicles);
      next_row_ = row.tick;
      uncounted_ = row.tick - me_.counted(row.tick);
      row_counts_ = !me_.is_held(row.tick);
      vehicles = 0;
      ++facts_.ticks;
      facts_.held_ticks += row_counts_ ? 0 : 1;
    }
    observe(id, row.x_m);
    ++vehicles;
    former_.end = {row.tick, id};
  });
  facts_.former_ticks = facts_.ticks;
  facts_.gaps = former_.end.first + 1 - facts_.ticks;
  // With fewer rows, the last tick may be incomplete, and is recorded to its end.
  if (vehicles == 0 || vehicles < expected) return;
  end_row();
  pass_row();
}

void Recorder::pass_row() {
  ++next_row_;
  uncounted_ += row_counts_ ? 0 : 1;
}

bool Recorder::is_lockstep() const {
  return !me_.knows_mission() || mission().timing.pace == Pace::kLockstep;
}

void Recorder::on(const WorldState& world, const Arrival& arrival) {
  const Tick tick = world.header.tick;
  if (me_.knows_mission()) {
    if (tick - world.uncounted_ticks > mission().timing.tick_count) return;
    received_.newest = std::max(received_.newest, tick);
    if (arrival.fresh) meet(world.header, arrival.now);
    if (arrival.fresh) received_.world_left = world.last;
  }
  const Tick horizon = std::max(next_row_, received_.lost_before) + kLeadTicks;
  if (tick < next_row_ || (is_lockstep() && tick > horizon)) return;
  facts_.missed_deadlines = std::max(facts_.missed_deadlines, world.missed_deadlines);
  facts_.skipped_ticks = std::max(facts_.skipped_ticks, world.skipped_ticks);
  facts_.clamped_commands = std::max(facts_.clamped_commands, world.clamped_commands);
  if (states_.size() >= kMaxStates && !states_.contains(tick)) return;
  State& state = states_[tick];
  // A repeat adds nothing, and in a restarted world's repeat the velocities may be missing.
  if (state.complete()) return;
  const auto parts = static_cast<std::size_t>(world.parts);
  const bool other = state.world != world.header.incarnation || state.parts.size() != parts;
  if (state.parts.empty() || (other && !has_drivers())) {
    state = {world.header.incarnation, std::vector<bool>(parts), {}, world.uncounted_ticks};
  }
  if (state.parts.size() < parts) state.parts.resize(parts);
  state.parts[static_cast<std::size_t>(world.part)] = true;
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    state.vehicles[vehicle.id] = vehicle;
  }
}

void Recorder::meet(const Header& world, Instant now) {
  if (world.incarnation == received_.world) return;
  const bool from_the_start = received_.world == 0 && !former_.resumed;
  received_.world = world.incarnation;
  if (from_the_start) return;
  received_.lost_before = std::max(received_.lost_before, world.tick);
  progress_ = now;
}

void Recorder::advance(Instant now, Outbox& out) {
  if (ending_.finished) return;
  if (me_.knows_mission()) {
    if (given_up(now)) go_on(now);
    write_rows(now);
    if (all_rows_written() && !ending_.since) {
      ending_.since = now;
      ending_.reason = "mission complete";
    }
  }
  const bool patience_ends = ending_.since && now - std::max(*ending_.since, progress_) >= kLinger;
  if (patience_ends || everybody_left(now)) close();
  if (abandoned(now)) {
    stop("nothing arrives from the world or the coordinator, and the mission must be over by now");
  }
  if (me_.knows_mission()) acknowledge(now, out);
  if (ending_.finished && follower().over()) {
    me_.publish(Bus::kWorld, RecordAck{{}, true}, next_row_ - 1, out);  // to the coordinator
  }
}

/// Whether no missing data can arrive any more, because all processes have left.
bool Recorder::everybody_left(Instant now) const {
  if (!ending_.since || !follower().over() || !received_.world_left) return false;
  if (next_row_ < received_.newest) return false;
  return me_.team_has_left(
      follower().roster(),
      [&](const Author& author) {
        const auto status = statuses_.find(author);
        return status != statuses_.end() && status->second.phase == AgentPhase::kFinished;
      },
      now);
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
  const bool last = ending_.finished || all_rows_written();
  const bool progress =
      recorded > acked_.tick + kAckEveryTicks - 1 || (last && recorded > acked_.tick);
  if (!progress && now < acked_.next) return;
  trajectory_.flush();
  metrics_.flush();
  const bool hole = !states_.empty() && states_.rbegin()->first > next_row_ + 1;
  acked_.next = now + (hole ? kImpatientAckPeriod : kAckPeriod);
  if (!writing()) return;
  acked_.tick = recorded;
  me_.publish(Bus::kCommand, RecordAck{}, recorded, out);
}

bool Recorder::abandoned(Instant now) const {
  if (ending_.finished || ending_.since) return false;
  return me_.cut_off(states_.empty() ? next_row_ : states_.rbegin()->first, now);
}

Instant Recorder::next_wakeup() const {
  return ending_.finished || !me_.knows_mission() ? Instant::max() : acked_.next;
}

void Recorder::stop(std::string reason) {
  if (!ending_.since) ending_.reason = std::move(reason);
  close();
}

void Recorder::fail(std::string reason) {
  ending_.failed = true;
  stop(std::move(reason));
}

void Recorder::close() {
  if (ending_.finished) return;
  ending_.finished = true;
  if (!observer_.begun()) trajectory_ << kTrajectoryHeader << '\n';
  while (has_drivers() && write_next_row()) {
  }
  // The last chance to write the rows after a gap.
  received_.lost_before = std::max(received_.lost_before, received_.newest);
  while (writing() && gap_ahead() && next_pair() != states_.end()) {
    skip_gap();
    while (write_next_row()) {
    }
  }
}

const char* Recorder::result() const {
  if (ending_.failed || facts_.no_metric_from) return "failed";
  return all_rows_written() ? "done" : "stopped";
}

bool Recorder::holds(Tick tick) const {
  const auto state = states_.find(tick);
  if (state == states_.end()) return false;
  const bool overdue =
      ending_.finished || states_.rbegin()->first >= tick + static_cast<Tick>(kDriverPatience);
  return state->second.complete() || (has_drivers() && overdue);
}

/// Whether several drivers may send a tick, each its own robot's part. Then a row is also written
/// without a robot whose driver is silent.
bool Recorder::has_drivers() const { return me_.knows_mission() && uses_beacons(mission()); }

bool Recorder::write_next_row() {
  if (!writing() || all_rows_written()) return false;
  if (!holds(next_row_) || !holds(next_row_ + 1)) return false;
  const State &now = states_.at(next_row_), &next = states_.at(next_row_ + 1);
  uncounted_ = now.uncounted;
  row_counts_ = next.uncounted <= now.uncounted;
  // A pause that only the world received is lost if its coordinator stops: its ticks then count.
  facts_.held_ticks = std::min(facts_.held_ticks, now.uncounted);
  write_trajectory(now, next);
  end_row();
  states_.erase(next_row_);
  if (next_row_ > former_.end.first) {
    ++facts_.ticks;
    facts_.held_ticks += row_counts_ ? 0 : 1;
  }
  pass_row();
  return true;
}

/// Whether a state that may be lost for good is missing and newer ones have arrived.
bool Recorder::gap_ahead() const {
  if (!me_.knows_mission() || all_rows_written() || states_.empty()) return false;
  const Tick missing = holds(next_row_) ? next_row_ + 1 : next_row_;
  return states_.rbegin()->first > missing && (!is_lockstep() || missing < received_.lost_before);
}

bool Recorder::gap_is_final(Instant now) const {
  return is_lockstep() ? now - progress_ >= kRepeatPatience : states_.size() >= kGiveUpAfterStates;
}

/// Lockstep: whether the world continues without this recorder. It does so when it received no
/// acknowledgement for half of the time-out. The recorder was then disconnected, and no process
/// repeats the states of that time.
bool Recorder::given_up(Instant now) const {
  const Tick expected = std::max(next_row_, received_.lost_before) + kRecordWindowTicks;
  return is_lockstep() && writing() && received_.newest > expected &&
         now - progress_ > seconds(mission().timing.lockstep_timeout_s / 2);
}

/// The first two successive states, from which the record can continue after a gap.
std::map<Tick, Recorder::State>::const_iterator Recorder::next_pair() const {
  return std::adjacent_find(states_.begin(), states_.end(), [](const auto& a, const auto& b) {
    return b.first == a.first + 1 && a.second.complete() && b.second.complete();
  });
}

void Recorder::skip_gap() {
  const auto pair = next_pair();
  Tick resume = pair == states_.end() ? std::prev(states_.end())->first : pair->first;
  if (is_lockstep()) resume = std::min(resume, received_.lost_before);
  facts_.gaps += resume - std::max(next_row_, former_.end.first + 1);
  next_row_ = resume;
  uncounted_ =
      states_.contains(resume) ? states_.at(resume).uncounted : resume - me_.counted(resume);
  states_.erase(states_.begin(), states_.lower_bound(resume));
}

}  // namespace ergocast
