#include "sim/world.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/geometry.h"
#include "core/noise.h"
#include "team/silence.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

/// An unanswered tick is repeated after this, then after twice as long each time: a loss is mended
/// at once, and a team that is merely slow is not buried in repeats.
constexpr std::chrono::nanoseconds kRepeatPeriod = 20ms;
constexpr std::chrono::nanoseconds kLongestRepeatPeriod = 100ms;
/// A world that begins asks the agents where they are, this often; and begins without those that
/// have not answered for so long. Nobody can answer a tick then either.
constexpr auto kQuestionPeriod = 100ms;
constexpr auto kMissionPatience = 1500ms;
constexpr auto kQuestionPatience = 2s;
/// So many states that the logger lacks it gets with each repeat. A row needs two: its tick's, and
/// the next one's, which carries the applied velocity.
constexpr Tick kHelpTicks = 16;
/// How long the end is repeated to whoever has not heard of it, after the record's last progress.
constexpr auto kFarewell = 2s;

}  // namespace

World::World(RunId run, Incarnation incarnation) : run_(run), incarnation_(incarnation) {}

void World::receive(const Message& message, Instant now) {
  if (finished_) return;
  const Header& from = header_of(message);
  if (run_ != 0 && from.run != run_) return;
  note_heard(message, now);
  if (const auto* command = std::get_if<Command>(&message)) return on(*command);
  if (const auto* part = std::get_if<MissionPart>(&message)) {
    if (run_ == 0) run_ = from.run;
    if (halted_ || !follower_.receive(*part)) return;
    if (follower_.plan_problem()) return finish(*follower_.plan_problem());
    // At its own end the world stays until the record, too, has the last states.
    if (follower_.over() && (!over_since_ || record_complete())) return finish(follower_.reason());
    if (started_) take_roster();
    if (!started_ && follower_.state() == MissionState::kRunning) start(now);
    return;
  }
  if (const auto* ack = std::get_if<RecordAck>(&message)) {
    // A restarted logger may have less than its predecessor had.
    if (!freshness_.is_news(from)) return;
    if (!recorded_ || ack->header.tick > *recorded_ || from.incarnation != logger_) {
      logger_lost_ = logger_lost_ && from.incarnation == logger_;
      logger_ = from.incarnation;
      recorded_ = ack->header.tick;
      record_progress_ = now;
    }
    if (over_since_ && (halted_ || follower_.over()) && record_complete()) finish(why_over());
    return;
  }
  if (const auto* stop = std::get_if<Stop>(&message); stop && run_ != 0) on(*stop);
}

void World::note_heard(const Message& message, Instant now) {
  const bool team =
      std::holds_alternative<Command>(message) || std::holds_alternative<MissionPart>(message);
  if (team && freshness_.is_news(header_of(message))) heard_ = now;
}

void World::on(const Stop& stop) {
  if (!stop.now || halted_ || over_since_) return;  // in order, the coordinator ends the mission
  if (!begun_at_) return finish(stop.reason);
  halted_ = stop.reason;
}

// ---- beginning -----------------------------------------------------------------------------------

void World::start(Instant now) {
  started_ = true;
  heard_ = now;
  asking_since_ = now;
  next_question_ = now;
  take_roster();
}

/// The coordinator says it each second; with none left, the agents do if they are asked.
void World::ask_for_mission(Instant now, Outbox& out) {
  if (follower_.mission() || run_ == 0) return;
  if (next_question_ != Instant{} && now >= next_question_) ask(-1, out);
  if (now >= next_question_) next_question_ = now + kMissionPatience;
}

void World::ask(Tick known, Outbox& out) {
  Hello question;
  question.header = {run_, kWorld, incarnation_, sequencer_.next(Bus::kWorld), known};
  out.push_back({Bus::kWorld, question});
}

void World::ask_team(Instant now, Outbox& out) {
  // With no answer at all nobody could answer a tick either, and we would begin at the wrong one.
  const bool heard = std::any_of(bodies_.begin(), bodies_.end(),
                                 [](const auto& one) { return one.second.command.has_value(); });
  if (!heard) asking_since_ = now;
  if (team_has_answered() || now - *asking_since_ >= kQuestionPatience) return begin(now);
  if (now < next_question_) return;
  next_question_ = now + kQuestionPeriod;
  ask(0, out);
}

