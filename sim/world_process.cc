// SPDX-License-Identifier: BSD-3-Clause
// Connects a world with the buses, the clock and the log.
#include "sim/world_process.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "runtime/bus/random_identity.h"
#include "runtime/process/event_loop.h"
#include "runtime/process/traffic_watch.h"
#include "sim/world.h"

namespace ergocast {

namespace {

using namespace std::chrono_literals;

/// Detects another world, or a driver, that moves the same vehicles. The world itself does not
/// listen to its own bus, whose every message would wake it. Two in lockstep cannot tell themselves
/// apart from their own repeats, and drivers refuse lockstep.
class OtherWorldWatch {
 public:
  OtherWorldWatch(World& world, const NodeOptions& node) : world_(world), node_(node) {}

  void look(Instant now) {
    const auto& mission = world_.follower().mission();
    if (done_ || !mission) return;
    done_ = mission->timing.pace == Pace::kLockstep;
    if (!done_ && !listener_) listen();
    if (done_) return;
    listener_->deliver_until(now, -1);
    if (!known_tick_) {
      known_tick_ = world_.newest_answer();
      heard_until_ = now + kListening;
      world_.begin_not_before(heard_until_);
    }
    if (!world_.begun_at() || now < heard_until_ + kListening) return;
    listener_.reset();
    done_ = true;
  }

 private:
  /// How long it listens before it begins, and again afterwards, because another world may begin at
  /// the same time.
  static constexpr auto kListening = 500ms;

  void listen() {
    auto opened =
        Transport::open(node_.url, world_.run(), node_.authenticator, {0, kTypes<WorldState>, 0},
                        {.on_message = [this](const Message& message, Bus, AgentId) {
                          meet(std::get<WorldState>(message));
                        }});
    done_ = !opened;
    if (!done_) listener_ = *std::move(opened);
  }

  /// A tick beyond the team's answers comes from a running world. Neither a recording nor a world
  /// before us has such a tick. If two began together, the one with the greater identity gives way.
  void meet(const WorldState& state) {
    const Header& other = state.header;
    if (other.incarnation == world_.incarnation() || state.last || world_.finished()) return;
    if (!known_tick_ || other.tick <= *known_tick_ + 1) return;
    if (world_.begun_at() && other.incarnation > world_.incarnation()) return;
    world_.fail("run " + to_hex(world_.run()) +
                ": a driver, or another world, moves its vehicles already: end that one first, or "
                "do not start this one");
  }

  World& world_;
  const NodeOptions& node_;
  std::unique_ptr<Transport> listener_;
  std::optional<Tick> known_tick_;
  Instant heard_until_{};
  bool done_ = false;
};

}  // namespace

int run_world(const NodeOptions& node, PhysicsMaker physics) {
  StopSignals signals;
  World world(node.run, random_identity(), std::move(physics));
  const auto connected = connect(world, node);
  if (!connected) return kExitUnavailable;
  Transport& transport = *connected;
  TrafficWatch watch(transport);
  OtherWorldWatch other_worlds(world, node);
  spdlog::info("waiting for a mission on {}", node.url.base());

  bool logger_lost = false, begun = false;
  const auto stop = [&] { world.stop("a signal stopped the world"); };
  run_core(world, transport, signals, stop, [&] {
    transport.set_run(world.run());
    if (const auto& mission = world.follower().mission()) {
      const std::size_t members = world.follower().roster().size();
      transport.limit_agents(rate_budget_of(*mission, members), world.tick());
      transport.let_gather(gathering_of(*mission, members));
    }
    watch.look(now(), world.late_commands());
    other_worlds.look(now());
    if (world.begun_at() && !begun) spdlog::info("moving from tick {} on", *world.begun_at());
    begun = world.begun_at().has_value();
    if (world.logger_lost() && !logger_lost)
      spdlog::warn("the logger is silent: the mission goes on without it");
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
  if (const std::string output = world.physics_summary(); !output.empty())
    spdlog::info("{}", output);
  return kExitDone;
}

}  // namespace ergocast
