// SPDX-License-Identifier: BSD-3-Clause
// A coordinator that finds a mission already under way. It listens, takes over what the agents
// know, and never competes with another coordinator.
#include <gtest/gtest.h>

#include "tests/coordinator/successor.h"

namespace ergocast {
namespace {

using namespace test;

// ---- listening ----

TEST(TakeoverNever, SendsAtOnce) {
  Coordinator coordinator = coordinator_of(small_mission(2));
  EXPECT_FALSE(only<MissionPart>(advance(coordinator, at(0s))).empty());
  EXPECT_FALSE(coordinator.took_over());
}

TEST(TakeoverIfRunning, StartsAMissionOfItsOwnAfterThreeQuartersOfASecondOfSilence) {
  Coordinator coordinator = successor(Takeover::kIfRunning);
  EXPECT_EQ(coordinator.next_wakeup(), Instant{}) << "at once, to listen";
  for (int ms = 0; ms < 750; ms += 10) EXPECT_TRUE(advance(coordinator, at(5s + ms * 1ms)).empty());
  EXPECT_LE(coordinator.next_wakeup(), at(5s + 750ms));
  const MissionPart own = sent_by(advance(coordinator, at(5s + 750ms)));
  EXPECT_EQ(own.header.run, kSuccessorLife);
  EXPECT_EQ(coordinator.run(), kSuccessorLife);
  EXPECT_EQ(coordinator.state(), MissionState::kWaiting);
  EXPECT_FALSE(coordinator.took_over());
}

TEST(TakeoverIfRunning, AgentsThatJoinOrHaveFinishedAreInNoMission) {
  Coordinator coordinator = successor(Takeover::kIfRunning);
  advance(coordinator, at(0s));
  for (const AgentPhase phase : {AgentPhase::kJoining, AgentPhase::kFinished}) {
    AgentStatus status = status_of(0, 1);
    status.phase = phase;
    give(coordinator, status, at(0s));
  }
  give(coordinator, hello_of(0), at(0s));
  EXPECT_EQ(coordinator.run(), 0u);
  advance(coordinator, at(750ms));
  EXPECT_EQ(coordinator.run(), kSuccessorLife);
}

TEST(Takeover, AsksTheAgentsFourTimesASecondOnceItKnowsTheRun) {
  Coordinator coordinator = successor(Takeover::kIfRunning);
  EXPECT_TRUE(advance(coordinator, at(0s)).empty()) << "whom?";
  give(coordinator, status_of(0, 1), at(200ms));
  EXPECT_EQ(coordinator.run(), kRun);
  int questions = 0;
  for (int ms = 250; ms < 2250; ms += 10) {
    for (const Outgoing& outgoing : advance(coordinator, at(ms * 1ms))) {
      const auto* question = std::get_if<Hello>(&outgoing.message);
      ASSERT_NE(question, nullptr) << "it has nothing else to send";
      EXPECT_EQ(outgoing.bus, Bus::kSwarm);
      EXPECT_EQ(question->header.run, kRun);
      EXPECT_EQ(question->header.sender, kCoordinator);
      EXPECT_EQ(question->header.tick, -1) << "it does not know the mission";
      ++questions;
    }
  }
  EXPECT_EQ(questions, 8);
}

TEST(Takeover, OfAGivenRunAsksBeforeItReceivesAnything) {
  Coordinator coordinator = successor(Takeover::kMust, kRun);
  EXPECT_EQ(only<Hello>(advance(coordinator, at(0s))).size(), 1u);
  AgentStatus foreign = status_of(0, 1);
  foreign.header.run = kRun + 1;
  give(coordinator, foreign, at(0s));
  EXPECT_EQ(coordinator.run(), kRun);
}

TEST(TakeoverMust, GivesUpAfterHalfAMinuteAndReportsOnlyWhy) {
  Coordinator coordinator = successor(Takeover::kMust, 0, {});
  for (int second = 0; second < 30; ++second) {
    EXPECT_TRUE(advance(coordinator, at(second * 1s)).empty());
    EXPECT_FALSE(coordinator.finished());
  }
  EXPECT_TRUE(advance(coordinator, at(30s)).empty());
  EXPECT_TRUE(coordinator.finished());
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
  EXPECT_EQ(coordinator.reason(), "no agent on this URL knows a mission to take over");
}

TEST(TakeoverIfRunning, DoesNotStartItsOwnBesideATeamThatDoesNotAnswer) {
  Coordinator coordinator = successor(Takeover::kIfRunning);
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  for (int ms = 0; ms < 30000; ms += 250) {
    EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(ms * 1ms))).empty());
  }
  advance(coordinator, at(30s));
  EXPECT_TRUE(coordinator.finished());
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
}

