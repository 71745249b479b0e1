// SPDX-License-Identifier: BSD-3-Clause
// Collects the commands of a tick, moves the vehicles, publishes the next state, and repeats it
// until it is answered.
#include "sim/world.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/geometry.h"
#include "core/noise.h"
#include "core/vehicle.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

/// An unanswered tick is repeated after this time, then after twice as long each time. So a loss is
/// repaired soon, and a slow team does not receive too many repeats.
constexpr std::chrono::nanoseconds kRepeatPeriod = 20ms;
constexpr std::chrono::nanoseconds kLongestRepeatPeriod = 100ms;
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
    : me_(kRole, {run, kWorld, incarnation}), physics_maker_(std::move(physics)) {}

void World::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (finished_) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

void World::on(const MissionPart&, const Arrival& arrival) {
  if (emergency_stopped_ || !arrival.mission_changed) return;
  if (follower().plan_problem()) return finish(*follower().plan_problem());
  if (!make_physics()) return;
  // At the mission's last tick the world waits until the record has the last states, too.
  if (follower().over() && (!over_since_ || record_.complete(tick_)))
    return finish(follower().reason());
  if (started_) take_roster();
  if (!started_ && follower().state() == MissionState::kRunning) start(arrival.now);
}

void World::on(const RecordAck& ack, const Arrival& arrival) {
  if (!arrival.fresh) return;
  record_.acknowledge(ack, arrival.now);
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
  question_ = {now, now, {}};
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
  const bool heard = std::any_of(vehicles_.begin(), vehicles_.end(),
                                 [](const auto& one) { return one.second.command.has_value(); });
  if (!heard) question_.since = now;
  // In lockstep a tick waits for all members anyway. A member that alone had received our
  // predecessor's last tick would never answer an earlier one.
  const bool may_begin_without =
      mission().timing.pace == Pace::kRealtime && now - *question_.since >= kQuestionPatience;
  const AgentId unheard = first_unheard();
  if (now >= earliest_begin_ && knows_bodies() && (unheard == kUnassigned || may_begin_without))
    return begin(now);
  if (now < question_.next) return;
  question_.next = now + kQuestionPeriod;
  ask(0, unheard, out);
}

std::optional<Tick> World::newest_answer() const {
  std::optional<Tick> newest;
  for (const auto& [id, slot] : vehicles_) {
    if (slot.command) newest = std::max(newest, std::optional(slot.answered()));
  }
  return newest;
}

/// The first member that has not answered with its last two commands; kUnassigned: all have.
AgentId World::first_unheard() const {
  for (const auto& [id, slot] : vehicles_) {
    if (slot.author.incarnation != 0 && !slot.command_before) return id;
  }
  return kUnassigned;
}

void World::begin(Instant now) {
  question_.since.reset();
  record_.start(now);
  schedule_.next_tick = now;
  schedule_.repeat_period = kRepeatPeriod;
  for (const auto& [id, slot] : vehicles_) tick_ = std::max(tick_, slot.answered());
  // Perhaps only newcomers have answered. Every tick that the roster names has passed.
  for (const RosterEntry& entry : follower().roster()) {
    tick_ = std::max({tick_, entry.active_from, entry.active_until});
  }
  if (begins_by_state()) tick_ = std::max(tick_, question_.before.newest());
  tick_ = std::min(tick_, me_.end_tick());  // even if the roster names a later one
  begun_at_ = tick_;
  if (filters_again(mission()) || any_but_points(mission())) filter_.emplace(mission(), 0);
  if (begins_by_state()) {
    settle();
  } else {
    for (auto& [id, slot] : vehicles_) recall(id, slot);
  }
  place_bodies();
}

void World::take_roster() {
  const Mission& mission = me_.mission();
  for (const RosterEntry& entry : follower().roster()) {
    const auto known = vehicles_.find(entry.author.agent);
    if (entry.active_until >= 0) {
      if (known != vehicles_.end() && known->second.author == entry.author) {
        known->second.author.incarnation = 0;  // no agent drives it; its place is kept
      }
    }
  }
  for (const RosterEntry& entry : follower().roster()) {
    if (entry.active_until >= 0) continue;
    auto [at, is_new] = vehicles_.try_emplace(entry.author.agent);
    if (is_new) {
      const AgentId id = entry.author.agent;
      place(id, at->second, begun_at_ ? place_for(id) : start_of(mission, id));
      if (physics_ && begun_at_) physics_->place(id, at->second.x_m, at->second.applied_mps);
    }
    if (at->second.author != entry.author) {
      at->second.command.reset();
      at->second.command_before.reset();
    }
    at->second.author = entry.author;
  }
}

void World::place(AgentId id, VehicleSlot& slot, const Eigen::Vector3d& x_m) const {
  slot.x_m = x_m;
  slot.applied_mps = first_velocity(motion_of(mission(), id), x_m);
}

