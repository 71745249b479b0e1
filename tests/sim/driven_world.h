// SPDX-License-Identifier: BSD-3-Clause
// A world driven by hand, and its messages.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "sim/world.h"
#include "tests/support/team.h"

namespace ergocast::test {

inline World world_of(const Mission& mission) {
  announce(mission);
  return {kRun, kWorldLife};
}

/// Gives every agent's two answers to the question of this incarnation of the world.
inline void nobody_has_moved(World& world, int agents, Instant now, Incarnation life = kWorldLife) {
  for (AgentId id = 0; id < agents; ++id) {
    for (int command = 0; command < 2; ++command) {
      Command answer = command_of(id, -1, {0, 0, 0});
      answer.header.sequence += command - 1;
      answer.asked_by = life;
      give(world, answer, now);
    }
  }
}

/// A world whose mission runs since `now`, all planned agents admitted; nothing published yet.
inline World running_world(const Mission& mission, Instant now = at(0s)) {
  World world = world_of(mission);
  const auto team = static_cast<int>(mission.starts_m.size());
  give(world, mission_part(0, MissionState::kRunning, roster_of(team)), now);
  nobody_has_moved(world, team, now);
  return world;
}

inline std::vector<WorldState> states_after(World& world, Instant now) {
  return only<WorldState>(advance(world, now));
}

/// The only state that the world sends now.
inline WorldState state_after(World& world, Instant now) {
  const auto states = states_after(world, now);
  EXPECT_EQ(states.size(), 1u);
  return states.empty() ? WorldState{} : states.back();
}

inline Eigen::Vector3d place(const WorldState& state, int vehicle = 0) {
  return state.vehicles[static_cast<std::size_t>(vehicle)].position_m;
}
inline Eigen::Vector3d applied(const WorldState& state, int vehicle = 0) {
  return state.vehicles[static_cast<std::size_t>(vehicle)].velocity_mps;
}

inline RecordAck ack_of(Tick tick) { return {{kRun, kLogger, kLoggerLife, tick + 2, tick}}; }

}  // namespace ergocast::test
