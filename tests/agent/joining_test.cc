// SPDX-License-Identifier: BSD-3-Clause
// How an agent joins a team, and what it refuses before it is a member.
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

TEST(AgentJoining, AsksFourTimesASecondUntilTheRosterNamesIt) {
  announce(small_mission(4));
  Agent agent(identity_of(3));
  const auto hellos = only<Hello>(advance(agent, at(0s)));
  ASSERT_EQ(hellos.size(), 1u);
  EXPECT_EQ(hellos[0].requested_id, 3);
  EXPECT_EQ(hellos[0].header.incarnation, incarnation_of(3));
  EXPECT_EQ(hellos[0].host, "here");
  EXPECT_EQ(hellos[0].version, "1.2.3");
  EXPECT_TRUE(advance(agent, at(249ms)).empty());
  EXPECT_EQ(agent.next_wakeup(), at(250ms));
  EXPECT_EQ(only<Hello>(advance(agent, at(250ms))).size(), 1u);

  // A roster without us has no effect.
  EXPECT_EQ(
      only<Hello>(deliver(agent, mission_part(0, MissionState::kWaiting, roster_of(3)), at(500ms)))
          .size(),
      1u);
  EXPECT_EQ(agent.phase(), AgentPhase::kJoining);

  deliver(agent, mission_part(1, MissionState::kWaiting, roster_of(4)), at(600ms));
  EXPECT_EQ(agent.phase(), AgentPhase::kWaiting);
  EXPECT_TRUE(only<Hello>(advance(agent, at(10s))).empty());
}

TEST(AgentJoining, TakesTheNumberThatTheRosterGivesItsIncarnation) {
  AgentIdentity anybody = identity_of(0);
  anybody.requested_id = kUnassigned;
  anybody.incarnation = incarnation_of(2);
  announce(small_mission(3));
  Agent agent(anybody);
  EXPECT_EQ(agent.id(), kUnassigned);
  give(agent, mission_part(0, MissionState::kRunning, roster_of(3)), at(0s));
  EXPECT_EQ(agent.id(), 2);
}

TEST(AgentJoining, NamesItsKindAndEndsWhereThereIsNone) {
  AgentIdentity slow = identity_of(0);
  slow.kind = "slow";
  Mission mission = small_mission(2);
  announce(mission);
  Agent agent(slow);
  const auto hellos = only<Hello>(advance(agent, at(0s)));
  ASSERT_EQ(hellos.size(), 1u);
  EXPECT_EQ(hellos[0].kind, "slow");
  give(agent, mission_part(0, MissionState::kWaiting, {}), at(0s));
  EXPECT_TRUE(agent.failed());
  EXPECT_EQ(agent.reason(),
            "the mission has no kind \"slow\": all its agents are alike, so name none");
}

TEST(AgentJoining, DoesNothingInTheWorldBeforeTheMissionRuns) {
  const Mission mission = small_mission(1);
  announce(mission);
  Agent agent(identity_of(0));
  give(agent, mission_part(0, MissionState::kWaiting, roster_of(1)), at(0s));
  const Outbox waiting = deliver(agent, world_state(0, {{100, 500, 0}}));
  EXPECT_TRUE(only<Command>(waiting).empty());
  EXPECT_TRUE(only<Contribution>(waiting).empty());
  EXPECT_EQ(agent.tick(), -1);
  const Outbox running = deliver(agent, mission_part(1, MissionState::kRunning, roster_of(1)));
  EXPECT_EQ(only<Command>(running).size(), 1u);
}