void World::on(const Command& command, const Arrival&) {
  const auto at = vehicles_.find(command.header.sender);
  if (at == vehicles_.end() || at->second.author.incarnation != command.header.incarnation) return;
  // Recorded commands, and answers to a world before us, do not show where the team is now.
  if (question_.since && command.asked_by != me_.incarnation()) return;
  VehicleSlot& slot = at->second;
  const Mission& mission = me_.mission();
  const Eigen::Vector3d step_m = command.velocity_mps * mission.timing.dt_s;
  // A step that overflows is refused. So is the answer to a tick that was not sent.
  const Tick newest = question_.since ? me_.end_tick() : tick_;
  // A command without a tick is the answer of an agent that knows no position yet.
  const bool somewhere = question_.since && command.header.tick >= 0;
  // Where a distance is kept, another message has the positions, and a body may have been pushed
  // out.
  const bool outside =
      somewhere && !keeps_distance() && !mission.domain.contains(command.position_m);
  if (!step_m.allFinite() || command.header.tick > newest || outside) {
    me_.count_refused(Refusal::kRange);
    return;
  }
  const auto newer_than = [&](const std::optional<Command>& known) {
    return !known || command.header.tick > known->header.tick;
  };
  const bool again = slot.command && command.header.tick == slot.answered();
  if (again && slot.answered() < 0) {
    // One of the two may arrive before the answer to tick 0. Only both show that there is none.
    const auto apart = std::abs(command.header.sequence - slot.command->header.sequence);
    if (apart == 1) slot.command_before = slot.command;
    slot.command = command;
  } else if (again && command.velocity_mps.isZero(0)) {
    slot.command->velocity_mps.setZero();  // the only correction that an agent may send
  } else if (newer_than(slot.command)) {
    slot.command_before = std::exchange(slot.command, command);
  } else if (command.header.tick < slot.answered() && newer_than(slot.command_before)) {
    slot.command_before = command;  // overtaken by the one after it
  }
}

bool World::everyone_answered() const {
  // Without any agent, the tick waits for a restarted one or for the coordinator's time-out.
  bool driven = false;
  for (const auto& [id, slot] : vehicles_) {
    if (slot.author.incarnation == 0) continue;
    if (slot.answered() != tick_) return false;
    driven = true;
  }
  return driven;
}

/// Lockstep: whether the coordinator must name a tick before the next tick. So all agents know the
/// named tick before it comes.
bool World::stands_by() const {
  const std::int64_t since = follower().stand_by_revision();
  return since >= 0 && mission().timing.pace == Pace::kLockstep && !record_.empty() &&
         record_.newest().front().roster_revision >= since;
}

/// Whether the next step of a paused mission waits only for the clock.
bool World::waits_for_time(Instant now) const {
  return now < schedule_.held_until && everyone_answered() && !stands_by();
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
  if (!schedule_.published) {
    if (!record_is_close(now)) {
      if (now >= schedule_.next_publish) repeat(now, out);
      return;
    }
    remember_and_publish(now, out);
  } else if (waits_for_time(now)) {
    schedule_.next_publish = std::max(schedule_.next_publish, schedule_.held_until);
  } else if (!over && everyone_answered() && !stands_by()) {
    step(false);
    schedule_.published = false;
    return advance_lockstep(now, out);
  } else if (now >= schedule_.next_publish) {
    repeat(now, out);
  }
  if (over && !over_since_) over_since_ = now;
}

void World::advance_realtime(Instant now, Outbox& out) {
  const Timing& timing = mission().timing;
  const auto period = seconds(timing.dt_s / timing.realtime_factor);
  if (!schedule_.published) {
    if (!record_is_close(now)) {  // before the first tick: no logger has reported yet
      schedule_.next_tick = now + kRepeatPeriod;
      return;
    }
    remember_and_publish(now, out);
    schedule_.next_tick = now + period;
  }
  const auto late = (now - schedule_.next_tick) / period;
  if (late > timing.catch_up_limit_ticks) {
    counted_.skipped_ticks += late - timing.catch_up_limit_ticks;
    schedule_.next_tick += (late - timing.catch_up_limit_ticks) * period;
  }
  while (now >= schedule_.next_tick && !me_.is_over(tick_)) {
    for (const auto& [id, slot] : vehicles_) {
      if (slot.author.incarnation != 0 && slot.answered() < tick_) ++counted_.missed_deadlines;
    }
    step(true);
    remember_and_publish(now, out);
    schedule_.next_tick += period;
  }
  if (me_.is_over(tick_)) over_since_ = now;
}

/// One more tick, in which no vehicle moves.
void World::send_zero_velocity(Instant now, Outbox& out) {
  if (!schedule_.published) remember_and_publish(now, out);  // where the last step led
  for (auto& [id, slot] : vehicles_) slot.applied_mps = slot.next_mps = {0, 0, 0};
  if (physics_) move_bodies();  // bodies with mass roll on
  ++tick_;
  over_since_ = now;
  remember_and_publish(now, out);
}

std::string World::why_over() const {
  if (emergency_stopped_) return *emergency_stopped_;
  return follower().over() ? follower().reason() : "mission complete";
}

