// SPDX-License-Identifier: BSD-3-Clause
// Messages of ROS 2 as bytes: plain CDR (XCDR1), little-endian, with its header of four bytes.
//
// Types and fields are those of Humble and Jazzy, as bridges/ros2/ros_types.idl has them. The
// schemas have the form of .msg files (encoding ros2msg), each with all types that it uses.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/measure/occupancy.h"
#include "report/export/record.h"

namespace ergocast::ros {

enum class Type { kFloat64, kString, kPoseArray, kOdometry, kPath, kOccupancyGrid, kLog };

/// "nav_msgs/msg/Path".
std::string name_of(Type type);
/// Its definition, and those of the types in it.
std::string schema_of(Type type);

/// The frame of reference of all messages: the scenario's.
inline constexpr const char* kFrame = "map";

std::string float64(double value);
std::string string(std::string_view text);
std::string pose_array(std::uint64_t time_ns, const std::vector<Eigen::Vector3d>& places_m);
/// The robot looks where its velocity leads. @param child_frame  of the robot
std::string odometry(std::uint64_t time_ns, const TrackPoint& point, std::string_view child_frame);
std::string path(std::uint64_t time_ns, const std::vector<Eigen::Vector3d>& path_m);
/// @param origin_m  the corner of the domain
std::string occupancy_grid(std::uint64_t time_ns, const OccupancyGrid& grid,
                           const Eigen::Vector3d& origin_m);
std::string log(const ExportedLine& line);

}  // namespace ergocast::ros
