// SPDX-License-Identifier: BSD-3-Clause
// The driver of one vehicle: what RobotDriver says of a robot, for a vehicle with an autopilot.
#pragma once

#include <ergocast/team/messages.h>
#include <ergocast/team/robot_driver.h>

#include <optional>
#include <string>
#include <vector>

#include "bridges/mavlink/vehicle.h"

namespace ergocast::mavlink {

class Driver final : public RobotDriver {
 public:
  /// @param run  0: the first mission received
  /// @param id   the agent whose vehicle it is
  Driver(RunId run, Incarnation incarnation, AgentId id, const VehicleOptions& options);

  using RobotDriver::receive;
  void receive(const Received& received, Instant now) { vehicle_.receive(received, now); }
  /// @param out         for the team
  /// @param to_vehicle  for the autopilot, from source()
  void advance(Instant now, Outbox& out, std::vector<Packet>& to_vehicle);
  Instant next_wakeup() const {
    return std::min(RobotDriver::next_wakeup(), vehicle_.next_wakeup());
  }

  Source source() const { return vehicle_.source(); }
  std::vector<Note> take_notes() { return vehicle_.take_notes(); }

 private:
  std::optional<std::string> why_not(const Mission& mission) const override;
  void begin(const Mission& mission) override;
  std::optional<RobotFix> fix_of(AgentId id, Instant now) const override;
  void go(AgentId, const Eigen::Vector3d& velocity_mps) override { vehicle_.fly(velocity_mps); }
  void finish() override { vehicle_.finish(); }
  bool have_stopped() const override { return vehicle_.done(); }

  AgentId id_;
  Vehicle vehicle_;
};

}  // namespace ergocast::mavlink