bool World::team_has_answered() const {
  // With its last two commands, or with one that says that there is none.
  return std::all_of(bodies_.begin(), bodies_.end(), [](const auto& one) {
    const Body& body = one.second;
    return body.author.incarnation == 0 || body.command_before ||
           (body.command && body.answered() < 0);
  });
}

void World::begin(Instant now) {
  asking_since_.reset();
  record_progress_ = now;
  next_tick_ = now;
  repeat_period_ = kRepeatPeriod;
  for (const auto& [id, body] : bodies_) tick_ = std::max(tick_, body.answered());
  // Even if only newcomers have answered: not before what the roster says has happened.
  for (const RosterEntry& entry : follower_.roster()) {
    tick_ = std::max({tick_, entry.active_from, entry.active_until});
  }
  tick_ = std::min(tick_, follower_.mission()->timing.tick_count);  // whatever the roster says
  begun_at_ = tick_;
  for (auto& [id, body] : bodies_) recall(id, body);
}

/// Puts a body where it was at tick_, by its agent's last two commands.
void World::recall(AgentId id, Body& body) {
  if (body.answered() < 0) return;
  const bool hold = follower_.mission()->timing.pace == Pace::kRealtime;
  body.x_m = body.command->position_m.head<2>();
  const bool in_a_row =
      body.command_before && body.command_before->header.tick + 1 == body.answered();
  if (in_a_row) {
    body.applied_mps =
        within_speed_limit(*follower_.mission(), body.command_before->velocity_mps.head<2>());
  }
  for (Tick tick = body.answered(); tick < tick_; ++tick) move(id, body, tick, hold);
}

void World::take_roster() {
  const Mission& mission = *follower_.mission();
  for (const RosterEntry& entry : follower_.roster()) {
    const auto known = bodies_.find(entry.author.agent);
    if (entry.active_until >= 0) {
      if (known != bodies_.end() && known->second.author == entry.author) {
        known->second.author.incarnation = 0;  // nobody drives it; its place is kept
      }
    }
  }
  for (const RosterEntry& entry : follower_.roster()) {
    if (entry.active_until >= 0) continue;
    auto [at, is_new] = bodies_.try_emplace(entry.author.agent);
    if (is_new) at->second.x_m = start_of(mission, entry.author.agent);
    if (at->second.author != entry.author) {
      at->second.command.reset();
      at->second.command_before.reset();
    }
    at->second.author = entry.author;
  }
}

void World::on(const Command& command) {
  const auto at = bodies_.find(command.header.sender);
  if (at == bodies_.end() || at->second.author.incarnation != command.header.incarnation) return;
  // Recorded commands, and answers to a world before us, do not say where the team is now.
  if (asking_since_ && command.asked_by != incarnation_) return;
  Body& body = at->second;
  const Mission& mission = *follower_.mission();
  const Eigen::Vector2d step_m = command.velocity_mps.head<2>() * mission.timing.dt_s;
  // Numbers that only overflow here are no velocities; and nobody answers a tick that was not said.
  const Tick newest = asking_since_ ? mission.timing.tick_count : tick_;
  // A command of no tick yet is the answer of an agent that knows no position.
  const bool somewhere = asking_since_ && command.header.tick >= 0;
  const bool outside = somewhere && !mission.domain.contains(command.position_m.head<2>());
  if (!step_m.allFinite() || command.header.tick > newest || outside) {
    ++refused_;
    return;
  }
  const auto newer_than = [&](const std::optional<Command>& known) {
    return !known || command.header.tick > known->header.tick;
  };
  const bool again = body.command && command.header.tick == body.answered();
  if (again && command.velocity_mps.isZero(0)) {
    body.command->velocity_mps.setZero();  // the one second thought that an agent may have
  } else if (newer_than(body.command)) {
    body.command_before = std::exchange(body.command, command);
  } else if (command.header.tick < body.answered() && newer_than(body.command_before)) {
    body.command_before = command;  // overtaken by the one after it
  }
}

