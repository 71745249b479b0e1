// SPDX-License-Identifier: BSD-3-Clause
// The file of ergocast-ros2 (bridge.proto), checked: frames, robots and displays.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/ros2/positions.h"
#include "bridges/ros2/steering.h"
#include "core/base/ids.h"
#include "core/base/result.h"

namespace ergocast::ros2 {

/// Limit (ROS 2): length of a bridge's file [bytes]. Beyond it: ergocast-ros2 refuses it.
inline constexpr std::size_t kMostFileBytes = std::size_t{1} << 18;

struct RobotTopics {
  std::string cmd_vel;
  std::string position;          ///< odom or pose
  bool has_odometry = true;      ///< nav_msgs/Odometry; else geometry_msgs/PoseStamped
  bool stamped_command = false;  ///< geometry_msgs/TwistStamped
  bool reliable = false;         ///< what the bridge requests of the position's publisher
};

struct BridgedRobot {
  AgentId id = 0;
  RobotTopics topics;
  FrameOrigin frame;
  std::string base_frame;
  DriveLimits limits;
};

struct DisplayTopics {
  std::string prefix;  ///< "ergocast": topics are ergocast/coverage, …
  FrameOrigin frame;   ///< without a turn
};

struct BridgeFile {
  std::optional<int> domain_id;
  std::vector<BridgedRobot> robots;  ///< ascending by id
  std::optional<DisplayTopics> display;
};

/// The name without a leading slash; nothing if ROS 2 has no such topics.
std::optional<std::string> topic_named(std::string name);
/// Why it is none.
std::string no_topic(const std::string& name);

/// Reads the file. An error is "FILE:LINE: FIELD: PROBLEM; REMEDY".
Result<BridgeFile> read_bridge_file(const std::filesystem::path& file);
/// The same of its text.
Result<BridgeFile> parse_bridge_file(std::string_view text, const std::string& name);

}  // namespace ergocast::ros2