// ---- a running predecessor ----

constexpr const char* kLedByAnother =
    "run 0000000000001234 is led by the coordinator on there: leave it to that one, choose another "
    "URL, "
    "or take the mission over with --resume";

TEST(TakeoverIfRunning, LeavesAMissionToTheCoordinatorThatLeadsIt) {
  Coordinator coordinator = successor(Takeover::kIfRunning);
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  give(coordinator, alive(kCoordinatorLife), at(100ms));
  give(coordinator, memory_of(3), at(100ms));
  EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(700ms))).empty())
      << "and sends nothing to its team";
  EXPECT_TRUE(coordinator.finished());
  EXPECT_TRUE(coordinator.left());
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
  EXPECT_EQ(coordinator.reason(), kLedByAnother);
}

TEST(TakeoverIfRunning, LeavesALeaderAloneThatStillWaitsForItsFirstAgent) {
  Coordinator coordinator = successor(Takeover::kIfRunning);
  advance(coordinator, at(0s));
  give(coordinator, alive(kCoordinatorLife), at(100ms));
  EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(750ms))).empty());
  EXPECT_TRUE(coordinator.left());
  EXPECT_EQ(coordinator.reason(), kLedByAnother);
}

TEST(TakeoverIfRunning, AfterTheEndOfALeadersMissionStartsItsOwn) {
  Coordinator coordinator = successor(Takeover::kIfRunning);
  advance(coordinator, at(0s));
  TeamStatus farewell = alive(kCoordinatorLife, 2);
  farewell.state = MissionState::kEnded;
  give(coordinator, alive(kCoordinatorLife), at(0s));
  give(coordinator, farewell, at(100ms));
  EXPECT_EQ(sent_by(advance(coordinator, at(750ms))).header.run, kSuccessorLife);
}

TEST(TakeoverMust, TakesOverFromARunningOneToo) {
  Coordinator coordinator = successor(Takeover::kMust);
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  give(coordinator, alive(kCoordinatorLife), at(100ms));
  give(coordinator, memory_of(3), at(100ms));
  advance(coordinator, at(700ms));
  EXPECT_TRUE(coordinator.took_over());
}

// ---- what it takes over ----

TEST(Takeover, AdoptsTheNewestThatAnyProcessRemembers) {
  auto roster = roster_of(3);
  roster[0].active_until = 6;
  roster[0].forgotten = true;
  roster[0].since_tick = 9;
  roster[0].since_revision = 2;
  Coordinator coordinator = successor(Takeover::kIfRunning);
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  give(coordinator, memory_of(5), at(100ms));
  EXPECT_LE(coordinator.next_wakeup(), at(700ms)) << "a moment for other opinions";
  give(coordinator, memory_of(7, roster), at(250ms));
  give(coordinator, memory_of(6), at(260ms));
  EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(699ms))).empty());
  const MissionPart sent = sent_by(advance(coordinator, at(700ms)));
  EXPECT_TRUE(coordinator.took_over());
  EXPECT_EQ(sent.header.run, kRun);
  EXPECT_EQ(sent.header.incarnation, kSuccessorLife);
  EXPECT_GT(sent.revision, 7 + 100) << "the predecessor may have sent more than agents remember";
  EXPECT_EQ(sent.state, MissionState::kRunning);
  EXPECT_EQ(sent.plan, encode_plan(small_mission(2)));
  ASSERT_EQ(sent.roster.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(sent.roster[i].author, roster[i].author);
    EXPECT_EQ(sent.roster[i].active_from, roster[i].active_from);
    EXPECT_EQ(sent.roster[i].active_until, roster[i].active_until);
    EXPECT_EQ(sent.roster[i].forgotten, roster[i].forgotten);
    EXPECT_EQ(sent.roster[i].since_tick, roster[i].since_tick);
    EXPECT_EQ(sent.roster[i].since_revision, roster[i].since_revision);
  }
}

/// A coordinator that knows revision 11 and received a sign that the team may use revision 13.
Coordinator that_lacks_the_newest(const Message& sign) {
  Coordinator coordinator = successor(Takeover::kIfRunning);
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  give(coordinator, memory_of(11), at(0s));
  std::visit([&](const auto& message) { give(coordinator, message, at(100ms)); }, sign);
  advance(coordinator, at(1s));
  EXPECT_FALSE(coordinator.took_over());
  EXPECT_GT(coordinator.next_wakeup(), at(1s)) << "it sleeps meanwhile";
  return coordinator;
}

WorldState world_by(std::int64_t revision) {
  WorldState world = world_where(1, {1, 1});
  world.roster_revision = revision;
  return world;
}

