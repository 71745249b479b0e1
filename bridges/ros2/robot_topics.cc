// SPDX-License-Identifier: BSD-3-Clause
// Copies numbers between messages of DDS and those of the robot.
#include "bridges/ros2/robot_topics.h"

#include <array>
#include <utility>

#include "bridges/ros2/message_types.h"

namespace ergocast::ros2 {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

PoseMessage pose_of(const std_msgs_msg_dds__Header_& header,
                    const geometry_msgs_msg_dds__Pose_& pose) {
  PoseMessage message;
  message.stamp_ns = wall_ns_of(header.stamp);
  message.frame = header.frame_id != nullptr ? header.frame_id : "";
  message.position_m = {pose.position.x, pose.position.y, pose.position.z};
  message.orientation = {pose.orientation.x, pose.orientation.y, pose.orientation.z,
                         pose.orientation.w};
  return message;
}

PoseMessage pose_of(const nav_msgs_msg_dds__Odometry_& odometry) {
  PoseMessage message = pose_of(odometry.header, odometry.pose.pose);
  message.child_frame = odometry.child_frame_id != nullptr ? odometry.child_frame_id : "";
  const auto& linear = odometry.twist.twist.linear;
  message.body_velocity_mps = Eigen::Vector3d(linear.x, linear.y, linear.z);
  return message;
}

geometry_msgs_msg_dds__Twist_ twist_of(const BodyVelocity& velocity) {
  geometry_msgs_msg_dds__Twist_ twist{};
  twist.linear = {velocity.linear_mps.x(), velocity.linear_mps.y(), velocity.linear_mps.z()};
  twist.angular.z = velocity.turn_radps;
  return twist;
}

}  // namespace

builtin_interfaces_msg_dds__Time_ stamp_of(std::int64_t wall_ns) {
  return {static_cast<std::int32_t>(wall_ns / kSecond_ns),
          static_cast<std::uint32_t>(wall_ns % kSecond_ns)};
}

std::int64_t wall_ns_of(const builtin_interfaces_msg_dds__Time_& stamp) {
  return stamp.sec * kSecond_ns + stamp.nanosec;
}

Result<RobotConnection> RobotConnection::make(DdsNode& node, const BridgedRobot& robot) {
  const RobotTopics& topics = robot.topics;
  auto cmd_vel =
      Writer::make(node, topics.stamped_command ? kTwistStamped : kTwist, topics.cmd_vel, {});
  if (!cmd_vel) return failure(cmd_vel.error());
  auto position = Reader::make(node, topics.has_odometry ? kOdometry : kPoseStamped,
                               topics.position, {topics.reliable});
  if (!position) return failure(position.error());
  return RobotConnection(robot, *std::move(cmd_vel), *std::move(position));
}

void RobotConnection::receive(Robot& robot, const Moment& at) {
  position_.take([&](const void* message) {
    if (topics_.has_odometry)
      return robot.take(pose_of(*static_cast<const nav_msgs_msg_dds__Odometry_*>(message)), at);
    const auto& stamped = *static_cast<const geometry_msgs_msg_dds__PoseStamped_*>(message);
    robot.take(pose_of(stamped.header, stamped.pose), at);
  });
}

void RobotConnection::send(const BodyVelocity& velocity, std::int64_t wall_ns) {
  if (!topics_.stamped_command) {
    const auto twist = twist_of(velocity);
    return cmd_vel_.write(&twist);
  }
  geometry_msgs_msg_dds__TwistStamped_ stamped{};
  stamped.header.stamp = stamp_of(wall_ns);
  stamped.header.frame_id = base_frame_.data();
  stamped.twist = twist_of(velocity);
  cmd_vel_.write(&stamped);
}

std::optional<std::string> RobotConnection::examine(Robot& robot) {
  std::string problem = position_.problem();
  if (problem.empty()) problem = cmd_vel_.problem();
  robot.set_topic_problem(std::move(problem));
  const bool rival = cmd_vel_.others() > 0;
  if (rival == std::exchange(has_rival_, rival) || !rival) return std::nullopt;
  return "another program publishes " + topics_.cmd_vel +
         ", too: end it, because the robot gets the commands of both";
}

}  // namespace ergocast::ros2
