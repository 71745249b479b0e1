// SPDX-License-Identifier: BSD-3-Clause
// Identities, limits, ticks, and the clock type without now().
#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>

namespace ergocast {

/// An agent's number in the team, 0 … kMaxAgents − 1.
using AgentId = std::int32_t;

/// 64 random bits drawn when a process starts; a restarted agent is a new incarnation of its id.
using Incarnation = std::uint64_t;

/// 64 random bits drawn for each run; messages of another run are refused.
using RunId = std::uint64_t;

/// Number of a control step. Tick n happens at mission time n·dt.
using Tick = std::int64_t;

/// Limit (Team): agents. Beyond it: no further agent is admitted.
inline constexpr int kMaxAgents = 1024;
/// Limit (Scenario): agents with `team { sites }`, which only a simulation has. Beyond it: the
/// scenario is refused.
inline constexpr int kMostAgentsOfSites = 16384;
/// Limit (Team): incarnations of one agent. Beyond it: no further incarnation is admitted; messages
/// are refused with `limit`.
inline constexpr int kMaxIncarnationsPerAgent = 16;
/// The most agents of a mission with separation.lease_s: each echoes all others in one message.
/// Limit (Scenario): agents of a mission with `separation { lease_s }`. Beyond it: the scenario is
/// refused.
inline constexpr int kMostLeasedAgents = 256;
/// Limit (Team): roster entries, former members included. Beyond it: no further agent is admitted.
inline constexpr std::size_t kMaxRosterEntries = std::size_t{4} * kMaxAgents;
/// Limit (Scenario): modes along an axis. Beyond it: the scenario is refused.
inline constexpr int kMaxModesPerAxis = 64;
/// Limit (Scenario): modes of all axes together. Beyond it: the scenario is refused.
inline constexpr int kMaxModes = 4096;
/// Limit (Scenario): modes with `basis { free_domain: true }`, whose computation takes time with
/// the square of their number. Beyond it: the scenario is refused.
inline constexpr int kMostFreeModes = 400;
inline constexpr int kMaxHostLength = 63;
inline constexpr int kMaxVersionLength = 31;

/// `sender` of the processes that are not agents.
inline constexpr AgentId kUnassigned = -1;
inline constexpr AgentId kCoordinator = -2;
inline constexpr AgentId kWorld = -3;
inline constexpr AgentId kLogger = -4;
inline constexpr AgentId kOperator = -5;

/// One incarnation of an agent: the key of its contributions.
struct Author {
  AgentId agent = kUnassigned;
  Incarnation incarnation = 0;
  auto operator<=>(const Author&) const = default;
};

/// The sender of a message, and the message's place in the sender's sequence.
struct Header {
  RunId run = 0;
  AgentId sender = kUnassigned;
  Incarnation incarnation = 0;
  std::int64_t sequence = 0;  ///< grows by one with each message of this sender on one bus
  Tick tick = 0;              ///< the sender's tick when it sent this
};

/// The clock of repeats and time-outs. It has no now(): only a main() or the laboratory knows the
/// time, so logic that reads a clock does not compile.
struct PacingClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<PacingClock>;
  static constexpr bool is_steady = true;
};
using Instant = PacingClock::time_point;

inline PacingClock::duration seconds(double s) {
  return PacingClock::duration(static_cast<std::int64_t>(s * 1e9));
}

/// An identity as 16 hex digits.
std::string to_hex(std::uint64_t identity);

}  // namespace ergocast
