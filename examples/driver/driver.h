// SPDX-License-Identifier: BSD-3-Clause
// A driver replaces the simulated world: it sends the robots' positions and makes them execute the
// agents' commands. Copy this folder and replace robot.h; the rest may stay.
//
// One driver can drive all robots, with motion capture or a gateway that collects their positions.
// Or each robot has its own driver, which knows only that robot's position. A restarted driver
// continues at the tick that the coordinator names.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/base/ids.h"
#include "examples/driver/robot.h"
#include "team/robot_driver.h"

namespace ergocast::example {

class Driver final : public RobotDriver {
 public:
  /// @param run              0: the first mission received
  /// @param speed_limit_mps  of the robots
  /// @param only  the one robot that it drives; nullopt: all
  Driver(RunId run, Incarnation incarnation, double speed_limit_mps,
         std::optional<AgentId> only = {});

  const Robot& robot(AgentId id) const { return robots_.at(id); }

 private:
  std::optional<std::string> why_not(const Mission& mission) const override;
  void join(const Mission& mission, AgentId id) override;
  void begin(const Mission& mission) override;
  std::optional<RobotFix> fix_of(AgentId id, Instant now) const override;
  void go(AgentId id, const Eigen::Vector3d& velocity_mps) override;
  void move(const Mission& mission) override;

  double speed_limit_mps_;
  std::optional<AgentId> only_;
  std::map<AgentId, Robot> robots_;
};

}  // namespace ergocast::example