bool World::everyone_answered() const {
  // With nobody left, the tick waits for a restarted agent or for the coordinator's patience.
  bool driven = false;
  for (const auto& [id, body] : bodies_) {
    if (body.author.incarnation == 0) continue;
    if (body.answered() != tick_) return false;
    driven = true;
  }
  return driven;
}

bool World::record_is_close(Instant now) {
  const Mission& mission = *follower_.mission();
  if (!mission.wait_for_logger || logger_lost_) return true;
  if (recorded_ && tick_ - *recorded_ <= kRecordWindowTicks) return true;
  // Half of it, so that the coordinator does not lose patience with the team first.
  logger_lost_ = now - record_progress_ > seconds(mission.timing.lockstep_timeout_s / 2);
  return logger_lost_;
}

bool World::record_complete() const { return recorded_ && *recorded_ + 1 >= tick_; }

void World::advance(Instant now, Outbox& out) {
  if (over_since_ && now - std::max(*over_since_, record_progress_) > kFarewell) {
    return finish(why_over());
  }
  if (finished_) return;
  if (!started_) return ask_for_mission(now, out);
  if (!over_since_ && must_be_over(follower_.mission()->timing, tick_, now - heard_)) {
    return finish("the mission must be over: no agent and no coordinator is heard");
  }
  if (asking_since_) ask_team(now, out);
  if (asking_since_) return;
  if (halted_ && !over_since_) return stand_still(now, out);
  if (follower_.mission()->timing.pace == Pace::kLockstep || over_since_) {
    advance_lockstep(now, out);
  } else {
    advance_realtime(now, out);
  }
}

void World::advance_lockstep(Instant now, Outbox& out) {
  const bool over = over_since_ || tick_ >= follower_.mission()->timing.tick_count;
  if (!published_) {
    if (!record_is_close(now)) {
      if (now >= next_publish_) repeat(now, out);
      return;
    }
    remember_and_publish(now, out);
  } else if (!over && everyone_answered()) {
    step(false);
    published_ = false;
    return advance_lockstep(now, out);
  } else if (now >= next_publish_) {
    repeat(now, out);
  }
  if (over && !over_since_) over_since_ = now;
}

void World::advance_realtime(Instant now, Outbox& out) {
  const Timing& timing = follower_.mission()->timing;
  const auto period = seconds(timing.dt_s / timing.realtime_factor);
  if (!published_) {
    if (!record_is_close(now)) {  // only before the first tick: the logger's first word
      next_tick_ = now + kRepeatPeriod;
      return;
    }
    remember_and_publish(now, out);
    next_tick_ = now + period;
  }
  const auto late = (now - next_tick_) / period;
  if (late > timing.catch_up_limit_ticks) {
    skipped_ticks_ += late - timing.catch_up_limit_ticks;
    next_tick_ += (late - timing.catch_up_limit_ticks) * period;
  }
  while (now >= next_tick_ && tick_ < timing.tick_count) {
    for (const auto& [id, body] : bodies_) {
      if (body.author.incarnation != 0 && body.answered() < tick_) ++missed_deadlines_;
    }
    step(true);
    remember_and_publish(now, out);
    next_tick_ += period;
  }
  if (tick_ >= timing.tick_count) over_since_ = now;
}

/// One more tick, in which nobody moves.
void World::stand_still(Instant now, Outbox& out) {
  if (!published_) remember_and_publish(now, out);  // where the last step led
  for (auto& [id, body] : bodies_) body.applied_mps.setZero();
  ++tick_;
  over_since_ = now;
  remember_and_publish(now, out);
}

std::string World::why_over() const {
  if (halted_) return *halted_;
  return follower_.over() ? follower_.reason() : "mission complete";
}

Eigen::Vector2d World::command_of(const Body& body, Tick tick, bool hold_old_commands) const {
  if (body.answered() < 0 || body.author.incarnation == 0) return {0, 0};
  const Timing& timing = follower_.mission()->timing;
  const double age_s = static_cast<double>(tick - body.answered()) * timing.dt_s;
  if (age_s > (hold_old_commands ? timing.command_hold_s : 0)) return {0, 0};
  return body.command->velocity_mps.head<2>();
}

