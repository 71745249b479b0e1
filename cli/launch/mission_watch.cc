// SPDX-License-Identifier: BSD-3-Clause
// A message can move the mission to a later stage, never back. The clock shows when a stage is
// overdue.
#include "cli/launch/mission_watch.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// How long a coordinator may take to end the mission in order.
constexpr auto kCoordinatorPatience = 2s;
/// Agents report twice a second. A person may start a coordinator meanwhile.
constexpr auto kDesertedAfter = 10s;

}  // namespace

void MissionWatch::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
  const bool heard = me_.liveness().last_sign_of_kind(kCoordinator).has_value();
  progress_.coordinator_silent = heard && me_.silent(kCoordinator, now);
  if (stage_ >= Stage::kRunning) display_.show(progress_);
}

void MissionWatch::on(const Hello& hello, const Arrival& arrival) {
  const bool asked = arrival.fresh && asks_for_mission(hello) && me_.follower().revision() >= 0;
  if (asked) mission_repeat_.asked(arrival.now, me_.received());
}

void MissionWatch::on(const TeamStatus& team, const Arrival& arrival) {
  if (!arrival.fresh) return;
  const Instant now = arrival.now;
  reach(team.header.tick, now);
  progress_.paused = team.paused || me_.is_held(tick_);
  // A restarted coordinator does not know the metric yet.
  if (team.ergodic_metric > 0) progress_.ergodic_metric = team.ergodic_metric;
  progress_.tick_count = tick_count();
  progress_.agents_alive = team.agents_alive;
  progress_.agents_expected = team.agents_expected;
  progress_.missed_deadlines = team.missed_deadlines;
  progress_.silent_agent = team.silent_agent;
}

void MissionWatch::on(const AgentStatus& agent, const Arrival& arrival) {
  const Instant now = arrival.now;
  reach(agent.header.tick, now);
  reach(answers_ticks(agent.phase) ? Stage::kRunning : Stage::kReady, now);
  if (answers_ticks(agent.phase)) {
    progress_.world_silent = agent.waiting_for == kWorld;
    last_running_ = now;
  }
  if (progress_.coordinator_silent) progress_.ergodic_metric = agent.ergodic_metric;
  const bool at_the_end = me_.counted(agent.header.tick) >= tick_count();
  if (agent.phase == AgentPhase::kFinished && at_the_end) reach(Stage::kOver, now);
}

void MissionWatch::on(const MissionPart& part, const Arrival& arrival) {
  const Instant now = arrival.now;
  mission_repeat_.overheard(part.revision, me_.follower().revision(), now, me_.received());
  failed_ = failed_ || part.state == MissionState::kFailed;
  if (!part.reason.empty()) reason_ = part.reason;
  reach(part.header.tick, now);
  if (failed_ || part.state == MissionState::kEnded) reach(Stage::kOver, now);
}

void MissionWatch::on(const Stop& stop, const Arrival& arrival) {
  const Instant now = arrival.now;
  if (!stop.now || stopping()) return;  // not an emergency stop, or our own
  failed_ = failed_ || stop.failed;
  reason_ = stop.reason;
  reach(Stage::kOver, now);
}

/// The logger repeats all finds.
void MissionWatch::on(const RecordAck& ack, const Arrival& arrival) {
  if (!arrival.fresh || !me_.knows_mission()) return;
  const auto finds = ack.all_finds();
  for (; finds_told_ < finds.size(); ++finds_told_) {
    Find find = finds[finds_told_];
    find.t_s = static_cast<double>(me_.counted(find.tick)) * timing_.dt_s;
    display_.print(to_text(find));
  }
  if (ack.wrong_confirmations <= wrong_told_) return;
  wrong_told_ = ack.wrong_confirmations;
  display_.print(wrong_confirmations_text(wrong_told_));
}

void MissionWatch::reach(Stage stage, Instant now) {
  if (stage <= stage_) return;
  stage_ = stage;
  tick_since_ = now;
}

void MissionWatch::reach(Tick tick, Instant now) {
  me_.note_tick(tick);
  if (tick <= tick_) return;
  tick_ = tick;
  progress_.tick = me_.counted(tick);
  progress_.world_tick = tick;
  progress_.paused = me_.is_held(tick);
  tick_since_ = now;
}

std::vector<AgentId> MissionWatch::sent_out() const {
  std::vector<AgentId> agents;
  for (const RosterEntry& entry : me_.follower().roster()) {
    if (entry.leaves) agents.push_back(entry.author.agent);
  }
  return agents;
}

std::optional<std::string> MissionWatch::overdue(Instant now) const {
  const bool waiting = timing_.pace == Pace::kLockstep && stage_ == Stage::kRunning;
  if (!waiting || now - tick_since_ < seconds(timing_.lockstep_timeout_s)) return std::nullopt;
  return "tick " + std::to_string(tick_) + " was not answered in time";
}

bool MissionWatch::deserted(Instant now) const {
  return stage_ == Stage::kRunning && now - last_running_ >= kDesertedAfter;
}

void MissionWatch::answer(Transport& transport, Instant now) {
  if (!mission_repeat_.due(now)) return;
  mission_repeat_.done(now);
  Outbox out;
  for (const MissionPart& part : me_.follower().parts()) {
    for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) out.push_back({bus, part});
  }
  transport.publish(out);
}

void MissionWatch::stop(bool failed, std::string reason) {
  if (!stop_) stop_.emplace(me_.run(), failed, std::move(reason));
}

void MissionWatch::repeat(Transport& transport, Instant now, bool led) {
  if (!stop_) return;
  if (!stopping_since_) stopping_since_ = now;
  // A coordinator that has exited or hangs does not end the mission.
  const bool heard = stage_ == Stage::kOver || now - *stopping_since_ < kCoordinatorPatience;
  Outbox out;
  stop_->repeat(now, !led || !heard, tick_, transport.keyed(), out);
  transport.publish(out);
}

}  // namespace ergocast::cli
