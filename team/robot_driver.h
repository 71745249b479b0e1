// SPDX-License-Identifier: BSD-3-Clause
// The team's side of a driver of robots, which takes the place of the simulated world. A driver is
// a class that derives from RobotDriver and knows its robots.
//
//   MISSION      → the robots that take part, the tick's length, the mission's end
//   WORLD_STATE  ← every dt: the tick, and the robots' positions, as far as they are known
//   COMMAND_<id> → a velocity for one robot; it is held for `command_hold_s`, then the robot stops
//
// A state says which command it answers. Agents conclude that its position was measured after that
// command had been sent. So the state names the newest command that had arrived when the position
// was measured.
//
// Speed limits, walls and zones shorten commands here. Other robots are the agents' task, except
// for a driver of all robots: it also keeps the robots apart if the mission has a guard.
//
// No socket, thread or clock.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/motion/separation.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

/// Where a robot is, in the mission's frame.
struct RobotFix {
  Eigen::Vector3d position_m{0, 0, 0}, velocity_mps{0, 0, 0};
  Instant not_before{};  ///< it was measured then or later
  bool stands = false;   ///< its velocity is only noise
  std::int32_t charge_ppm = kNoCharge;
};

class RobotDriver {
 public:
  static constexpr Role kRole = Role::kDriver;

  /// @param run     0: the first mission received
  /// @param robots  the agents whose robots these are; empty: one driver has all robots. A driver
  ///                of some robots listens for a second for another driver of them.
  RobotDriver(RunId run, Incarnation incarnation, const std::vector<AgentId>& robots);
  virtual ~RobotDriver() = default;

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const { return ticks() ? next_tick_ : Instant::max(); }

  /// All robots stop; finished() follows. After a STOP at once, states are sent until they stand.
  void stop(std::string reason);
  bool finished() const { return stopped_ && have_stopped() && last_states_ <= 0; }
  bool failed() const { return failed_; }
  const std::string& reason() const { return reason_; }

  RunId run() const { return me_.run(); }
  Tick tick() const { return tick_; }
  const MissionFollower& follower() const { return me_.follower(); }
  /// Ticks in which a robot had no command in time, summed over robots.
  std::int64_t missed_deadlines() const { return missed_deadlines_; }
  /// Commands that were faster than the scenario's speed limit.
  std::int64_t clamped_commands() const { return clamped_commands_; }

 protected:
  RobotDriver(RobotDriver&&) = default;

  // ---- what each kind of robots does in its own way ----
  /// Why the robots cannot take part in a mission, with the remedy.
  virtual std::optional<std::string> why_not(const Mission& mission) const = 0;
  /// A member of a driver of all robots gets its robot; its incarnation may change later.
  virtual void join(const Mission&, AgentId) {}
  /// The mission runs.
  virtual void begin(const Mission&) {}
  /// The newest position, if it can be trusted. Without one the robot is ordered to stop.
  virtual std::optional<RobotFix> fix_of(AgentId robot, Instant now) const = 0;
  /// The velocity to drive at from now on; zero: stop.
  virtual void go(AgentId robot, const Eigen::Vector3d& velocity_mps) = 0;
  /// A tick has passed. A simulated robot moves here.
  virtual void move(const Mission&) {}
  /// No command will follow.
  virtual void finish() {}
  /// Whether all robots stand, or need no more time to stop, after finish().
  virtual bool have_stopped() const { return true; }

  /// Whether only the commanded direction is safe, because of walls, zones or other robots.
  bool is_exact() const;
  /// Stops because of a fault.
  void fail(std::string reason);

 private:
  struct Answered {
    Tick tick;
    Instant arrived;
  };
  struct Slot {
    Author author{};                 // the agent that may command it; incarnation 0: none
    std::deque<Answered> answers{};  // the newest command last
    Eigen::Vector3d commanded_mps{0, 0, 0};

    Tick answered() const { return answers.empty() ? -1 : answers.back().tick; }
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // nothing follows from the other types
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const Command& command, const Arrival& arrival);
  void on(const Stop& over, const Arrival& arrival);
  void on(const WorldState& other, const Arrival& arrival);
  std::optional<std::string> why_not_any(const Mission& mission) const;
  bool ticks() const { return running_ && (!stopped_ || last_states_ > 0); }
  bool sees_all() const { return has_all_ && guard_; }
  void catch_up(Tick team_tick);
  void take_roster();
  void take_zones();
  void begin_mission(Tick tick, Instant now);
  void pass_tick(Instant now);
  void stop_all();
  void order(AgentId id, Slot& slot, const Eigen::Vector3d& velocity_mps);
  void steer(AgentId id, const Slot& slot, std::span<const Neighbour> bodies, Instant now);
  std::vector<Neighbour> bodies(Instant now) const;
  void publish(Instant now, Outbox& out);
  WorldState empty_state() const;
  void add(AgentId id, const Slot& slot, const RobotFix& fix, WorldState& state) const;

  Participant me_;
  bool has_all_;
  std::map<AgentId, Slot> slots_;
  std::optional<SeparationFilter> guard_;
  std::vector<Zone> zones_;
  bool running_ = false, published_ = false, stopped_ = false, failed_ = false;
  int last_states_ = 0;  // to send after a STOP at once, when all stand
  std::string reason_;
  Tick tick_ = 0;
  Instant next_tick_{}, begun_{};
  std::int64_t missed_deadlines_ = 0, clamped_commands_ = 0, skipped_ticks_ = 0;
};

}  // namespace ergocast
