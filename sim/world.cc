// SPDX-License-Identifier: BSD-3-Clause
// Collects the commands of a tick, publishes the next state, and repeats it until it is answered.
#include "sim/world.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <utility>

#include "core/mission/end_by_finding.h"
#include "core/motion/filter_rules.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

/// A world that begins asks the agents for their positions, this often. In real time it begins
/// without the agents that have not answered within kQuestionPatience.
constexpr auto kQuestionPeriod = 100ms;
constexpr auto kMissionPatience = 1500ms;
constexpr auto kQuestionPatience = 2s;
/// How long the world repeats the end after the last progress of the record.
constexpr auto kLinger = 2s;
/// Lockstep: the longest time that a tick of a paused mission takes. It takes time because no
/// process waits for it.
constexpr double kLongestHeldTick_s = 0.1;

}  // namespace

World::World(RunId run, Incarnation incarnation, PhysicsMaker physics)
    : me_(kRole, {run, kWorld, incarnation}), fleet_(std::move(physics)) {}

void World::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (finished_) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

void World::on(const MissionPart&, const Arrival& arrival) {
  if (emergency_stopped_ || !arrival.mission_changed) return;
  if (follower().plan_problem()) return finish(*follower().plan_problem());
  if (auto problem = fleet_.learn(mission())) return fail(std::move(*problem));
  // At the mission's last tick the world waits until the record has the last states, too.
  if (follower().over() && (!over_since_ || record_.complete(tick_)))
    return finish(follower().reason());
  if (started_) take_roster();
  if (!started_ && follower().state() == MissionState::kRunning) start(arrival.now);
}

void World::on(const RecordAck& ack, const Arrival& arrival) {
  if (!arrival.fresh) return;
  record_.acknowledge(ack, arrival.now);
  // A restarted world learns what its predecessor's team had found.
  for (const Find& find : ack.all_finds()) found_ |= ObjectSet{1} << find.object;
  if (over_since_ && (emergency_stopped_ || follower().over()) && record_.complete(tick_))
    finish(why_over());
}

void World::on(const Stop& stop, const Arrival&) {
  if (me_.run() == 0) return;  // of a run that it does not know
  if (!stop.now || emergency_stopped_ || over_since_)
    return;  // in order, the coordinator ends the mission
  if (!begun_at_) return finish(stop.reason);
  emergency_stopped_ = stop.reason;
}

// ---- beginning ----

void World::start(Instant now) {
  started_ = true;
  question_.since = question_.next = now;
  take_roster();
}

/// The coordinator sends the mission each second. Without a coordinator, the agents send it if
/// asked.
void World::ask_for_mission(Instant now, Outbox& out) {
  if (me_.knows_mission() || me_.run() == 0) return;
  if (question_.next != Instant{} && now >= question_.next) ask(-1, kUnassigned, out);
  if (now >= question_.next) question_.next = now + kMissionPatience;
}

void World::ask(Tick known, AgentId whom, Outbox& out) {
  Hello question;
  question.requested_id = whom;
  me_.publish(Bus::kWorld, question, known, out);
}

void World::ask_team(Instant now, Outbox& out) {
  // If no agent answers this, none would answer a tick either, and we would begin at a wrong tick.
  if (!newest_answer()) question_.since = now;
  // In lockstep a tick waits for all members anyway. A member that alone had received our
  // predecessor's last tick would never answer an earlier one.
  const bool may_begin_without =
      mission().timing.pace == Pace::kRealtime && now - *question_.since >= kQuestionPatience;
  const AgentId unheard = fleet_.first_unheard();
  if (now >= question_.earliest_end && knows_bodies() &&
      (unheard == kUnassigned || may_begin_without))
    return begin(now);
  if (now < question_.next) return;
  question_.next = now + kQuestionPeriod;
  ask(0, unheard, out);
}

/// Whether it has received a state with all bodies that is new enough to begin from. An agent that
/// has answered a tick knows the whole state of that tick, and sends it before the answer.
bool World::knows_bodies() const {
  return !begins_by_state(mission()) ||
         question_.before.newest() >= fleet_.newest_answer_of_members();
}

void World::begin(Instant now) {
  question_.since.reset();
  record_.start(now);
  schedule_.begin(now);
  tick_ = std::max(tick_, newest_answer().value_or(-1));
  // Perhaps only newcomers have answered. Every tick that the roster names has passed.
  for (const RosterEntry& entry : follower().roster()) {
    tick_ = std::max({tick_, entry.active_from, entry.active_until});
  }
  if (begins_by_state(mission())) tick_ = std::max(tick_, question_.before.newest());
  tick_ = std::min(tick_, me_.end_tick());  // even if the roster names a later one
  begun_at_ = tick_;
  fleet_.begin(tick_, question_.before, surroundings());
}

