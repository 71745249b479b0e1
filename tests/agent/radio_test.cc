// SPDX-License-Identifier: BSD-3-Clause
// Agents with a limited radio range: what they do not receive, what they receive through others,
// and what they wait for.
#include <gtest/gtest.h>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

/// 1 is in reach of 0 and of 2, which do not reach each other.
const std::vector<Eigen::Vector3d> kLine{{100, 500, 0}, {500, 500, 0}, {900, 500, 0}};

Mission short_range(Pace pace) {
  Mission mission = small_mission(3);
  mission.radio_range_m = 450;
  mission.timing.pace = pace;
  return mission;
}

TEST(AgentRadio, ReceivesNothingFromAgentsThatAreTooFar) {
  const Mission mission = short_range(Pace::kRealtime);
  Agent agent = running_agent(mission);
  deliver(agent, world_state(0, kLine));
  give(agent, block_of(mission, 1, {kLine[1]}, 1), at(0s));
  give(agent, block_of(mission, 2, {kLine[2]}, 1), at(0s));
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), 1);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(2)), std::nullopt);
  EXPECT_EQ(status_after(agent, at(0s)).refused, RefusalCounts{}) << "nothing wrong with it";
}

TEST(AgentRadio, ReceivesItThroughATeammateInReach) {
  const Mission mission = short_range(Pace::kRealtime);
  Agent agent = running_agent(mission);
  deliver(agent, world_state(0, kLine));
  const Contribution far = block_of(mission, 2, {kLine[2]}, 1);
  give(agent, far, at(0s), 2);
  EXPECT_EQ(agent.coverage()->row_count(), 1u);
  give(agent, far, at(0s), 1);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(2)), 1);
  // Likewise a message of a near agent does not count if a far one relays it.
  give(agent, block_of(mission, 1, {kLine[1]}, 1), at(0s), 2);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), std::nullopt);
}

TEST(AgentRadio, ReceivesAgainFromAnAgentThatComesCloser) {
  const Mission mission = short_range(Pace::kRealtime);
  Agent agent = running_agent(mission);
  deliver(agent, world_state(0, kLine));
  deliver(agent, world_state(1, {kLine[0], kLine[1], {400, 500, 0}}));
  give(agent, block_of(mission, 2, {kLine[2]}, 1), at(0s));
  EXPECT_EQ(agent.coverage()->steps_held(author_of(2)), 1);
}

TEST(AgentRadio, LockstepDoesNotWaitForAgentsOutOfReach) {
  const Mission mission = short_range(Pace::kLockstep);
  Agent agent = running_agent(mission);
  EXPECT_TRUE(only<Command>(deliver(agent, world_state(0, kLine))).empty()) << "1 is in reach";
  EXPECT_EQ(only<Command>(deliver(agent, block_of(mission, 1, {kLine[1]}, 1))).size(), 1u);
}

TEST(AgentRadio, LockstepWaitsForAgentsThatHaveComeIntoReach) {
  const Mission mission = short_range(Pace::kLockstep);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, {kLine[1]}, 9), at(0s));
  EXPECT_EQ(only<Command>(deliver(agent, world_state(0, kLine))).size(), 1u);
  EXPECT_TRUE(
      only<Command>(deliver(agent, world_state(1, {kLine[0], kLine[1], {400, 500, 0}}))).empty());
  const Contribution theirs = block_of(mission, 2, {kLine[2], {400, 500, 0}}, 2);
  EXPECT_EQ(only<Command>(deliver(agent, theirs)).size(), 1u);
}

}  // namespace
}  // namespace ergocast
