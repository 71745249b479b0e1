// SPDX-License-Identifier: BSD-3-Clause
// The positions that a robot publishes, as far as they can be trusted.
//
// A message counts only in the frame of reference that the bridge's file names, with a stamp by
// this machine's clock, and if it is no jump. No clock is read here.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/ids.h"

namespace ergocast::ros2 {

/// Where the origin of a frame of reference is in the scenario.
struct FrameOrigin {
  std::string name;
  Eigen::Vector3d origin_m{0, 0, 0};
  double yaw_rad = 0;
};

/// What nav_msgs/Odometry and geometry_msgs/PoseStamped have, unchecked.
struct PoseMessage {
  std::int64_t stamp_ns = 0;
  std::string frame;
  std::optional<std::string> child_frame{};  ///< of an Odometry
  Eigen::Vector3d position_m{0, 0, 0};
  Eigen::Vector4d orientation{0, 0, 0, 1};             ///< x, y, z, w
  std::optional<Eigen::Vector3d> body_velocity_mps{};  ///< of an Odometry, in the child frame
};

/// The time by the clock of our process, and by that of the machine (since 1970).
struct Moment {
  Instant now{};
  std::int64_t wall_ns = 0;
};

/// A position in the scenario's frame.
struct Fix {
  Eigen::Vector3d position_m{0, 0, 0}, velocity_mps{0, 0, 0};
  double heading_rad = 0;  ///< from the scenario's x to the robot's x
  Instant measured{};
};

/// Limit (ROS 2): age of a position [s]. Beyond it: the robot stands, and its position is not sent.
inline constexpr double kOldestFix_s = 0.5;
/// Limit (ROS 2): time by which a stamp may be in the future [s]. Beyond it: the position does not
/// count.
inline constexpr double kMostFuture_s = 0.1;
/// Limit (ROS 2): distance between two positions that follow each other, beyond twice the way at
/// the robot's greatest speed [m]. Beyond it: the robot stands until positions are steady again.
inline constexpr double kGreatestJump_m = 0.5;
/// For so long positions must be steady after a jump [s].
inline constexpr double kSteady_s = 3;

class Positions {
 public:
  /// @param topic  for sentences
  /// @param child_frame  of an Odometry; empty: not checked
  Positions(std::string topic, FrameOrigin frame, std::string child_frame, double max_speed_mps)
      : topic_(std::move(topic)),
        frame_(std::move(frame)),
        child_frame_(std::move(child_frame)),
        max_speed_mps_(max_speed_mps),
        problem_("nothing has arrived on " + topic_) {}

  /// The age from which positions are too old for the mission; kOldestFix_s counts, too.
  void set_oldest(double oldest_s) { oldest_s_ = std::min(oldest_s, kOldestFix_s); }

  void take(const PoseMessage& message, const Moment& at);

  /// The newest trusted position; nothing if there is none that is young enough.
  std::optional<Fix> at(Instant now) const;
  /// Why there is none, as a sentence; empty if there is one.
  std::string problem(Instant now) const;

 private:
  std::string why_refused(const PoseMessage& message, const Moment& at) const;
  void note_way(std::int64_t stamp_ns, const Eigen::Vector3d& position_m);

  std::string topic_;
  FrameOrigin frame_;
  std::string child_frame_;
  double max_speed_mps_;
  double oldest_s_ = kOldestFix_s;
  std::optional<Fix> newest_;
  std::optional<Eigen::Vector3d> last_m_;  // the last position with a good frame and stamp
  std::int64_t last_ns_ = 0, steady_since_ns_ = 0;
  std::string unsteady_;  // why positions are not trusted at present
  std::string problem_;
};

}  // namespace ergocast::ros2