/// No vehicle moves before the first tick is published.
Surroundings World::surroundings() const {
  if (!begun_at_) return Surroundings::kPlanned;
  return tick_ == 0 && !schedule_.published() ? Surroundings::kStanding : Surroundings::kMoving;
}

void World::take_roster() {
  fleet_.take_zones(follower().amendments().zones);
  fleet_.take_roster(follower().roster(), surroundings());
}

void World::on(const WorldState& before, const Arrival&) {
  if (!question_.since || !begins_by_state(mission())) return;
  if (before.header.tick > me_.end_tick()) return;
  question_.before.take(before);
  found_ |= before.found;
}

// ---- commands ----

void World::on(const Command& command, const Arrival&) {
  CommandHistory* const commands = fleet_.commands_of(command.header);
  if (commands == nullptr) return;
  // Recorded commands, and answers to a world before us, do not show where the team is now.
  if (question_.since && command.asked_by != me_.incarnation()) return;
  if (!is_possible(command)) return me_.count_refused(Refusal::kRange);
  commands->take(command);
}

/// Whether a command can be true. Its step does not overflow, and its tick has been sent.
bool World::is_possible(const Command& command) const {
  const Tick newest = question_.since ? me_.end_tick() : tick_;
  if (command.header.tick > newest) return false;
  const Eigen::Vector3d step_m = command.velocity_mps * mission().timing.dt_s;
  if (!step_m.allFinite()) return false;
  // A command without a tick is the answer of an agent that knows no position yet.
  const bool has_place = question_.since && command.header.tick >= 0;
  // Where a distance is kept, another message has the positions, and a body may have been pushed
  // out.
  if (!has_place || keeps_distance(mission())) return true;
  return mission().domain.contains(command.position_m);
}

// ---- ticks ----

/// Lockstep: whether the coordinator must name a tick before the next tick. So all agents know the
/// named tick before it comes.
bool World::stands_by() const {
  if (mission().timing.pace != Pace::kLockstep || record_.empty()) return false;
  const std::int64_t since = follower().stand_by_revision();
  return (since >= 0 && record_.newest().front().roster_revision >= since) ||
         lacks_end_by_finding(mission(), follower().amendments(), std::popcount(found_), tick_);
}

/// Adds what is found at this tick, by the rule of the record (logger/record_tables.h): by members
/// that cover.
void World::note_found(std::vector<WorldState>& states) {
  const auto covers = [this](AgentId id) {
    return std::ranges::any_of(follower().roster(), [&](const RosterEntry& entry) {
      return entry.author.agent == id && entry.active_at(tick_) &&
             !entry.recalled_at(follower().revision());
    });
  };
  for (const WorldState& state : states) {
    // With false alarms only the record knows.
    if (me_.is_held(tick_) || me_.is_over(tick_) || mission().sensor.has_false_alarms()) break;
    for (const Vehicle& vehicle : state.vehicles_in_part())
      if (vehicle.detected != 0 && covers(vehicle.id)) found_ |= vehicle.detected;
  }
  for (WorldState& state : states) state.found = found_;
}

/// Whether the next step of a paused mission waits only for the clock.
bool World::waits_for_time(Instant now) const {
  return schedule_.held(now) && fleet_.everyone_answered(tick_) && !stands_by();
}

bool World::record_is_close(Instant now) {
  if (!mission().wait_for_logger) return true;
  // Half of the time-out, so that the coordinator does not give up the team first.
  return record_.is_close(tick_, now, seconds(mission().timing.lockstep_timeout_s / 2));
}

void World::advance(Instant now, Outbox& out) {
  if (over_since_ && now - std::max(*over_since_, record_.progress()) > kLinger) {
    finish(why_over());
  }
  if (finished_) return publish_final_state(out);
  if (!started_) return ask_for_mission(now, out);
  if (!over_since_ && me_.cut_off(tick_, now)) {
    return finish("the mission must be over: no agent and no coordinator answers");
  }
  if (question_.since) ask_team(now, out);
  if (question_.since) return;
  if (emergency_stopped_ && !over_since_) return send_zero_velocity(now, out);
  if (mission().timing.pace == Pace::kLockstep || over_since_) {
    advance_lockstep(now, out);
  } else {
    advance_realtime(now, out);
  }
}

void World::advance_lockstep(Instant now, Outbox& out) {
  const bool over = over_since_ || me_.is_over(tick_);
  if (!schedule_.published()) {
    if (!record_is_close(now)) {
      if (schedule_.repeat_due(now)) repeat(now, out);
      return;
    }
    remember_and_publish(now, out);
  } else if (waits_for_time(now)) {
    schedule_.publish_after_hold();
  } else if (!over && fleet_.everyone_answered(tick_) && !stands_by()) {
    step();
    schedule_.note_step();
    return advance_lockstep(now, out);
  } else if (schedule_.repeat_due(now)) {
    repeat(now, out);
  }
  if (over && !over_since_) over_since_ = now;
}

