// SPDX-License-Identifier: BSD-3-Clause
// A driver replaces the simulated world: it sends the robots' positions and makes them execute the
// agents' commands. Copy this folder and replace robot.h; the rest may stay.
//
//   MISSION     → the robots that take part, the tick's length, the mission's end
//   WORLD_STATE ← every dt: the tick, and each robot's position
//   COMMAND_<id> → a velocity for one robot; it is held for `command_hold_s`, then the robot stops
//
// One driver can drive all robots, with motion capture or a gateway that collects their positions.
// Or each robot has its own driver, which knows only that robot's position. A restarted driver
// continues at the tick that the coordinator names.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/base/ids.h"
#include "core/motion/separation.h"
#include "examples/driver/robot.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast::example {

class Driver {
 public:
  static constexpr Role kRole = Role::kDriver;

  /// @param run              0: the first mission received
  /// @param speed_limit_mps  of the robots
  /// @param only  the one robot that it drives; nullopt: all
  Driver(RunId run, Incarnation incarnation, double speed_limit_mps,
         std::optional<AgentId> only = {});

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const { return running_ && !finished_ ? next_tick_ : Instant::max(); }

  /// Stops all robots and ends.
  void stop(std::string reason);

  bool finished() const { return finished_; }
  bool failed() const { return failed_; }
  const std::string& reason() const { return reason_; }
  RunId run() const { return me_.run(); }
  Tick tick() const { return tick_; }
  /// Ticks in which a robot had no command in time, summed over robots.
  std::int64_t missed_deadlines() const { return missed_deadlines_; }
  /// Commands that were faster than the scenario's speed limit.
  std::int64_t clamped_commands() const { return clamped_commands_; }
  const MissionFollower& follower() const { return me_.follower(); }
  const Robot& robot(AgentId id) const { return drives_.at(id).robot; }

 private:
  struct VehicleSlot {
    Author author;  ///< the agent that may command this robot; incarnation 0: none
    Robot robot;
    Tick answered = -1;  ///< newest tick that a command was for
    Eigen::Vector3d commanded_mps{0, 0, 0};
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // nothing follows from the other types
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const Command& command, const Arrival& arrival);
  void on(const Stop& over, const Arrival& arrival);
  void on(const WorldState& other, const Arrival& arrival);
  std::optional<std::string> why_not() const;
  void catch_up(Tick team_tick);
  void take_roster();
  void take_zones();
  void pass_tick();
  void hold_apart();
  static bool has_vehicles_for(const Mission& mission);
  static bool drives_unicycle(const Motion& motion) {
    return motion.vehicle.kind == VehicleKind::kUnicycle;
  }
  void publish_position(Outbox& out);

  Participant me_;
  double speed_limit_mps_;
  std::optional<AgentId> only_;
  std::map<AgentId, VehicleSlot> drives_;
  std::optional<SeparationFilter> guard_;
  std::vector<Zone> zones_;
  bool running_ = false, published_ = false, finished_ = false, failed_ = false;
  bool emergency_stopped_ = false;  // by a STOP at once; the last state must still be sent
  std::string reason_;
  Tick tick_ = 0;
  Instant next_tick_{}, begun_{};
  std::int64_t missed_deadlines_ = 0, clamped_commands_ = 0, skipped_ticks_ = 0;
};

}  // namespace ergocast::example
