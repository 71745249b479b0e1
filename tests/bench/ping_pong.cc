// SPDX-License-Identifier: BSD-3-Clause
// A bare world and bare agents exchange datagrams of the sizes of a real tick, and repeat lost
// ones.
#include "tests/bench/ping_pong.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "core/law/coverage_table.h"
#include "lcmtypes/codec.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/program_options.h"
#include "sim/world.h"
#include "tests/bench/forked.h"

namespace ergocast::bench {
namespace {

/// Like a real world, agent and logger, sends a lost datagram again.
constexpr int kRepeat_ms = 20;
constexpr int kRepeatAck_ms = 100;
constexpr Tick kAckEveryTicks = 16;
/// By then every process has opened its sockets and touched its memory.
constexpr Tick kWarmUpTicks = 200;

std::size_t size_of(const Message& message) {
  std::vector<std::byte> bytes;
  encode(message, bytes);
  return bytes.size();
}

class RawAgent {
 public:
  RawAgent(Carrier carrier, AgentId id, const Traffic& traffic, const LcmUrl& url)
      : id_(id),
        traffic_(traffic),
        held_(static_cast<std::size_t>(traffic.agents * traffic.blocks), -1),
        contribution_("CONTRIBUTION_" + std::to_string(id)),
        command_("COMMAND_" + std::to_string(id)),
        buses_(RawBuses::open(carrier, url, {Bus::kSwarm, Bus::kWorld},
                              [this](Bus bus, const Stamp& stamp) { take(bus, stamp); })) {}

  [[noreturn]] void live() {
    while (true) {
      buses_->wait(1000);
      if (!answered_ && hears_everybody()) answer();
    }
  }

 private:
  void take(Bus bus, const Stamp& stamp) {
    if (bus == Bus::kSwarm) {
      Tick& held = held_[static_cast<std::size_t>(stamp.sender * traffic_.blocks + stamp.block)];
      held = std::max(held, stamp.tick);
      return;
    }
    if (stamp.block != id_ / traffic_.agents_in_a_state || stamp.tick < tick_) return;
    const bool repeated = stamp.tick == tick_;
    tick_ = stamp.tick;
    for (int block = 0; block < traffic_.blocks; ++block) {
      buses_->publish(Bus::kSwarm, contribution_, {tick_, id_, block}, traffic_.block_bytes);
    }
    if (!repeated) answered_ = false;
    if (repeated && answered_) answer();
  }
  /// We also receive our own blocks.
  bool hears_everybody() const {
    return std::all_of(held_.begin(), held_.end(), [this](Tick tick) { return tick >= tick_; });
  }
  void answer() {
    answered_ = true;
    buses_->publish(Bus::kCommand, command_, {tick_, id_, 0}, traffic_.command_bytes);
  }

  AgentId id_;
  Traffic traffic_;
  std::vector<Tick> held_;  // newest tick of every block of every agent
  Tick tick_ = -1;
  bool answered_ = true;
  std::string contribution_, command_;
  std::unique_ptr<RawBuses> buses_;
};

[[noreturn]] void live_as_logger(Carrier carrier, const Traffic& traffic, const LcmUrl& url) {
  Tick newest = -1, acked = -1;
  const auto buses = RawBuses::open(carrier, url, {Bus::kSwarm, Bus::kWorld, Bus::kCommand},
                                    [&](Bus bus, const Stamp& stamp) {
                                      if (bus == Bus::kWorld) newest = std::max(newest, stamp.tick);
                                    });
  while (true) {
    const bool heard = buses->wait(kRepeatAck_ms);
    if (heard && newest < acked + kAckEveryTicks) continue;
    acked = newest;
    buses->publish(Bus::kCommand, "RECORD_ACK", {acked, kLogger, 0}, traffic.ack_bytes);
  }
}

class RawWorld {
 public:
  RawWorld(Carrier carrier, const Traffic& traffic, const LcmUrl& url)
      : traffic_(traffic),
        answered_(static_cast<std::size_t>(traffic.agents), -1),
        buses_(RawBuses::open(carrier, url, {Bus::kCommand},
                              [this](Bus, const Stamp& stamp) { take(stamp); })) {}

  void play(Tick tick) {
    while (tick - recorded_ > kRecordWindowTicks && tick > kRecordWindowTicks) {
      buses_->wait(kRepeat_ms);
    }
    do {
      for (int part = 0; part * traffic_.agents_in_a_state < traffic_.agents; ++part) {
        buses_->publish(Bus::kWorld, "WORLD_STATE", {tick, kWorld, part}, traffic_.state_bytes);
      }
      while (!everyone_answered(tick) && buses_->wait(kRepeat_ms)) {
      }
    } while (!everyone_answered(tick));
  }

 private:
  void take(const Stamp& stamp) {
    Tick& known =
        stamp.sender == kLogger ? recorded_ : answered_[static_cast<std::size_t>(stamp.sender)];
    known = std::max(known, stamp.tick);
  }
  bool everyone_answered(Tick tick) const {
    return std::all_of(answered_.begin(), answered_.end(), [tick](Tick t) { return t >= tick; });
  }

  Traffic traffic_;
  std::vector<Tick> answered_;
  Tick recorded_ = -1;
  std::unique_ptr<RawBuses> buses_;
};

}  // namespace

Traffic traffic_of(const Mission& mission) {
  WorldState state;
  const auto agents = static_cast<int>(mission.starts_m.size());
  state.vehicle_count = std::min(agents, kMaxVehiclesPerState);
  return {.agents = agents,
          .blocks = CoverageTable(mission.basis, mission.timing.dt_s).block_count(),
          .agents_in_a_state = kMaxVehiclesPerState,
          .state_bytes = size_of(state),
          .block_bytes = size_of(Contribution{}),
          .command_bytes = size_of(Command{}),
          .ack_bytes = size_of(RecordAck{})};
}

std::optional<double> ping_pong(Carrier carrier, const Traffic& traffic, Tick ticks) {
  using Clock = std::chrono::steady_clock;
  const auto ports = PortReservation::take(random_identity());
  if (!ports) return std::nullopt;
  LcmUrl url;
  url.base_port = ports->base_port();
  if (why_unreachable(url)) return std::nullopt;

  // Before LCM starts threads in this process.
  std::vector<Forked> others;
  others.emplace_back([&] { live_as_logger(carrier, traffic, url); });
  for (AgentId id = 0; id < traffic.agents; ++id) {
    others.emplace_back([&, id] { RawAgent(carrier, id, traffic, url).live(); });
  }
  RawWorld world(carrier, traffic, url);
  for (Tick tick = 0; tick < kWarmUpTicks; ++tick) world.play(tick);
  const auto start = Clock::now();
  for (Tick tick = kWarmUpTicks; tick < kWarmUpTicks + ticks; ++tick) world.play(tick);
  return static_cast<double>(ticks) / std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace ergocast::bench
