// SPDX-License-Identifier: BSD-3-Clause
// `ergocast-ros2 map`: saves the newest map of a topic, for the scenario of a team.
#pragma once

namespace ergocast::ros2 {

inline constexpr const char* kMapSummary =
    "Save the newest map of a topic (nav_msgs/OccupancyGrid), as map_saver does";

/// Whether the command line asks for it.
bool is_map_command(int argc, char** argv);
/// Runs it; returns the exit code.
int map_command(int argc, char** argv);

}  // namespace ergocast::ros2
