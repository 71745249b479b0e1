// SPDX-License-Identifier: BSD-3-Clause
// ergocast-sim: the simulated world as a process. A driver of robots takes its place.
#include "runtime/process/logging.h"
#include "runtime/process/program_options.h"
#include "sim/world_process.h"

int main(int argc, char** argv) {
  using namespace ergocast;
  CLI::App app(
      "The simulated world: integrates commands, reflects vehicles at the edges, counts the ticks.",
      "ergocast-sim");
  NodeOptions node;
  add_node_options(app, node);
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  set_up_logging("sim", node.log_level);
  return run_world(node);
}
