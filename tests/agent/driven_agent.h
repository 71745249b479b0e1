// SPDX-License-Identifier: BSD-3-Clause
// An agent driven by hand, and the messages of its teammates.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "agent/agent.h"
#include "tests/support/team.h"

namespace ergocast::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline AgentIdentity identity_of(AgentId id) {
  return {kRun, id, incarnation_of(id), "here", "1.2.3"};
}

/// A mission with 12 × 12 modes: two blocks.
inline Mission two_block_mission(int agents) {
  Mission mission = small_mission(agents);
  mission.basis.modes_x = mission.basis.modes_y = 12;
  mission.target_coefficients = Coefficients::Zero(144);
  mission.target_coefficients[0] = 1;
  return mission;
}

/// Agent `id` of a team whose mission runs.
inline Agent running_agent(const Mission& mission, AgentId id = 0) {
  announce(mission);
  Agent agent(identity_of(id));
  const auto team = static_cast<int>(mission.starts_m.size());
  give(agent, mission_part(0, MissionState::kRunning, roster_of(team)), at(0s));
  return agent;
}

/// The blocks of `author` after it has been at these positions, one a tick.
inline std::vector<Contribution> blocks_of(const Mission& mission, const Author& author,
                                           const std::vector<Eigen::Vector3d>& path_m,
                                           Tick next_broadcast_tick) {
  CoverageTable table(mission.basis, mission.timing.dt_s);
  for (const Eigen::Vector3d& x_m : path_m) {
    table.add_sample(author, BasisAt(x_m, mission.domain, mission.basis));
  }
  std::vector<Contribution> blocks;
  for (int b = 0; b < table.block_count(); ++b) {
    blocks.push_back(table.block(author, b));
    blocks.back().header.run = kRun;
    blocks.back().header.tick = static_cast<Tick>(path_m.size()) - 1;
    blocks.back().header.sequence =
        static_cast<std::int64_t>(path_m.size() - 1) * table.block_count() + b + 1;
    blocks.back().next_broadcast_tick = next_broadcast_tick;
  }
  return blocks;
}

inline Contribution block_of(const Mission& mission, AgentId id,
                             const std::vector<Eigen::Vector3d>& path_m, Tick next_broadcast_tick) {
  return blocks_of(mission, author_of(id), path_m, next_broadcast_tick).front();
}

inline Outbox deliver(Agent& agent, const Message& message, Instant now = at(0s)) {
  give(agent, message, now);
  return advance(agent, now);
}

/// The agent's status, which is never older than half a second.
inline AgentStatus status_after(Agent& agent, Instant now) {
  const auto statuses = only<AgentStatus>(advance(agent, now + kAgentStatusPeriod));
  EXPECT_EQ(statuses.size(), 1u);
  return statuses.empty() ? AgentStatus{} : statuses.back();
}

}  // namespace ergocast::test