TEST(AgentJoining, AnAgentWithoutARunJoinsTheFirstThatItReceives) {
  AgentIdentity late = identity_of(0);
  late.run = 0;
  announce(small_mission(1));
  Agent agent(late);
  give(agent, mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  EXPECT_EQ(agent.run(), kRun);
  MissionPart other = mission_part(9, MissionState::kEnded, {});
  other.header.run = kRun + 1;
  give(agent, other, at(0s));
  EXPECT_FALSE(agent.finished());
}

TEST(AgentJoining, StopsAndReportsWhyIfAnotherProcessRunsUnderItsNumber) {
  announce(small_mission(2));
  Agent agent(identity_of(1));
  AgentStatus duplicate = status_of(1, 1);
  duplicate.header.incarnation = 77;
  for (std::int64_t sequence = 1; sequence <= 11; ++sequence) {
    EXPECT_FALSE(agent.finished());
    duplicate.header.sequence = sequence;
    give(agent, duplicate, at(500ms * (sequence - 1)));
  }
  EXPECT_TRUE(agent.finished());
  EXPECT_TRUE(agent.failed());
  EXPECT_EQ(agent.reason(), "agent 1 is already running on elsewhere: choose another id, or none");
  EXPECT_TRUE(advance(agent, at(1h)).empty()) << "it must not send under a number that is taken";
}

TEST(AgentJoining, RepeatedOldOrForeignStatusesDoNotStopIt) {
  announce(small_mission(2));
  Agent agent(identity_of(1));
  AgentStatus duplicate = status_of(1, 5);
  duplicate.header.incarnation = 77;
  auto when = 0s;
  for (const std::int64_t sequence : {5, 6, 5, 4, 3, 5, 6, 6}) {
    duplicate.header.sequence = sequence;
    give(agent, duplicate, at(when));
    when = when == 0s ? 1s : when + 10s;
  }
  for (int i = 0; i < 10; ++i) give(agent, status_of(0, i), at(0s));
  EXPECT_FALSE(agent.finished());
}

TEST(AgentJoining, AnAgentThatAskedForNoNumberDoesNotStopForAnother) {
  AgentIdentity anybody = identity_of(1);
  anybody.requested_id = kUnassigned;
  announce(small_mission(2));
  Agent agent(anybody);
  for (int i = 1; i < 10; ++i) give(agent, status_of(0, i), at(0s));
  EXPECT_FALSE(agent.finished());
}

TEST(AgentJoining, OnceAdmittedItDoesNotGiveWay) {
  Agent agent = running_agent(small_mission(2));
  AgentStatus duplicate = status_of(0, 1);
  duplicate.header.incarnation = 77;
  for (duplicate.header.sequence = 1; duplicate.header.sequence < 10; ++duplicate.header.sequence) {
    give(agent, duplicate, at(0s));
  }
  EXPECT_FALSE(agent.finished());
}

TEST(AgentJoining, RefusesAPlanItCannotReadAndNamesTheRemedy) {
  Agent agent(identity_of(0));
  announced_plan = kNoPlan;
  give(agent, mission_part(0, MissionState::kWaiting, roster_of(1)), at(0s));
  EXPECT_TRUE(agent.finished());
  EXPECT_TRUE(agent.failed());
  EXPECT_EQ(agent.reason(), why_no_plan());
}

TEST(AgentJoining, ReportsWhatItWaitsFor) {
  const Mission mission = small_mission(2);
  announce(mission);
  Agent agent(identity_of(1));
  EXPECT_EQ(agent.blocked_reason(), "no coordinator answers");
  give(agent, mission_part(0, MissionState::kWaiting, roster_of(1)), at(0s));
  EXPECT_EQ(agent.blocked_reason(), "waiting to be admitted");
  give(agent, mission_part(1, MissionState::kWaiting, {{{1, 77}, 0, -1}}), at(0s));
  EXPECT_EQ(agent.blocked_reason(),
            "waiting to be admitted: the roster has another agent 1; if that one has stopped, the "
            "coordinator has not noticed it yet");
  give(agent, mission_part(2, MissionState::kWaiting, roster_of(2)), at(0s));
  EXPECT_EQ(agent.blocked_reason(), "admitted as agent 1, waiting for the quorum");
  give(agent, mission_part(3, MissionState::kRunning, roster_of(2)), at(0s));
  EXPECT_EQ(agent.blocked_reason(), "admitted as agent 1, waiting for the world");
  give(agent, world_state(0, mission.starts_m), at(0s));
  advance(agent, at(0s));
  EXPECT_EQ(agent.blocked_reason(), "");
  agent.leave("enough");
  EXPECT_EQ(agent.blocked_reason(), "");
}

TEST(Agent, IgnoresAndCountsAPlanThatIsNotItsRuns) {
  Agent agent = running_agent(small_mission(2));
  MissionPart other = mission_part(1000, MissionState::kFailed, {});
  other.plan.push_back(std::byte{9});
  give(agent, other, at(0s));
  EXPECT_FALSE(agent.finished());
  EXPECT_NE(agent.follower().revision(), 1000);
  EXPECT_EQ(agent.refused()[static_cast<std::size_t>(Refusal::kRange)], 1);
}

TEST(Agent, ReportsTheWorstLagOfItsLoopSinceItsLastStatusOnce) {
  Agent agent = running_agent(small_mission(2));
  for (const double lag_s : {0.1, 0.7, 0.2}) agent.note_loop_lag(lag_s);
  const auto sent = only<AgentStatus>(advance(agent, at(10s)));
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].loop_lag_s, 0.7);
  EXPECT_EQ(only<AgentStatus>(advance(agent, at(20s))).at(0).loop_lag_s, 0);
}

TEST(AgentJoining, NamesTheNewestMissionOfWhichItHasReceivedAPartAtOnce) {
  announce(small_mission(2));
  Agent agent(identity_of(0));
  const auto named = [&](Instant now) {
    const auto hellos = only<Hello>(advance(agent, now));
    return hellos.size() == 1 ? std::optional(hellos[0].revision) : std::nullopt;
  };
  EXPECT_EQ(named(at(0s)), -1) << "it knows no mission yet";
  MissionPart part = mission_part(5, MissionState::kWaiting, {});
  part.parts = 2;
  give(agent, part, at(50ms));
  EXPECT_EQ(named(at(50ms)), 5) << "the other part may be lost";
  give(agent, mission_part(4, MissionState::kWaiting, {}), at(55ms));
  EXPECT_EQ(named(at(100ms)), std::nullopt) << "an old one is no news";
  for (std::int64_t revision = 6; revision < 100; ++revision) {
    give(agent, mission_part(revision, MissionState::kWaiting, {}), at(101ms));
    advance(agent, at(101ms));
  }
  EXPECT_LE(agent.next_wakeup(), at(111ms)) << "but many are no reason to flood a bus";
  EXPECT_EQ(named(at(111ms)), 99);
}

}  // namespace
}  // namespace ergocast
