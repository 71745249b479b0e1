// SPDX-License-Identifier: BSD-3-Clause
// The ROS 2 messages that the bridge sends and receives, with the hashes of their types (REP 2011).
#pragma once

#include "bridges/ros2/dds_node.h"
#include "ros_types.h"

namespace ergocast::ros2 {

inline const MessageType kTwist{
    geometry_msgs_msg_dds__Twist__desc,
    "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"};
inline const MessageType kTwistStamped{
    geometry_msgs_msg_dds__TwistStamped__desc,
    "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64"};
inline const MessageType kPoseStamped{
    geometry_msgs_msg_dds__PoseStamped__desc,
    "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"};
inline const MessageType kPoseArray{
    geometry_msgs_msg_dds__PoseArray__desc,
    "RIHS01_af0cc36d190e104d546d168d6b39df04fa4b4ccecf59cb4c9ed328d3d5004aa0"};
inline const MessageType kOdometry{
    nav_msgs_msg_dds__Odometry__desc,
    "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"};
inline const MessageType kPath{
    nav_msgs_msg_dds__Path__desc,
    "RIHS01_1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b"};
inline const MessageType kOccupancyGrid{
    nav_msgs_msg_dds__OccupancyGrid__desc,
    "RIHS01_8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7"};
inline const MessageType kFloat64{
    std_msgs_msg_dds__Float64__desc,
    "RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a"};
inline const MessageType kString{
    std_msgs_msg_dds__String__desc,
    "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"};

/// A time since 1970 as ROS 2 has it.
builtin_interfaces_msg_dds__Time_ stamp_of(std::int64_t wall_ns);
std::int64_t wall_ns_of(const builtin_interfaces_msg_dds__Time_& stamp);

}  // namespace ergocast::ros2
