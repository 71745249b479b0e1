// SPDX-License-Identifier: BSD-3-Clause
// ergocast-example-mujoco: moves robots in a physics engine instead of the simulated world.
#include <map>
#include <optional>
#include <string>

#include "examples/mujoco/mujoco_physics.h"
#include "runtime/process/logging.h"
#include "runtime/process/program_options.h"
#include "sim/world_process.h"

int main(int argc, char** argv) {
  using namespace ergocast;
  using mujoco::RobotKind;
  CLI::App app("Robots in the physics engine MuJoCo, in the place of ergocast-sim.",
               "ergocast-example-mujoco");
  NodeOptions node;
  RobotKind kind = RobotKind::kDisc;
  std::optional<double> radius_m, lag_s;
  add_node_options(app, node);
  app.add_option("--robots", kind, "discs that roll on two wheels, or quadrotors")
      ->transform(CLI::CheckedTransformer(std::map<std::string, RobotKind>{
          {"discs", RobotKind::kDisc}, {"quadrotors", RobotKind::kQuadrotor}}));
  app.add_option("--radius", radius_m, "A robot's radius [m], default 0.2")
      ->check(CLI::Range(0.1, 1.0));
  app.add_option("--lag", lag_s,
                 "Time constant of wheels, default 0.1, or rotors, default 0.03 [s]")
      ->check(CLI::Range(0.01, 1.0));
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  set_up_logging("mujoco", node.log_level);
  mujoco::RobotDesign design = kind == RobotKind::kDisc ? mujoco::kDiscs : mujoco::kQuadrotors;
  design.radius_m = radius_m.value_or(design.radius_m);
  design.lag_s = lag_s.value_or(design.lag_s);
  return run_world(node, mujoco::mujoco_physics(design));
}
