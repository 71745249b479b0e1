// SPDX-License-Identifier: BSD-3-Clause
// ergocast-sim: the simulated world as a process. On robots, their driver takes its place.
#include <spdlog/spdlog.h>

#include "runtime/event_loop.h"
#include "runtime/logging.h"
#include "runtime/node.h"
#include "runtime/traffic_watch.h"
#include "sim/world.h"

namespace ergocast {
namespace {

int run(const NodeOptions& node) {
  StopSignals signals;
  World world(node.run, random_identity());
  auto opened =
      Transport::open(node.url, node.run, node.seal, subscriptions_of(World::kRole),
                      {.on_message = [&](const Message& message, Bus bus, AgentId transmitter) {
                        world.receive(message, bus, transmitter, now());
                      }});
  if (const auto* problem = std::get_if<std::string>(&opened)) {
    spdlog::error("{}", *problem);
    return kExitUnavailable;
  }
  Transport& transport = *std::get<0>(opened);
  TrafficWatch watch(transport);
  spdlog::info("waiting for a mission on {}", node.url.base());

  bool logger_lost = false, begun = false;
  const auto stop = [&] { world.stop("the world was told to stop"); };
  live(world, transport, signals, stop, [&] {
    transport.set_run(world.run());
    if (const auto& mission = world.follower().mission()) {
      const std::size_t members = world.follower().roster().size();
      transport.limit_agents(allowance_of(*mission, members), world.tick());
      transport.let_gather(gathering_of(*mission, members));
    }
    watch.look(now());
    if (world.begun_at() && !begun) spdlog::info("moving from tick {} on", *world.begun_at());
    begun = world.begun_at().has_value();
    if (world.logger_lost() && !logger_lost) spdlog::warn("the logger is silent: going on without");
    logger_lost = world.logger_lost();
  });
  if (world.failed()) {
    spdlog::error("{}", world.reason());
    return kExitFailed;
  }
  spdlog::info(
      "finished at tick {}: {}; {} commands too late, {} cut to the speed limit, {} refused; "
      "{} ticks skipped",
      world.tick(), world.reason(), world.missed_deadlines(), world.clamped_commands(),
      world.refused(), world.skipped_ticks());
  return kExitDone;
}

}  // namespace
}  // namespace ergocast

int main(int argc, char** argv) {
  using namespace ergocast;
  CLI::App app("The simulated world: integrates commands, reflects at the edge, keeps the tick.",
               "ergocast-sim");
  NodeOptions node;
  add_node_options(app, node);
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  set_up_logging("sim", node.log_level);
  return run(node);
}
