// SPDX-License-Identifier: BSD-3-Clause
// The command line of ergocast-ros2.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "bridges/ros2/bridge_file.h"
#include "runtime/process/program_options.h"

namespace ergocast::ros2 {

struct Options {
  NodeOptions node;
  BridgeFile bridge;
  int domain_id = 0;
};

/// ROS_DOMAIN_ID; 0 if it is not set, nothing if it is no domain.
std::optional<int> domain_of_environment();
inline constexpr const char* kNoDomain =
    "ROS_DOMAIN_ID is not a number from 0 to 232: correct or unset it";

/// The exit code if the program must end here (0 after --help), −1 if it continues.
int read_command_line(int argc, char** argv, Options& options);

}  // namespace ergocast::ros2
