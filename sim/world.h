// The simulated world: integrates commands, reflects at the edge, publishes states, keeps the tick.
//
//   x_{n+1} = reflect(x_n + v_n dt + σ_w √dt ξ),  ξ: the actuation disturbance, off by default.
//   v_n is the command, or what the scenario's speed limit leaves of it.
//
// In lockstep a tick is repeated until every member of the roster has answered it, and the world
// runs a bounded number of ticks ahead of the record. In real time it goes by the clock.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "team/freshness.h"
#include "core/ids.h"
#include "team/messages.h"
#include "team/mission_follower.h"

namespace ergocast {

class World {
 public:
  World(RunId run, Incarnation incarnation);

  void receive(const Message& message, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  /// Ends at once, as when its process is told to stop. A STOP at once it does not end by, but by
  /// saying where everybody stands still, until that is recorded or a moment has passed.
  void stop(std::string reason) { finish(std::move(reason)); }

  bool finished() const { return finished_; }
  /// Whether it has finished because it cannot take part at all.
  bool failed() const { return follower_.plan_problem().has_value(); }
  RunId run() const { return run_; }
  const std::string& reason() const { return reason_; }
  const MissionFollower& follower() const { return follower_; }
  Tick tick() const { return tick_; }
  /// The tick from which it goes on, once it moves; above 0 if another world began the mission.
  std::optional<Tick> begun_at() const { return begun_at_; }
  /// Real time: commands that were not there when their tick was over.
  std::int64_t missed_deadlines() const { return missed_deadlines_; }
  /// Real time: ticks that were dropped because the process had been held up for too long.
  std::int64_t skipped_ticks() const { return skipped_ticks_; }
  /// Steps of a vehicle that the speed limit made slower than its command.
  std::int64_t clamped_commands() const { return clamped_commands_; }
  /// Messages that came through the wire's checks and had no effect because they cannot be true.
  std::int64_t refused() const { return refused_; }
  /// True once a silent logger has been given up.
  bool logger_lost() const { return logger_lost_; }

 private:
  struct Body {
    Author author;
    Eigen::Vector2d x_m{0, 0};
    Eigen::Vector2d applied_mps{0, 0};
    std::optional<Command> command, command_before;
    Tick answered() const { return command ? command->header.tick : -1; }
  };

  void on(const Command& command);
  void note_heard(const Message& message, Instant now);
  void take_roster();
  void start(Instant now);
  void ask_for_mission(Instant now, Outbox& out);
  void ask_team(Instant now, Outbox& out);
  void ask(Tick known, Outbox& out);
  bool team_has_answered() const;
  void begin(Instant now);
  void recall(AgentId id, Body& body);
  void move(AgentId id, Body& body, Tick tick, bool hold_old_commands) const;
  bool everyone_answered() const;
  bool record_is_close(Instant now);
  bool record_complete() const;
  void advance_lockstep(Instant now, Outbox& out);
  void advance_realtime(Instant now, Outbox& out);
  void step(bool hold_old_commands);
  Eigen::Vector2d command_of(const Body& body, Tick tick, bool hold_old_commands) const;
  std::vector<WorldState> snapshot() const;
  void publish(const std::vector<WorldState>& states, Outbox& out);
  void remember_and_publish(Instant now, Outbox& out);
  void repeat(Instant now, Outbox& out);
  void help_logger(Outbox& out);
  void on(const Stop& stop);
  void stand_still(Instant now, Outbox& out);
  std::string why_over() const;
  void finish(std::string reason);

  RunId run_;
  Incarnation incarnation_;
  MissionFollower follower_;
  Sequencer sequencer_;
  bool started_ = false, finished_ = false;
  std::string reason_;
  Tick tick_ = 0;
  std::map<AgentId, Body> bodies_;

  std::optional<Instant> asking_since_;  // where the team was
  Instant next_question_{};
  std::optional<Tick> begun_at_;

  Instant next_publish_{};
  std::chrono::nanoseconds repeat_period_{};
  Instant next_tick_{};
  bool published_ = false;
  std::optional<Instant> over_since_;  // nobody moves any more
  std::optional<std::string> halted_;  // by a STOP at once: why

  std::optional<Tick> recorded_;  // what the logger has acknowledged
  Incarnation logger_ = 0;
  Instant record_progress_{};
  bool logger_lost_ = false;
  Freshness freshness_;
  Instant heard_{};  // when an agent or the coordinator last said something new
  std::deque<std::vector<WorldState>> history_;  // states of the last ticks, for the logger

  std::int64_t missed_deadlines_ = 0, skipped_ticks_ = 0, clamped_commands_ = 0, refused_ = 0;
};

}  // namespace ergocast