void World::step(bool hold_old_commands) {
  for (auto& [id, body] : bodies_) {
    move(id, body, tick_, hold_old_commands);
    if (body.applied_mps != command_of(body, tick_, hold_old_commands)) ++clamped_commands_;
  }
  ++tick_;
}

void World::move(AgentId id, Body& body, Tick tick, bool hold_old_commands) const {
  const Mission& mission = *follower_.mission();
  body.applied_mps = within_speed_limit(mission, command_of(body, tick, hold_old_commands));
  body.x_m = reflect(moved(mission, id, tick, body.x_m, body.applied_mps), mission.domain);
}

std::vector<WorldState> World::snapshot() const {
  const auto parts = std::max<std::size_t>(
      1, (bodies_.size() + kMaxVehiclesPerState - 1) / kMaxVehiclesPerState);
  std::vector<WorldState> states(parts);
  std::size_t i = 0;
  for (const auto& [id, body] : bodies_) {
    WorldState& state = states[i++ / kMaxVehiclesPerState];
    Vehicle& vehicle = state.vehicles[static_cast<std::size_t>(state.vehicle_count++)];
    vehicle.id = id;
    vehicle.answered_tick = body.answered();
    vehicle.position_m << body.x_m, 0;
    vehicle.velocity_mps << body.applied_mps, 0;
  }
  for (std::size_t part = 0; part < parts; ++part) {
    states[part].part = static_cast<std::int32_t>(part);
    states[part].parts = static_cast<std::int32_t>(parts);
    states[part].missed_deadlines = missed_deadlines_;
    states[part].skipped_ticks = skipped_ticks_;
    states[part].clamped_commands = clamped_commands_;
    states[part].roster_revision = follower_.revision();
    states[part].header.tick = tick_;
  }
  return states;
}

void World::publish(const std::vector<WorldState>& states, Outbox& out) {
  for (WorldState state : states) {
    state.header = {run_, kWorld, incarnation_, sequencer_.next(Bus::kWorld), state.header.tick};
    out.push_back({Bus::kWorld, state});
  }
}

void World::repeat(Instant now, Outbox& out) {
  repeat_period_ = std::min(2 * repeat_period_, kLongestRepeatPeriod);
  next_publish_ = now + repeat_period_;
  if (published_) {
    // The same state, but who has answered, and who has joined, is news. Not so the roster that the
    // tick is flown by: that must be one for all agents, whichever repeat they hear.
    const std::int64_t flown_by = history_.back().front().roster_revision;
    history_.back() = snapshot();
    for (WorldState& part : history_.back()) part.roster_revision = flown_by;
    publish(history_.back(), out);
  } else if (!history_.empty()) {
    // The bodies have moved on already.
    for (WorldState& part : history_.back()) {
      for (int i = 0; i < part.vehicle_count; ++i) {
        Vehicle& vehicle = part.vehicles[static_cast<std::size_t>(i)];
        vehicle.answered_tick = bodies_.at(vehicle.id).answered();
      }
    }
    publish(history_.back(), out);
  }
  help_logger(out);
}

void World::remember_and_publish(Instant now, Outbox& out) {
  published_ = true;
  repeat_period_ = kRepeatPeriod;
  next_publish_ = now + repeat_period_;
  history_.push_back(snapshot());
  if (history_.size() > static_cast<std::size_t>(kRecordWindowTicks) + 2) history_.pop_front();
  publish(history_.back(), out);
}

void World::help_logger(Outbox& out) {
  if (!recorded_) return;
  for (const auto& states : history_) {
    const Tick tick = states.front().header.tick;
    if (tick > *recorded_ && tick <= *recorded_ + kHelpTicks && tick < tick_) publish(states, out);
  }
}

Instant World::next_wakeup() const {
  if (finished_) return Instant::max();
  if (!started_) return follower_.mission() || run_ == 0 ? Instant::max() : next_question_;
  if (asking_since_) return next_question_;
  if (over_since_) return next_publish_;
  return follower_.mission()->timing.pace == Pace::kLockstep ? next_publish_ : next_tick_;
}

void World::finish(std::string reason) {
  finished_ = true;
  reason_ = std::move(reason);
}

}  // namespace ergocast
