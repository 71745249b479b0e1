// SPDX-License-Identifier: BSD-3-Clause
// cmd_vel and odom (or pose) of one robot.
#pragma once

#include <string>

#include "bridges/ros2/bridge_file.h"
#include "bridges/ros2/dds_node.h"
#include "bridges/ros2/robot.h"

namespace ergocast::ros2 {

class RobotConnection {
 public:
  static Result<RobotConnection> make(DdsNode& node, const BridgedRobot& robot);

  /// Passes on what has arrived. @param robot  the one that was given to make()
  void receive(Robot& robot, const Moment& at);
  void send(const BodyVelocity& velocity, std::int64_t wall_ns);
  /// Compares the topics with the other programs' sides. @return a warning, or nothing
  std::optional<std::string> examine(Robot& robot);

 private:
  RobotConnection(const BridgedRobot& robot, Writer cmd_vel, Reader position)
      : topics_(robot.topics),
        base_frame_(robot.base_frame),
        cmd_vel_(std::move(cmd_vel)),
        position_(std::move(position)) {}

  RobotTopics topics_;
  std::string base_frame_;
  Writer cmd_vel_;
  Reader position_;
  bool has_rival_ = false;
};

}  // namespace ergocast::ros2
