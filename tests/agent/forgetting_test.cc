// SPDX-License-Identifier: BSD-3-Clause
// Coverage that the roster forgets: from a given tick on it does not affect commands, but it is
// still relayed.
#include <gtest/gtest.h>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

const std::vector<Eigen::Vector3d> kGone{{900, 900, 0}, {910, 900, 0}};

/// The plan's roster of two, where 1 has left at tick 2 and is forgotten from `tick` on.
MissionPart forgetting_from(Tick tick, std::int64_t revision = 1) {
  return mission_part(revision, MissionState::kRunning,
                      {{author_of(0), 0, -1}, {author_of(1), 0, 2, true, tick}});
}

WorldState world_at(Tick tick, std::int64_t revision = 0) {
  WorldState world = world_state(tick, {{100.0 + static_cast<double>(tick), 500, 0}});
  world.roster_revision = revision;
  return world;
}

/// Whether agent 0 used only its own coverage to steer, in the ticks [0, `ticks`).
bool steered_alone(const Agent& agent, const Mission& mission, Tick ticks) {
  CoverageTable own(mission.basis, mission.timing.dt_s);
  for (Tick tick = 0; tick < ticks; ++tick) {
    own.add_sample(author_of(0), BasisAt({100.0 + static_cast<double>(tick), 500, 0},
                                         mission.domain, mission.basis));
  }
  Coefficients alone = agent.team_coverage();
  own.average(alone);
  return agent.team_coverage() == alone;
}

TEST(AgentForgets, FromTheNamedTickOn) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, kGone, 100), at(0s));
  give(agent, forgetting_from(3), at(0s));
  for (Tick tick = 0; tick < 6; ++tick) {
    EXPECT_EQ(only<Command>(deliver(agent, world_at(tick))).size(), 1u);
    EXPECT_EQ(steered_alone(agent, mission, tick + 1), tick >= 3) << tick;
  }
}

TEST(AgentForgets, WhatComesOnlyAfterwardsToo) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent, forgetting_from(0), at(0s));
  // While the tick waits for another revision, a teammate relays a block of 1.
  EXPECT_TRUE(only<Command>(deliver(agent, world_at(0, 2))).empty());
  give(agent, block_of(mission, 1, kGone, 100), at(0s));
  EXPECT_EQ(only<Command>(deliver(agent, forgetting_from(0, 2))).size(), 1u);
  EXPECT_TRUE(steered_alone(agent, mission, 1));
}

TEST(AgentForgets, AtTheTickThatWaitsForTheNewRevision) {
  // All agents must forget at the same tick, whichever receives the revision first.
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, kGone, 100), at(0s));
  EXPECT_TRUE(only<Command>(deliver(agent, world_at(0, 1))).empty()) << "the world knows more";
  EXPECT_EQ(only<Command>(deliver(agent, forgetting_from(0))).size(), 1u);
  EXPECT_TRUE(steered_alone(agent, mission, 1));
}

TEST(AgentForgets, NotBeforeTheWorldUsesTheRosterThatNamesIt) {
  // Agents with a newer roster must not differ from the others.
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, kGone, 100), at(0s));
  MissionPart news = forgetting_from(0, 8);
  news.roster[1].since_revision = 8;
  give(agent, news, at(0s));
  for (Tick tick = 0; tick < 6; ++tick) {
    EXPECT_EQ(only<Command>(deliver(agent, world_at(tick, tick < 3 ? 7 : 8))).size(), 1u);
    EXPECT_EQ(steered_alone(agent, mission, tick + 1), tick >= 3) << tick;
  }
}

TEST(AgentForgets, UntilTheNamedTickAtWhichItCountsAgain) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, kGone, 100), at(0s));
  give(agent, forgetting_from(1), at(0s));
  MissionPart again = forgetting_from(4, 2);
  again.roster[1].forgotten = false;
  for (Tick tick = 0; tick < 7; ++tick) {
    if (tick == 3) give(agent, again, at(0s));
    EXPECT_EQ(only<Command>(deliver(agent, world_at(tick, 2 * (tick >= 3)))).size(), 1u);
    EXPECT_EQ(steered_alone(agent, mission, tick + 1), tick >= 1 && tick < 4) << tick;
  }
}

TEST(AgentForgets, AnAgentWhoseAdmissionWasLostWithTheCoordinatorUntilItIsAdmittedAgain) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, kGone, 100), at(0s));
  deliver(agent, world_at(0));
  EXPECT_FALSE(steered_alone(agent, mission, 1));
  // The roster of the coordinator's successor, 1000 revisions later, does not have agent 1. Agents
  // without its row refuse it now.
  give(agent, mission_part(1001, MissionState::kRunning, {{author_of(0), 0, -1}}), at(0s));
  EXPECT_EQ(only<Command>(deliver(agent, world_at(1, 1001))).size(), 1u);
  EXPECT_TRUE(steered_alone(agent, mission, 2));
  give(agent, mission_part(1002, MissionState::kRunning, roster_of(2)), at(0s));
  EXPECT_EQ(only<Command>(deliver(agent, world_at(2, 1002))).size(), 1u);
  EXPECT_FALSE(steered_alone(agent, mission, 3));
}

TEST(AgentForgets, AndRemembersWhileTheMissionIsPaused) {
  // Forgetting goes by the world's ticks, as holds do.
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, kGone, 100), at(0s));
  MissionPart gone = forgetting_from(2);
  gone.amendments = pauses({{1, -1}});
  give(agent, gone, at(0s));
  MissionPart again = forgetting_from(4, 2);
  again.roster[1].forgotten = false;
  again.amendments = gone.amendments;
  for (Tick tick = 0; tick < 6; ++tick) {
    if (tick == 3) give(agent, again, at(0s));
    EXPECT_EQ(only<Command>(deliver(agent, world_at(tick, 2 * (tick >= 3)))).size(), 1u);
    EXPECT_EQ(agent.held(), tick >= 1);
    EXPECT_EQ(steered_alone(agent, mission, 1), tick >= 2 && tick < 4) << tick;
  }
}

TEST(AgentForgets, NeverItself) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent,
       mission_part(1, MissionState::kRunning,
                    {{author_of(0), 0, -1, true, 0}, {author_of(1), 0, 0}}),
       at(0s));
  EXPECT_EQ(only<Command>(deliver(agent, world_at(0))).size(), 1u);
  EXPECT_EQ(agent.team_coverage()[0], 1) << "it runs, even if the coordinator received nothing";
}

TEST(AgentForgets, ButPassesItOn) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, kGone, 100), at(0s));
  give(agent, forgetting_from(0), at(0s));
  deliver(agent, world_at(0));
  EXPECT_EQ(agent.coverage()->block(author_of(1), 0).sums, block_of(mission, 1, kGone, 100).sums);
  EXPECT_EQ(only<Digest>(advance(agent, at(5s))).at(0).entries[1].steps, 2);
}

}  // namespace
}  // namespace ergocast
