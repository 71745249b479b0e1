// SPDX-License-Identifier: BSD-3-Clause
// The topics of a mock robot, on either implementation of DDS.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace ergocast::test {

struct PortOptions {
  std::string name = "robot0";    ///< topics are name/cmd_vel and name/odom or name/pose
  bool stamped = false;           ///< cmd_vel is a TwistStamped
  bool pose = false;              ///< publishes a PoseStamped on name/pose
  std::string position_topic{};   ///< another topic for it
  bool latched_commands = false;  ///< requests transient local for cmd_vel
  bool best_effort = false;       ///< offers best effort for its position
};

/// Twist: ahead, to the left [m/s], counter-clockwise [rad/s].
using TwistNumbers = std::array<double, 3>;

struct PositionNumbers {
  std::int64_t stamp_ns = 0;
  std::string frame, base_frame;
  double x_m = 0, y_m = 0, yaw_rad = 0;
  TwistNumbers twist{};
};

class RobotPort {
 public:
  virtual ~RobotPort() = default;
  /// The newest command, if one has arrived.
  virtual std::optional<TwistNumbers> take() = 0;
  virtual void send(const PositionNumbers& at) = 0;
  /// Publishes the position twice, or once.
  virtual void set_second(bool second) = 0;
};

std::unique_ptr<RobotPort> make_port(const PortOptions& options);

}  // namespace ergocast::test
