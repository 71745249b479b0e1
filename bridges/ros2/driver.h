// SPDX-License-Identifier: BSD-3-Clause
// The driver of one or several robots behind cmd_vel and odom. It takes the place of ergocast-sim.
// No clock, no I/O.
//
// Each robot's position is a part of WORLD_STATE of its own. So some robots may have their own
// bridge, and a robot whose position is not known makes the team stand after separation.lease_s.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bridges/ros2/robot.h"
#include "core/motion/separation.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast::ros2 {

class Driver {
 public:
  static constexpr Role kRole = Role::kDriver;

  /// @param run  0: the first mission received
  /// @param robots  by the agent whose body each is
  Driver(RunId run, Incarnation incarnation, std::map<AgentId, Robot> robots);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  /// @pre there is such a robot
  Robot& robot(AgentId id) { return slots_.at(id).robot; }

  /// All robots stand; after a last second the driver has finished.
  void stop(std::string reason);

  bool finished() const;
  bool failed() const { return failed_; }
  const std::string& reason() const { return reason_; }
  RunId run() const { return me_.run(); }
  Tick tick() const { return tick_; }
  const MissionFollower& follower() const { return me_.follower(); }
  std::int64_t missed_deadlines() const { return missed_deadlines_; }

 private:
  struct Answered {
    Tick tick;
    Instant arrived;
  };
  struct Slot {
    Robot robot;
    Author author{};                 ///< the agent that may command it; incarnation 0: none
    std::deque<Answered> answers{};  ///< the newest command last
    Eigen::Vector3d commanded_mps{0, 0, 0};

    Tick answered() const { return answers.empty() ? -1 : answers.back().tick; }
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // nothing follows from the other types
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const Command& command, const Arrival& arrival);
  void on(const Stop& over, const Arrival& arrival);
  void on(const WorldState& other, const Arrival& arrival);
  std::optional<std::string> why_not() const;
  std::optional<std::string> why_not(AgentId id, const Robot& robot) const;
  void take_roster();
  void take_zones();
  void begin(Tick tick, Instant now);
  void pass_tick(Instant now);
  static void order(Slot& slot, const Eigen::Vector3d& velocity_mps);
  void steer(AgentId id, Slot& slot, Instant now);
  void publish(Instant now, Outbox& out);
  WorldState state_of(AgentId id, const Slot& slot, const Fix& fix, Instant now) const;
  bool has_standing_robots() const;
  void fail(std::string reason);

  Participant me_;
  std::map<AgentId, Slot> slots_;
  std::optional<SeparationFilter> guard_;
  std::vector<Zone> zones_;
  bool running_ = false, published_ = false, stopped_ = false, failed_ = false;
  bool sends_until_it_stands_ = false;  // after a STOP at once
  int last_states_ = 5;                 // to send once all stand, because some may be lost
  std::string reason_;
  Tick tick_ = 0;
  Instant next_tick_{}, begun_{};
  std::int64_t missed_deadlines_ = 0, clamped_commands_ = 0, skipped_ticks_ = 0;
};

}  // namespace ergocast::ros2
