// SPDX-License-Identifier: BSD-3-Clause
// The simulated world: collects commands, lets the vehicles of fleet.h move, publishes states,
// keeps the tick.
//
// In lockstep a tick is repeated until every member of the roster has answered it. The world runs a
// bounded number of ticks ahead of the record. In real time it follows the clock.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "sim/fleet.h"
#include "sim/physics.h"
#include "sim/record_window.h"
#include "sim/tick_schedule.h"
#include "team/messages.h"
#include "team/participant.h"
#include "team/state_assembler.h"

namespace ergocast {

class World {
 public:
  static constexpr Role kRole = Role::kWorld;

  /// @param physics  what moves the bodies; without it core/motion/vehicle.h does
  World(RunId run, Incarnation incarnation, PhysicsMaker physics = {});

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  /// Ends at once, as when its process gets a signal. After a STOP with `now` the world first sends
  /// a state in which all vehicles stand still, until this is recorded or 2 s have passed.
  void stop(std::string reason) { finish(std::move(reason)); }
  /// Ends at once and counts as failed(): it cannot take part, for a reason outside of it.
  void fail(std::string reason) {
    failed_ = true;
    finish(std::move(reason));
  }
  /// Until `earliest` it moves nothing, and only asks the team.
  void begin_not_before(Instant earliest) { question_.earliest_end = earliest; }

  bool finished() const { return finished_; }
  /// Whether it has finished because it cannot take part at all.
  bool failed() const { return follower().plan_problem().has_value() || failed_; }
  RunId run() const { return me_.run(); }
  Incarnation incarnation() const { return me_.incarnation(); }
  const std::string& reason() const { return reason_; }
  const MissionFollower& follower() const { return me_.follower(); }
  Tick tick() const { return tick_; }
  /// The newest tick that an agent has answered. −1 if agents have answered none yet; nothing while
  /// no agent has reported to it.
  std::optional<Tick> newest_answer() const { return fleet_.newest_answer(); }
  /// The tick from which it goes on, once it moves; above 0 if another world began the mission.
  std::optional<Tick> begun_at() const { return begun_at_; }
  /// Real time: commands that were not there when their tick was over.
  std::int64_t missed_deadlines() const { return missed_deadlines_; }
  /// Real time: ticks that were dropped because the process had been held up for too long.
  std::int64_t skipped_ticks() const { return skipped_ticks_; }
  /// Steps of a vehicle that the speed limit made slower than its command.
  std::int64_t clamped_commands() const { return fleet_.clamped_commands(); }
  /// Messages that came through the wire's checks and had no effect because they cannot be true.
  std::int64_t refused() const { return me_.refused(Refusal::kRange); }
  /// The operator's commands that were refused because their ticks are old.
  std::int64_t late_commands() const { return me_.refused(Refusal::kLate); }
  /// The summary of the physics; empty without one.
  std::string physics_summary() const { return fleet_.physics_summary(); }
  /// True once a silent logger has been given up.
  bool logger_lost() const { return record_.lost(); }

 private:
  /// How it finds out at its beginning where the team is.
  struct Question {
    std::optional<Instant> since;  // while it asks
    Instant next{};
    Instant earliest_end{};  // it asks at least until then
    StateAssembler before;   // of the last state of a world before us
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // the other types need no action
  void on(const Command& command, const Arrival& arrival);
  void on(const WorldState& before, const Arrival& arrival);
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const RecordAck& ack, const Arrival& arrival);
  void on(const Stop& stop, const Arrival& arrival);
  const Mission& mission() const { return me_.mission(); }
  void take_roster();
  void start(Instant now);
  void ask_for_mission(Instant now, Outbox& out);
  void ask_team(Instant now, Outbox& out);
  void ask(Tick known, AgentId whom, Outbox& out);
  void begin(Instant now);
  Surroundings surroundings() const;
  bool knows_bodies() const;
  bool is_possible(const Command& command) const;
  bool stands_by() const;
  void note_found(std::vector<WorldState>& states);
  bool waits_for_time(Instant now) const;
  bool record_is_close(Instant now);
  void advance_lockstep(Instant now, Outbox& out);
  void advance_realtime(Instant now, Outbox& out);
  void step();
  std::vector<WorldState> snapshot();
  void publish(const std::vector<WorldState>& states, Outbox& out);
  void remember_and_publish(Instant now, Outbox& out);
  void repeat(Instant now, Outbox& out);
  void send_zero_velocity(Instant now, Outbox& out);
  std::string why_over() const;
  void finish(std::string reason);
  void publish_final_state(Outbox& out);

  Participant me_;
  bool started_ = false, finished_ = false, failed_ = false, final_state_due_ = false;
  std::string reason_;
  Tick tick_ = 0;
  Fleet fleet_;
  ObjectSet found_ = 0;  // by the newest tick, without finds in pauses
  Question question_;
  std::optional<Tick> begun_at_;
  TickSchedule schedule_;
  std::optional<Instant> over_since_;             // no vehicle moves any more
  std::optional<std::string> emergency_stopped_;  // the reason of a STOP with `now`
  RecordWindow record_;
  std::int64_t missed_deadlines_ = 0, skipped_ticks_ = 0;
};

}  // namespace ergocast
