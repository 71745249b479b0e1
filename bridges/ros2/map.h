// SPDX-License-Identifier: BSD-3-Clause
// A map of ROS 2, nav_msgs/OccupancyGrid, as the files that map_saver of nav2 writes. A scenario
// reads them as walls or as a target (target/maps/occupancy_map.h). No I/O.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.h"

namespace ergocast::ros2 {

/// What nav_msgs/OccupancyGrid has, unchecked.
struct MapMessage {
  std::string frame;
  float resolution_m = 0;                   ///< the side of a cell
  std::uint32_t width = 0, height = 0;      ///< along x and y
  Eigen::Vector3d origin_m{0, 0, 0};        ///< the corner of the cell (0, 0)
  Eigen::Vector4d orientation{0, 0, 0, 1};  ///< x, y, z, w
  /// The cell (i along x, j along y) is at j · width + i: 0 to 100 percent occupied, −1 unknown.
  std::span<const std::int8_t> data;
};

enum class MapMode {
  kTrinary,  ///< free, occupied or unknown, by map_saver's thresholds of 25 and 65 percent
  kRaw,      ///< the percentages themselves
};

struct SavedMap {
  std::string yaml, picture;  ///< contents; the picture is a PGM
  std::size_t unknown = 0;    ///< cells
  double yaw_rad = 0;
};

/// An error is one sentence with the topic, the field and the remedy.
/// @param topic    for errors
/// @param frame    the message's frame_id must be this one
/// @param picture  the name that the description has for the picture
Result<SavedMap> save_map(const MapMessage& map, const std::string& topic, const std::string& frame,
                          const std::string& picture, MapMode mode);

}  // namespace ergocast::ros2
