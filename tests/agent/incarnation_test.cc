// SPDX-License-Identifier: BSD-3-Clause
// Incarnations of one agent: their rows, their ticks, and the roster that tells them apart.
#include <gtest/gtest.h>

#include <limits>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

TEST(AgentCoverage, OfASuccessorOfAnotherKindLeavesItsPredecessorsRowsAlone) {
  Mission mission = small_mission(2);
  const double u_max_mps = mission.law.u_max_mps;
  mission.kinds = {{"fine", 1, u_max_mps, 0, 0, 0, 3}, {"rough", 1, u_max_mps, 0, 0, 20, 0.5}};
  announce(mission);
  Agent agent(identity_of(0));
  std::vector<RosterEntry> roster = roster_of(2);
  roster[1].kind = 1;
  roster[1].active_until = 1;
  roster.push_back({{1, ~Incarnation{0}}, 1, -1});  // an agent of the first kind in its place
  give(agent, mission_part(0, MissionState::kRunning, roster), at(0s));

  const Eigen::Vector3d place_m[] = {{100, 500, 0}, {300, 200, 0}, {700, 800, 0}};
  give(agent, world_state(0, {place_m[0], place_m[0]}), at(0s));
  Coefficients sums = 3 * basis_values(place_m[0], mission.domain, mission.basis);
  double weight = 3;
  advance(agent, at(0s));
  for (const std::size_t i : {1, 2}) {
    const Author& author = roster[i].author;
    for (const Contribution& block : blocks_of(mission, author, {place_m[i]}, 1000))
      give(agent, block, at(0s));
    const double quality = i == 1 ? 0.5 : 3;
    sums += quality * basis_values(place_m[i], mission.domain, mission.basis);
    weight += quality;
  }
  EXPECT_LT((agent.team_coverage() - sums / weight).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(AgentReceives, CoverageOfMembersOnly) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  // More incarnations of our own number than a table holds, and one of a teammate: none is in the
  // roster.
  for (Incarnation incarnation = 1; incarnation <= 20; ++incarnation) {
    give(agent, blocks_of(mission, {0, incarnation}, {{900, 900, 0}}, 1).front(), at(0s));
    give(agent, blocks_of(mission, {1, incarnation}, {{900, 900, 0}}, 1).front(), at(0s));
  }
  // A member's number with another member's incarnation is no member either.
  give(agent, blocks_of(mission, {0, incarnation_of(1)}, {{900, 900, 0}}, 1).front(), at(0s));
  EXPECT_EQ(agent.coverage()->row_count(), 1u) << "its own";
  deliver(agent, world_state(0, {{100, 500, 0}, {200, 500, 0}}));
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 1);
}

TEST(AgentReceives, NoMoreOfAnEvictedTeammateThanItsTimeAllows) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent,
       mission_part(5, MissionState::kRunning, {{author_of(0), 0, -1}, {author_of(1), 0, 2}}),
       at(0s));
  deliver(agent, world_state(9, {{100, 500, 0}, {200, 500, 0}}));
  const auto receive = [&](std::size_t steps) {
    give(agent, block_of(mission, 1, std::vector<Eigen::Vector3d>(steps, {200, 500, 0}), 1),
         at(0s));
    return *agent.coverage()->steps_held(author_of(1));
  };
  // It may have the ticks 0, 1 and 2, and the lead granted to all. The coordinator that evicted it
  // may lack its last ticks. A member of tick 9 might have 610.
  EXPECT_EQ(receive(603), 603) << "it still covers, but is no member";
  EXPECT_EQ(receive(604), 603);
}

TEST(AgentInLockstep, WaitsForTheRosterThatTheWorldGoesBy) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  WorldState world = world_state(0, {{100, 500, 0}});
  world.roster_revision = 3;
  EXPECT_TRUE(only<Command>(deliver(agent, world)).empty());
  EXPECT_EQ(
      only<Command>(deliver(agent, mission_part(3, MissionState::kRunning, roster_of(1)))).size(),
      1u);
}

TEST(AgentInLockstep, BeginsNoTickBeforeItKnowsTheMissionThatTheWorldGoesBy) {
  Agent agent = running_agent(small_mission(1));
  deliver(agent, world_state(0, {{100, 500, 0}}));
  WorldState world = world_state(1, {{100, 500, 0}});
  world.roster_revision = 3;
  EXPECT_TRUE(only<Contribution>(deliver(agent, world)).empty());
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 1) << "the tick may not count";
  MissionPart paused = mission_part(3, MissionState::kRunning, roster_of(1));
  paused.amendments = pauses({{1, -1}});
  const auto answers = only<Command>(deliver(agent, paused));
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_TRUE(answers[0].velocity_mps.isZero(0));
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 1);
}

TEST(AgentRestarted, ItsFormerIncarnationIsARowOfItsOwn) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const Author former{0, 55};
  auto roster = roster_of(1);
  roster.push_back({former, 0, 3});
  give(agent, mission_part(9, MissionState::kRunning, roster), at(0s));
  give(agent, blocks_of(mission, former, {{900, 900, 0}, {910, 900, 0}}, 2).front(), at(0s));
  const auto sent = only<Contribution>(deliver(agent, world_state(0, {{100, 500, 0}})));
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].steps, 1) << "the old sum is never added into the new";
  EXPECT_EQ(agent.coverage()->row_count(), 2u);
  EXPECT_EQ(agent.coverage()->steps_held(former), 2);
}

/// Agent 0 in its second incarnation, admitted from tick 7 on by a roster of revision 9.
Agent successor_from_7(const Mission& mission) {
  announce(mission);
  Agent agent(identity_of(0));
  std::vector<RosterEntry> roster{{{0, 55}, 0, 7}, {author_of(0), 7, -1}};
  give(agent, mission_part(9, MissionState::kRunning, roster), at(0s));
  give(agent,
       blocks_of(mission, {0, 55}, std::vector<Eigen::Vector3d>(7, {900, 900, 0}), 7).front(),
       at(0s));
  return agent;
}

TEST(AgentRestarted, DoesNotCoverAgainWhatTheWorldOnlyRepeatsForTheLogger) {
  const Mission mission = small_mission(1);
  Agent agent = successor_from_7(mission);
  WorldState repeated = world_state(6, {{100, 500, 0}}, 5);
  repeated.roster_revision = 8;
  EXPECT_TRUE(only<Command>(deliver(agent, repeated)).empty());
  EXPECT_EQ(agent.tick(), -1);
}

TEST(AgentRestarted, CoversNothingOfATickBeforeItsFirstThatARestartedWorldStandsAt) {
  const Mission mission = small_mission(1);
  Agent agent = successor_from_7(mission);
  WorldState behind = world_state(6, {{100, 500, 0}});
  behind.roster_revision = 9;
  const Outbox sent = deliver(agent, behind);
  EXPECT_EQ(only<Command>(sent).size(), 1u) << "the world waits for it";
  EXPECT_TRUE(only<Contribution>(sent).empty()) << "its predecessor has covered the tick";
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 0);
  const auto covered = only<Contribution>(deliver(agent, world_state(7, {{100, 500, 0}})));
  ASSERT_EQ(covered.size(), 1u);
  EXPECT_EQ(covered[0].steps, 1);
}

TEST(AgentRestarted, SendsNoCoverageBeforeItHasBegunWhileTheWorldIsSilent) {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = successor_from_7(mission);
  WorldState behind = world_state(6, {{100, 500, 0}});
  behind.roster_revision = 9;
  deliver(agent, behind);
  EXPECT_TRUE(only<Contribution>(advance(agent, at(10s))).empty());
}

}  // namespace
}  // namespace ergocast
