// SPDX-License-Identifier: BSD-3-Clause
// The team's side of the driver: it sends the vehicle's position at each tick, and gives the
// vehicle its agent's commands.
//
//   MISSION      → whether it takes part, the tick's length, the end
//   WORLD_STATE  ← every dt: the tick and the position, while there is one that can be trusted
//   COMMAND_<id> → a velocity; it is held for `command_hold_s`, then the vehicle stands
//
// A state says which command it answers. Agents conclude that its position was measured after that
// command had been sent. So the state names the newest command that had arrived when the autopilot
// measured the position, by the bound of clock_bond.h.
#pragma once

#include <ergocast/core/motion/separation.h>
#include <ergocast/team/messages.h>
#include <ergocast/team/participant.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "bridges/mavlink/vehicle.h"

namespace ergocast::mavlink {

class Driver {
 public:
  static constexpr Role kRole = Role::kDriver;

  /// @param run  0: the first mission received
  /// @param id   the agent whose vehicle it is
  Driver(RunId run, Incarnation incarnation, AgentId id, const VehicleOptions& options);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void receive(const Received& received, Instant now) { vehicle_.receive(received, now); }
  /// @param out         for the team
  /// @param to_vehicle  for the autopilot, from source()
  void advance(Instant now, Outbox& out, std::vector<Packet>& to_vehicle);
  Instant next_wakeup() const;

  /// The vehicle stands; after a last second the driver has finished.
  void stop(std::string reason);

  bool finished() const {
    return stopped_ && vehicle_.done() && (!tells_until_it_stands_ || last_states_ <= 0);
  }
  bool failed() const { return failed_; }
  const std::string& reason() const { return reason_; }
  RunId run() const { return me_.run(); }
  Tick tick() const { return tick_; }
  Source source() const { return vehicle_.source(); }
  std::vector<Note> take_notes() { return vehicle_.take_notes(); }
  std::int64_t missed_deadlines() const { return missed_deadlines_; }

 private:
  template <class M>
  void on(const M&, const Arrival&) {}
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const Command& command, const Arrival& arrival);
  void on(const Stop& over, const Arrival& arrival);
  void on(const WorldState& other, const Arrival& arrival);
  std::optional<std::string> why_not() const;
  void take_roster();
  void take_zones();
  void begin(Tick tick, Instant now);
  void pass_tick(Instant now);
  void order(const Eigen::Vector3d& velocity_mps);
  void steer(Instant now);
  void publish(Instant now, Outbox& out);
  Tick answered_at(Instant moment) const;
  void fail(std::string reason);

  Participant me_;
  AgentId id_;
  Vehicle vehicle_;
  Author author_;  // the agent that may command the vehicle; incarnation 0: none
  std::optional<SeparationFilter> guard_;
  std::vector<Zone> zones_;
  struct Answered {
    Tick tick;
    Instant arrived;
  };
  std::deque<Answered> answers_;  // the newest command last
  Eigen::Vector3d commanded_mps_{0, 0, 0};
  bool running_ = false, published_ = false, stopped_ = false, failed_ = false;
  bool tells_until_it_stands_ = false;  // after a STOP at once
  int last_states_ = 5;                 // to send once it stands, because some may be lost
  std::string reason_;
  Tick tick_ = 0;
  Instant next_tick_{}, begun_{};
  std::int64_t missed_deadlines_ = 0, clamped_commands_ = 0, skipped_ticks_ = 0;
};

}  // namespace ergocast::mavlink
