// SPDX-License-Identifier: BSD-3-Clause
// The driver of one or several robots behind cmd_vel and odom. It takes the place of ergocast-sim.
// No clock, no I/O.
//
// Each robot's position is a part of WORLD_STATE of its own. So some robots may have their own
// bridge, and a robot whose position is not known makes the team stand after separation.lease_s.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "bridges/ros2/robot.h"
#include "team/robot_driver.h"

namespace ergocast::ros2 {

class Driver final : public RobotDriver {
 public:
  /// @param run  0: the first mission received
  /// @param robots  by the agent whose body each is; at least one
  Driver(RunId run, Incarnation incarnation, std::map<AgentId, Robot> robots);

  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  /// @pre there is such a robot
  Robot& robot(AgentId id) { return robots_.at(id); }

 private:
  std::optional<std::string> why_not(const Mission& mission) const override;
  void begin(const Mission& mission) override;
  std::optional<RobotFix> fix_of(AgentId id, Instant now) const override;
  void go(AgentId id, const Eigen::Vector3d& velocity_mps) override {
    robots_.at(id).go(velocity_mps);
  }
  void finish() override;
  bool have_stopped() const override;

  std::map<AgentId, Robot> robots_;
};

}  // namespace ergocast::ros2