TEST(Takeover, WaitsForTheRevisionThatTheWorldUses) {
  Coordinator coordinator = that_lacks_the_newest(world_by(13));
  MissionPart newest = memory_of(13);
  newest.amendments = pauses({{2, -1}});
  give(coordinator, newest, at(1200ms));
  EXPECT_LE(coordinator.next_wakeup(), at(1200ms));
  advance(coordinator, at(1200ms));
  ASSERT_TRUE(coordinator.took_over());
  EXPECT_EQ(coordinator.holds(), (std::vector<Hold>{{2, -1}})) << "agents may have gone by it";
}

TEST(Takeover, WaitsForTheRevisionOfWhichItHasAPart) {
  MissionPart part = memory_of(13);
  part.parts = 2;
  Coordinator coordinator = that_lacks_the_newest(part);
  part.part = 1;
  part.plan = {};
  part.roster = {};
  part.amendments = pauses({{2, -1}});
  give(coordinator, part, at(1200ms));
  advance(coordinator, at(1200ms));
  ASSERT_TRUE(coordinator.took_over());
  EXPECT_EQ(coordinator.holds(), (std::vector<Hold>{{2, -1}}));
}

TEST(Takeover, GoesOnWithoutARevisionThatNoProcessHasWhole) {
  Coordinator coordinator = that_lacks_the_newest(world_by(13));
  advance(coordinator, at(2900ms));
  EXPECT_FALSE(coordinator.took_over());
  EXPECT_EQ(coordinator.next_wakeup(), at(3s));
  const MissionPart ours = sent_by(advance(coordinator, at(3s)));
  ASSERT_TRUE(coordinator.took_over());
  EXPECT_GT(ours.revision, 13);
}

TEST(TakeoverMust, NeedsNoPlanOfItsOwn) {
  Coordinator coordinator = successor(Takeover::kMust, 0, {});
  EXPECT_EQ(coordinator.mission(), nullptr);
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  give(coordinator, memory_of(3), at(0s));
  EXPECT_EQ(sent_by(advance(coordinator, at(600ms))).plan, encode_plan(small_mission(2)));
  ASSERT_NE(coordinator.mission(), nullptr);
  EXPECT_EQ(coordinator.mission()->name, "small");
}

TEST(Takeover, OfAnotherVersionsPlanIsRefusedWithItsDecodersSentence) {
  Coordinator coordinator = successor(Takeover::kMust, 0, {});
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  MissionPart memory = memory_of(3);
  memory.plan = kNoPlan;
  give(coordinator, memory, at(0s));
  EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(600ms))).empty());
  EXPECT_TRUE(coordinator.finished());
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
  EXPECT_EQ(coordinator.reason(), "run 0000000000001234: " + why_no_plan());
}

TEST(Takeover, RefusesAnotherPlanWithASentenceAndLeavesItsTeamAlone) {
  for (const Takeover takeover : {Takeover::kIfRunning, Takeover::kMust}) {
    Coordinator coordinator = successor(takeover);
    advance(coordinator, at(0s));
    give(coordinator, status_of(0, 1), at(0s));
    MissionPart other = memory_of(3);
    Mission another = small_mission(2);
    another.seed = 8;
    other.plan = encode_plan(another);
    give(coordinator, other, at(0s));
    const Outbox out = advance(coordinator, at(600ms));
    EXPECT_TRUE(only<MissionPart>(out).empty());
    EXPECT_TRUE(coordinator.finished());
    EXPECT_EQ(coordinator.state(), MissionState::kFailed);
    EXPECT_EQ(coordinator.reason(),
              "run 0000000000001234 of another plan (small) is running on this URL: choose another "
              "URL, or wait for its end");
  }
}

TEST(Takeover, OfAMissionThatWaitsStartsItWhenTheQuorumIsThere) {
  Coordinator coordinator = taken_over(memory_of(3, roster_of(1), 0, MissionState::kWaiting));
  EXPECT_EQ(coordinator.state(), MissionState::kWaiting);
  give(coordinator, status_of(0, 2), at(1s));
  give(coordinator, hello_of(1), at(1s));
  EXPECT_EQ(sent_by(advance(coordinator, at(1s))).state, MissionState::kRunning);
}

TEST(Takeover, OfAMissionThatIsOverSendsItsEndForASecondAndIsDone) {
  Coordinator coordinator = taken_over(memory_of(3, roster_of(2), 0, MissionState::kEnded));
  EXPECT_EQ(sent_by(advance(coordinator, at(1100ms))).state, MissionState::kEnded);
  EXPECT_FALSE(coordinator.finished());
  advance(coordinator, at(2s));
  EXPECT_TRUE(coordinator.finished());
}

}  // namespace
}  // namespace ergocast