bool World::driven(const VehicleSlot& slot, Tick tick, bool hold_old_commands) const {
  if (slot.answered() < 0 || slot.author.incarnation == 0) return false;
  const Timing& timing = mission().timing;
  const double age_s = static_cast<double>(tick - slot.answered()) * timing.dt_s;
  return age_s <= (hold_old_commands ? timing.command_hold_s : 0);
}

Eigen::Vector3d World::command_of(const VehicleSlot& slot, Tick tick,
                                  bool hold_old_commands) const {
  return driven(slot, tick, hold_old_commands) ? slot.command->velocity_mps
                                               : Eigen::Vector3d(0, 0, 0);
}

void World::step(bool hold_old_commands) {
  for (auto& [id, slot] : vehicles_) {
    drive(id, slot, tick_, hold_old_commands);
    if (driven(slot, tick_, hold_old_commands) && slot.next_mps != slot.command->velocity_mps)
      ++counted_.clamped_commands;
  }
  if (filter_) filter_commands();
  if (physics_) {
    move_bodies();
  } else {
    for (auto& [id, slot] : vehicles_) move(id, slot, tick_);
  }
  ++tick_;
}

void World::drive(AgentId id, VehicleSlot& slot, Tick tick, bool hold_old_commands) const {
  slot.next_mps = executed(motion_of(mission(), id), slot.applied_mps,
                           command_of(slot, tick, hold_old_commands));
}

void World::move(AgentId id, VehicleSlot& slot, Tick tick) const {
  const Mission& mission = me_.mission();
  const Eigen::Vector3d mean_mps =
      mean_velocity(motion_of(mission, id), slot.applied_mps, slot.next_mps);
  slot.x_m = reflect(moved(mission, id, tick, slot.x_m, mean_mps), mission.domain);
  slot.applied_mps = slot.next_mps;
}

std::vector<WorldState> World::snapshot() const {
  const auto parts = std::max<std::size_t>(
      1, (vehicles_.size() + kMaxVehiclesPerState - 1) / kMaxVehiclesPerState);
  std::vector<WorldState> states(parts);
  std::size_t i = 0;
  for (const auto& [id, slot] : vehicles_) {
    WorldState& state = states[i++ / kMaxVehiclesPerState];
    Vehicle& vehicle = state.vehicles[static_cast<std::size_t>(state.vehicle_count++)];
    vehicle.id = id;
    vehicle.answered_tick = slot.answered();
    vehicle.position_m = slot.x_m;
    vehicle.velocity_mps = slot.applied_mps;
  }
  for (std::size_t part = 0; part < parts; ++part) {
    states[part].part = static_cast<std::int32_t>(part);
    states[part].parts = static_cast<std::int32_t>(parts);
    states[part].missed_deadlines = counted_.missed_deadlines;
    states[part].skipped_ticks = counted_.skipped_ticks;
    states[part].clamped_commands = counted_.clamped_commands;
    states[part].uncounted_ticks = tick_ - me_.counted(tick_);
    states[part].roster_revision = follower().revision();
    states[part].header.tick = tick_;
  }
  return states;
}

void World::publish(const std::vector<WorldState>& states, Outbox& out) {
  for (const WorldState& state : states) me_.publish(Bus::kWorld, state, state.header.tick, out);
}

void World::repeat(Instant now, Outbox& out) {
  schedule_.repeat_period = std::min(2 * schedule_.repeat_period, kLongestRepeatPeriod);
  schedule_.next_publish = now + schedule_.repeat_period;
  if (schedule_.published) {
    // The repeat has the same state, with the newest answers and newcomers. The roster revision of
    // the tick stays: it must be the same for all agents, whichever repeat they receive.
    const std::int64_t revision_in_use = record_.newest().front().roster_revision;
    record_.newest() = snapshot();
    for (WorldState& part : record_.newest()) part.roster_revision = revision_in_use;
  } else if (!record_.empty()) {
    // The slots have moved on already.
    for (WorldState& part : record_.newest()) {
      for (int i = 0; i < part.vehicle_count; ++i) {
        Vehicle& vehicle = part.vehicles[static_cast<std::size_t>(i)];
        vehicle.answered_tick = vehicles_.at(vehicle.id).answered();
      }
    }
  }
  if (!record_.empty()) publish(record_.newest(), out);
  record_.for_each_lacking(tick_, [&](const auto& states) { publish(states, out); });
}

void World::remember_and_publish(Instant now, Outbox& out) {
  schedule_.published = true;
  schedule_.repeat_period = kRepeatPeriod;
  schedule_.next_publish = now + schedule_.repeat_period;
  schedule_.held_until = now;
  if (me_.is_held(tick_))
    schedule_.held_until += seconds(std::min(mission().timing.dt_s, kLongestHeldTick_s));
  record_.remember(snapshot());
  publish(record_.newest(), out);
}

Instant World::next_wakeup() const {
  if (finished_) return Instant::max();
  if (!started_) return me_.knows_mission() || me_.run() == 0 ? Instant::max() : question_.next;
  if (question_.since) return question_.next;
  if (over_since_) return schedule_.next_publish;
  return mission().timing.pace == Pace::kLockstep ? schedule_.next_publish : schedule_.next_tick;
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
