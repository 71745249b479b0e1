// SPDX-License-Identifier: BSD-3-Clause
// A coordinator driven by hand, and the messages of agents and world.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "coordinator/coordinator.h"
#include "tests/support/team.h"

namespace ergocast::test {

inline const std::string kVersion = "1.2.3";

inline Coordinator coordinator_of(const Mission& mission) {
  return {{kRun, kCoordinatorLife, "here", kVersion}, encode_plan(mission)};
}

/// The revision in a HELLO that is always new enough.
inline constexpr std::int64_t kEveryRevision = std::int64_t{1} << 40;

inline Hello hello_of(AgentId id, Incarnation incarnation, std::int64_t revision = kEveryRevision) {
  return {{kRun, kUnassigned, incarnation, 1, 0}, id, "somewhere", kVersion, revision};
}
inline Hello hello_of(AgentId id) { return hello_of(id, incarnation_of(id)); }

inline void admit_all(Coordinator& coordinator, int agents, Instant now) {
  for (AgentId id = 0; id < agents; ++id) give(coordinator, hello_of(id), now);
}

/// A coordinator whose mission runs since `now`.
inline Coordinator running_coordinator(const Mission& mission, Instant now = at(0s)) {
  Coordinator coordinator = coordinator_of(mission);
  advance(coordinator, now);
  admit_all(coordinator, static_cast<int>(mission.starts_m.size()), now);
  advance(coordinator, now);
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
  return coordinator;
}

/// The world at `tick`, where agent i has answered `answered[i]`.
inline WorldState world_where(Tick tick, const std::vector<Tick>& answered) {
  WorldState state = world_state(tick, std::vector<Eigen::Vector3d>(answered.size(), {1, 1, 0}));
  for (std::size_t i = 0; i < answered.size(); ++i) state.vehicles[i].answered_tick = answered[i];
  return state;
}

}  // namespace ergocast::test
