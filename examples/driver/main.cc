// SPDX-License-Identifier: BSD-3-Clause
// ergocast-example-driver: drives robots instead of the simulated world.
#include <spdlog/spdlog.h>

#include <optional>
#include <string>

#include "examples/driver/driver.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/event_loop.h"
#include "runtime/process/logging.h"
#include "runtime/process/program_options.h"

namespace ergocast::example {
namespace {

int run(const NodeOptions& node, double speed_limit_mps, std::optional<AgentId> only) {
  StopSignals signals;
  Driver driver(node.run, random_identity(), speed_limit_mps, only);
  const auto connected = connect(driver, node);
  if (!connected) return kExitUnavailable;
  Transport& transport = *connected;
  spdlog::info("waiting for a mission on {}", node.url.base());

  run_core(
      driver, transport, signals, [&] { driver.stop("a signal stopped the driver"); },
      [&] {
        transport.set_run(driver.run());
        if (const auto& mission = driver.follower().mission()) {
          transport.limit_agents(rate_budget_of(*mission, driver.follower().roster().size()),
                                 driver.tick());
        }
      });
  spdlog::log(driver.failed() ? spdlog::level::err : spdlog::level::info,
              "finished at tick {}: {}; {} commands too late, {} cut to the speed limit",
              driver.tick(), driver.reason(), driver.missed_deadlines(), driver.clamped_commands());
  return driver.failed() ? kExitFailed : kExitDone;
}

}  // namespace
}  // namespace ergocast::example

int main(int argc, char** argv) {
  using namespace ergocast;
  CLI::App app("Example of a driver: wheeled robots in the place of ergocast-sim.",
               "ergocast-example-driver");
  NodeOptions node;
  double speed_limit_mps = 30;
  std::optional<AgentId> only;
  add_node_options(app, node);
  app.add_option("--speed-limit", speed_limit_mps, "The robots' greatest speed [m/s]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option(
         "--id", only,
         "Drive this robot alone, 0 to " + std::to_string(kMaxAgents - 1) + "; without: all robots")
      ->check(CLI::Range(0, kMaxAgents - 1).description(""))
      ->type_name("N");
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  set_up_logging(only ? "driver-" + std::to_string(*only) : "driver", node.log_level);
  return example::run(node, speed_limit_mps, only);
}
