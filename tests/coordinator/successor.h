// SPDX-License-Identifier: BSD-3-Clause
// A coordinator that starts beside a team, and what it receives of the mission that is under way.
#pragma once

#include "tests/coordinator/driven_coordinator.h"

namespace ergocast::test {

inline constexpr Incarnation kSuccessorLife = 0xc1;

inline Coordinator successor(Takeover takeover, RunId run = 0,
                             std::vector<std::byte> plan = encode_plan(small_mission(2))) {
  return {{run, kSuccessorLife, "here", kVersion}, std::move(plan), takeover};
}

/// An agent's copy of the predecessor's message at `tick`.
inline MissionPart memory_of(std::int64_t revision, std::vector<RosterEntry> roster = roster_of(2),
                             Tick tick = 0, MissionState state = MissionState::kRunning) {
  MissionPart part = mission_part(revision, state, std::move(roster));
  part.header.tick = tick;
  part.plan = encode_plan(small_mission(2));
  return part;
}

/// A coordinator that has taken over `memory`, at 1 s.
inline Coordinator taken_over(const MissionPart& memory) {
  Coordinator coordinator = successor(Takeover::kIfRunning, 0, memory.plan);
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  give(coordinator, memory, at(0s));
  advance(coordinator, at(1s));
  EXPECT_TRUE(coordinator.took_over());
  return coordinator;
}

/// A message that only a running coordinator sends.
inline TeamStatus alive(Incarnation incarnation, std::int64_t sequence = 1) {
  TeamStatus status;
  status.header = {kRun, kCoordinator, incarnation, sequence, 0};
  status.host = "there";
  return status;
}

inline const MissionPart& sent_by(const Outbox& out) {
  for (const Outgoing& outgoing : out) {
    if (const auto* part = std::get_if<MissionPart>(&outgoing.message)) return *part;
  }
  static const MissionPart nothing{};
  ADD_FAILURE() << "no mission was sent";
  return nothing;
}

}  // namespace ergocast::test
