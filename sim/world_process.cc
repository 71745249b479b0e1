// SPDX-License-Identifier: BSD-3-Clause
// Connects a world with the buses, the clock and the log.
#include "sim/world_process.h"

#include <spdlog/spdlog.h>

#include <string>
#include <utility>

#include "runtime/event_loop.h"
#include "runtime/traffic_watch.h"
#include "sim/world.h"

namespace ergocast {

int run_world(const NodeOptions& node, PhysicsMaker physics) {
  StopSignals signals;
  World world(node.run, random_identity(), std::move(physics));
  const auto connected = connect(world, node);
  if (!connected) return kExitUnavailable;
  Transport& transport = *connected;
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
  if (const std::string said = world.physics_summary(); !said.empty()) spdlog::info("{}", said);
  return kExitDone;
}

}  // namespace ergocast