void World::advance_realtime(Instant now, Outbox& out) {
  const Timing& timing = mission().timing;
  const auto period = seconds(timing.dt_s / timing.realtime_factor);
  if (!schedule_.published()) {
    if (!record_is_close(now)) {  // before the first tick: no logger has reported yet
      schedule_.set_next_tick(now + TickSchedule::kRepeatPeriod);
      return;
    }
    remember_and_publish(now, out);
    schedule_.set_next_tick(now + period);
  }
  skipped_ticks_ += schedule_.drop_late_ticks(now, period, timing.catch_up_limit_ticks);
  while (now >= schedule_.next_tick() && !me_.is_over(tick_)) {
    missed_deadlines_ += fleet_.late_members(tick_);
    step();
    remember_and_publish(now, out);
    schedule_.set_next_tick(schedule_.next_tick() + period);
  }
  if (me_.is_over(tick_)) over_since_ = now;
}

/// One more tick, in which no vehicle moves.
void World::send_zero_velocity(Instant now, Outbox& out) {
  if (!schedule_.published()) remember_and_publish(now, out);  // where the last step led
  fleet_.stop();
  ++tick_;
  over_since_ = now;
  remember_and_publish(now, out);
}

std::string World::why_over() const {
  if (emergency_stopped_) return *emergency_stopped_;
  return follower().over() ? follower().reason() : "mission complete";
}

void World::step() {
  fleet_.step(tick_);
  if (!me_.is_held(tick_)) fleet_.use_batteries();
  ++tick_;
}

std::vector<WorldState> World::snapshot() {
  std::vector<WorldState> states = fleet_.snapshot(tick_);
  for (WorldState& state : states) {
    state.missed_deadlines = missed_deadlines_;
    state.skipped_ticks = skipped_ticks_;
    state.clamped_commands = fleet_.clamped_commands();
    state.uncounted_ticks = tick_ - me_.counted(tick_);
    state.roster_revision = follower().revision();
    state.header.tick = tick_;
    state.found = found_;
  }
  return states;
}

void World::publish(const std::vector<WorldState>& states, Outbox& out) {
  for (const WorldState& state : states) me_.publish(Bus::kWorld, state, state.header.tick, out);
}

void World::repeat(Instant now, Outbox& out) {
  schedule_.note_repeat(now);
  if (schedule_.published()) {
    // The repeat has the same state, with the newest answers and newcomers. The roster revision of
    // the tick stays: it must be the same for all agents, whichever repeat they receive.
    const std::int64_t revision_in_use = record_.newest().front().roster_revision;
    record_.newest() = snapshot();
    for (WorldState& part : record_.newest()) part.roster_revision = revision_in_use;
  } else if (!record_.empty()) {
    // The vehicles have moved on already.
    for (WorldState& part : record_.newest()) {
      for (Vehicle& vehicle : part.vehicles_in_part()) {
        vehicle.answered_tick = fleet_.answered(vehicle.id);
      }
    }
  }
  if (!record_.empty()) publish(record_.newest(), out);
  record_.for_each_lacking(tick_, [&](const auto& states) { publish(states, out); });
}

void World::remember_and_publish(Instant now, Outbox& out) {
  const double least_s =
      me_.is_held(tick_) ? std::min(mission().timing.dt_s, kLongestHeldTick_s) : 0;
  schedule_.note_published(now, seconds(least_s));
  std::vector<WorldState> states = snapshot();
  note_found(states);
  record_.remember(std::move(states));
  publish(record_.newest(), out);
}

Instant World::next_wakeup() const {
  if (finished_) return Instant::max();
  if (!started_) return me_.knows_mission() || me_.run() == 0 ? Instant::max() : question_.next;
  if (question_.since) return question_.next;
  if (over_since_) return schedule_.next_publish();
  return mission().timing.pace == Pace::kLockstep ? schedule_.next_publish()
                                                  : schedule_.next_tick();
}

void World::finish(std::string reason) {
  finished_ = true;
  reason_ = std::move(reason);
  final_state_due_ = (over_since_ || follower().over()) && !record_.empty();
}

/// Coordinator and logger need not wait for a world that has left.
void World::publish_final_state(Outbox& out) {
  if (!std::exchange(final_state_due_, false)) return;
  WorldState farewell = record_.newest().front();
  farewell.last = true;
  me_.publish(Bus::kWorld, farewell, farewell.header.tick, out);
}

}  // namespace ergocast
