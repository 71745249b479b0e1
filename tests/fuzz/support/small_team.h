// SPDX-License-Identifier: BSD-3-Clause
// A whole team in one process, two agents, that receives a fuzzer's messages among its own.
#pragma once

#include <cstdint>
#include <functional>
#include <sstream>
#include <string_view>
#include <vector>

#include "agent/agent.h"
#include "cli/team/team_view.h"
#include "coordinator/coordinator.h"
#include "logger/recorder.h"
#include "sim/world.h"

namespace ergocast::fuzz {

/// The kind of the mission; every bit is a feature.
enum Features : std::uint8_t {
  kRealtimePace = 1,
  kLooksAhead = 2,
  kRadioRange = 4,
  kForgetting = 8,
  kEviction = 16,
  kWaitsForLogger = 32,
  kTwoBlocks = 64,
  kCoordinatorTakesOver = 128,
};

/// A short mission of two agents with these features.
Mission mission_with(std::uint8_t features);

/// The transmitter of `message` if `transmitter` claims to have sent it: only contributions are
/// relayed.
AgentId transmitter_in(const Message& message, AgentId transmitter);

/// Aborts if an agent has an impossible state, shows text that controls a terminal, or has NaN in a
/// table.
void check(const Agent& agent);
void check(const TeamPicture& picture);
void check_table(std::string_view table);

class SmallTeam {
 public:
  explicit SmallTeam(std::uint8_t features);

  /// Receives an attacker's datagram, as the transport would pass it on.
  void receive(std::span<const std::byte> datagram, AgentId transmitter);
  /// Advances the time; every process does its due work and receives the others' messages.
  void pass(std::chrono::nanoseconds time);

  /// Aborts if any process has or has written an impossible value.
  void check() const;

  /// Receives every datagram that the team sends.
  std::function<void(AgentId transmitter, const std::vector<std::byte>&)> on_sent;

 private:
  void take(const Message& message, AgentId transmitter);
  void advance_all();
  void deliver(const Outbox& out);

  Instant now_{std::chrono::seconds(1)};
  Mission mission_;
  std::ostringstream trajectory_, metrics_;
  std::vector<Agent> agents_;
  World world_;
  Coordinator coordinator_;
  Recorder recorder_;
  TeamView view_;
  std::vector<std::byte> bytes_;
};

}  // namespace ergocast::fuzz
