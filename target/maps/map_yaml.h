// SPDX-License-Identifier: BSD-3-Clause
// Reads the description of an occupancy map, as ROS's map_server and nav2 write it.
//
// It reads the part of YAML that they write: one "key: value" on each line, and the origin as
// "[x, y, yaw]". A YAML library would read far more, and could name neither line nor remedy.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "target/maps/map_file.h"

namespace ergocast {

/// Limit (Files of a scenario): length of an occupancy map's description [bytes]. Beyond it: the
/// scenario is refused.
inline constexpr std::size_t kMaxMapYamlBytes = std::size_t{64} << 10;

enum class OccupancyMode { kTrinary, kScale, kRaw };

struct MapYaml {
  std::filesystem::path image;     ///< relative to the description's folder, unless absolute
  double resolution_m = 0;         ///< the side of a cell
  Eigen::Vector2d origin_m{0, 0};  ///< the lower left corner of the lower left cell
  double yaw_rad = 0;              ///< the turn of the picture around this corner, anticlockwise
  bool negate = false;             ///< whether dark is free
  double occupied_thresh = 0;      ///< a cell is occupied above it
  double free_thresh = 0;          ///< a cell is free below it; at most occupied_thresh
  OccupancyMode mode = OccupancyMode::kTrinary;
};

/// All keys but `mode` are required. Unknown keys are refused.
Result<MapYaml, MapProblem> read_map_yaml(const std::filesystem::path& file);
/// @param file  the name, for problems
Result<MapYaml, MapProblem> parse_map_yaml(std::string_view text, const std::string& file);

}  // namespace ergocast
