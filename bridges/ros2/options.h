// SPDX-License-Identifier: BSD-3-Clause
// The command line of ergocast-ros2.
#pragma once

#include <filesystem>
#include <vector>

#include "bridges/ros2/bridge_file.h"
#include "runtime/process/program_options.h"

namespace ergocast::ros2 {

struct Options {
  NodeOptions node;
  BridgeFile bridge;
  int domain_id = 0;
};

/// The exit code if the program must end here (0 after --help), −1 if it continues.
int read_command_line(int argc, char** argv, Options& options);

}  // namespace ergocast::ros2
