// SPDX-License-Identifier: BSD-3-Clause
// The simulated world: integrates commands, reflects at the edge, publishes states, keeps the tick.
//
//   x_{n+1} = reflect(x_n + v_n dt + σ_w √dt ξ),  ξ: the actuation disturbance, off by default.
//   v_n is the command, cut to the vehicle's speed limit. Where bodies keep a distance, a world in
//   real time then filters all commands together (core/motion/separation.h). Old and late commands
//   do not account for where the others have gone. Where there are walls, a world always filters,
//   and the walls stop ξ. A physics may move the bodies instead (physics.h), and x_{n+1} is its
//   result.
//
// In lockstep a tick is repeated until every member of the roster has answered it. The world runs a
// bounded number of ticks ahead of the record. In real time it follows the clock.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/motion/separation.h"
#include "sim/physics.h"
#include "sim/record_window.h"
#include "team/bodies.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

class World {
 public:
  static constexpr Role kRole = Role::kWorld;

  /// @param physics  what moves the bodies; without it core/motion/vehicle.h does
  World(RunId run, Incarnation incarnation, PhysicsMaker physics = {});

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  /// Ends at once, as when its process gets a signal. A STOP with `now` does not end it at once. It
  /// sends a state in which all vehicles stand still, until that is recorded or 2 s have passed.
  void stop(std::string reason) { finish(std::move(reason)); }
  /// Ends at once and counts as failed(): it cannot take part, for a reason outside of it.
  void fail(std::string reason) {
    refused_ = true;
    finish(std::move(reason));
  }
  /// Until `earliest` it moves nothing, and only asks the team.
  void begin_not_before(Instant earliest) { earliest_begin_ = earliest; }

  bool finished() const { return finished_; }
  /// Whether it has finished because it cannot take part at all.
  bool failed() const { return follower().plan_problem().has_value() || no_physics_ || refused_; }
  RunId run() const { return me_.run(); }
  Incarnation incarnation() const { return me_.incarnation(); }
  const std::string& reason() const { return reason_; }
  const MissionFollower& follower() const { return me_.follower(); }
  Tick tick() const { return tick_; }
  /// The newest tick that an agent has answered. −1 if agents have answered none yet; nothing while
  /// no agent has reported to it.
  std::optional<Tick> newest_answer() const;
  /// The tick from which it goes on, once it moves; above 0 if another world began the mission.
  std::optional<Tick> begun_at() const { return begun_at_; }
  /// Real time: commands that were not there when their tick was over.
  std::int64_t missed_deadlines() const { return counted_.missed_deadlines; }
  /// Real time: ticks that were dropped because the process had been held up for too long.
  std::int64_t skipped_ticks() const { return counted_.skipped_ticks; }
  /// Steps of a vehicle that the speed limit made slower than its command.
  std::int64_t clamped_commands() const { return counted_.clamped_commands; }
  /// Messages that came through the wire's checks and had no effect because they cannot be true.
  std::int64_t refused() const { return me_.refused(Refusal::kRange); }
  /// The operator's commands that were refused because their ticks are old.
  std::int64_t late_commands() const { return me_.refused(Refusal::kLate); }
  /// The summary of the physics; empty without one.
  std::string physics_summary() const { return physics_ ? physics_->summary() : ""; }
  /// True once a silent logger has been given up.
  bool logger_lost() const { return record_.lost(); }

 private:
  struct VehicleSlot {
    Author author;
    Eigen::Vector3d x_m{0, 0, 0};
    Eigen::Vector3d applied_mps{0, 0, 0};  // in the step that led here; with inertia, at its end
    Eigen::Vector3d next_mps{0, 0, 0};     // in the step that follows
    std::optional<Command> command, command_before;
    bool placed = true;  // false: x_m is not known yet
    Tick answered() const { return command ? command->header.tick : -1; }
  };

  /// How it finds out at its beginning where the team is.
  struct Question {
    std::optional<Instant> since;  // while it asks
    Instant next{};
    Bodies before;  // of the last state of a world before us
  };
  /// When to publish or step next.
  struct Schedule {
    Instant next_publish{};
    std::chrono::nanoseconds repeat_period{};
    Instant next_tick{};
    Instant held_until{};    // lockstep: a held tick lasts so long
    bool published = false;  // whether tick_ was
  };
  struct Counted {
    std::int64_t missed_deadlines = 0, skipped_ticks = 0, clamped_commands = 0;
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
  AgentId first_unheard() const;
  void begin(Instant now);
  void recall(AgentId id, VehicleSlot& slot);
  bool knows_bodies() const;
  void settle();
  Eigen::Vector3d place_for(AgentId id) const;
  void place(AgentId id, VehicleSlot& slot, const Eigen::Vector3d& x_m) const;
  bool keeps_distance() const { return mission().separation.distance_m > 0; }
  /// Whether it begins from a state of all bodies, because their commands alone do not determine
  /// their motion.
  bool begins_by_state() const { return keeps_distance() || !mission().walls.empty(); }
  void drive(AgentId id, VehicleSlot& slot, Tick tick, bool hold_old_commands) const;
  void move(AgentId id, VehicleSlot& slot, Tick tick) const;
  bool make_physics();
  void place_bodies();
  void move_bodies();
  void filter_commands();
  void keep_from_walls(AgentId id, VehicleSlot& slot, Tick tick);
  bool everyone_answered() const;
  bool stands_by() const;
  bool waits_for_time(Instant now) const;
  bool record_is_close(Instant now);
  void advance_lockstep(Instant now, Outbox& out);
  void advance_realtime(Instant now, Outbox& out);
  void step(bool hold_old_commands);
  bool driven(const VehicleSlot& slot, Tick tick, bool hold_old_commands) const;
  Eigen::Vector3d command_of(const VehicleSlot& slot, Tick tick, bool hold_old_commands) const;
  std::vector<WorldState> snapshot() const;
  void publish(const std::vector<WorldState>& states, Outbox& out);
  void remember_and_publish(Instant now, Outbox& out);
  void repeat(Instant now, Outbox& out);
  void send_zero_velocity(Instant now, Outbox& out);
  std::string why_over() const;
  void finish(std::string reason);
  void publish_final_state(Outbox& out);

  Participant me_;
  bool started_ = false, finished_ = false, final_state_due_ = false;
  std::string reason_;
  Tick tick_ = 0;
  std::map<AgentId, VehicleSlot> vehicles_;
  Question question_;
  std::optional<Tick> begun_at_;
  Instant earliest_begin_{};
  Schedule schedule_;
  std::optional<Instant> over_since_;             // no vehicle moves any more
  std::optional<std::string> emergency_stopped_;  // the reason of a STOP with `now`
  RecordWindow record_;
  Counted counted_;
  std::optional<SeparationFilter> filter_;  // if it guards, has walls, or a body is no point
  std::vector<Neighbour> bodies_;           // of the tick, for the guard
  PhysicsMaker physics_maker_;
  std::unique_ptr<Physics> physics_;  // null: core/motion/vehicle.h
  std::vector<PhysicalBody> moved_;
  bool no_physics_ = false;  // the maker has none for this mission
  bool refused_ = false;     // by fail()
};

}  // namespace ergocast
