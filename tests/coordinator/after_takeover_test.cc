// SPDX-License-Identifier: BSD-3-Clause
// After a takeover: the successor leads the mission, and the coordinator before it yields.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/coordinator/successor.h"

namespace ergocast {
namespace {

using namespace test;

// ---- afterwards ----

TEST(TookOver, AllAgentsHaveTimeToSendAndTheTickHasItsTimeAnew) {
  Coordinator coordinator = taken_over(memory_of(3, roster_of(2), 7));
  for (const RosterEntry& entry : coordinator.roster()) {
    EXPECT_EQ(coordinator.member_state(entry, at(3999ms)), MemberState::kAlive);
    EXPECT_EQ(coordinator.member_state(entry, at(4s)), MemberState::kSilent);
  }
  advance(coordinator, at(10999ms));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
  advance(coordinator, at(11s));
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
}

TEST(TookOver, AnAgentItDoesNotKnowComesBackUnderItsIncarnation) {
  Coordinator coordinator = taken_over(memory_of(3, roster_of(1)));
  give(coordinator, world_where(12, {11, 11}), at(1s));
  give(coordinator, hello_of(1), at(1s));
  ASSERT_EQ(coordinator.roster().size(), 2u);
  EXPECT_EQ(coordinator.roster()[1].author, author_of(1));
  EXPECT_EQ(coordinator.roster()[1].active_from, 12);
}

TEST(TookOver, KnowsTheTickBeforeTheWorldSendsAgain) {
  // It knows the tick from the world's message during the search, or from the predecessor's last
  // one.
  for (const Tick remembered : {12, 3}) {
    Coordinator coordinator = successor(Takeover::kIfRunning);
    advance(coordinator, at(0s));
    give(coordinator, status_of(0, 1), at(0s));
    if (remembered < 12) give(coordinator, world_where(12, {11, 11}), at(100ms));
    give(coordinator, memory_of(3, roster_of(2), remembered), at(100ms));
    advance(coordinator, at(700ms));
    ASSERT_TRUE(coordinator.took_over());
    EXPECT_EQ(coordinator.tick(), 12);
    // The restarted agent's former incarnation covered twelve ticks, not none.
    give(coordinator, hello_of(1, 99), at(5s));
    ASSERT_EQ(coordinator.roster().size(), 3u);
    const auto former = std::find_if(coordinator.roster().begin(), coordinator.roster().end(),
                                     [](const RosterEntry& e) { return e.author == author_of(1); });
    EXPECT_EQ(former->active_until, 12);
  }
}

TEST(TookOver, KnowsTheTickThatOnlyTheAgentsHaveSeen) {
  // World and coordinator stopped together. The agents were ahead of the coordinator's last tick.
  Coordinator coordinator = successor(Takeover::kIfRunning);
  advance(coordinator, at(0s));
  AgentStatus status = status_of(0, 1);
  status.header.tick = 12;
  give(coordinator, status, at(0s));
  give(coordinator, memory_of(3, roster_of(2), 3), at(100ms));
  advance(coordinator, at(700ms));
  ASSERT_TRUE(coordinator.took_over());
  EXPECT_EQ(coordinator.tick(), 12);
}

TEST(TookOver, BelievesNoTickBeyondTheMissions) {
  Coordinator coordinator = successor(Takeover::kIfRunning);
  advance(coordinator, at(0s));
  AgentStatus status = status_of(0, 1);
  status.header.tick = 1'000'000;
  give(coordinator, status, at(0s));
  give(coordinator, memory_of(3), at(100ms));
  advance(coordinator, at(700ms));
  EXPECT_EQ(coordinator.tick(), 100);
}

TEST(TookOver, EndsTheMissionAtItsLastTickLikeItsPredecessor) {
  Coordinator coordinator = taken_over(memory_of(3));
  give(coordinator, world_where(100, {99, 99}), at(2s));
  EXPECT_EQ(coordinator.state(), MissionState::kEnded);
  EXPECT_EQ(coordinator.reason(), "mission complete");
}

// ---- the one that was taken over ----

TEST(TakenOver, ACoordinatorYieldsToANewerOneWithoutAMessage) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  advance(coordinator, at(1s));
  MissionPart newer = memory_of(1000);
  newer.header.incarnation = kSuccessorLife;
  give(coordinator, alive(kSuccessorLife), at(1400ms));
  give(coordinator, newer, at(1500ms));
  EXPECT_TRUE(coordinator.finished());
  EXPECT_EQ(coordinator.reason(), "another coordinator has taken the mission over");
  EXPECT_TRUE(advance(coordinator, at(3s)).empty()) << "the mission is not its to end";
}

TEST(TakenOver, ACoordinatorOutnumbersARepeatedRevisionOfAStoppedOne) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  advance(coordinator, at(1s));
  MissionPart repeated = memory_of(1000);
  repeated.header.incarnation = kSuccessorLife;
  give(coordinator, alive(kSuccessorLife), at(1s));
  give(coordinator, repeated, at(3s));  // by an agent, long after the coordinator's last message
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
  EXPECT_GT(sent_by(advance(coordinator, at(3s))).revision, 1000) << "or the team would not listen";
}

TEST(TakenOver, ACoordinatorAdoptsTheEndOfAPauseThatOnlyItsPredecessorHasNamed) {
  MissionPart memory = memory_of(3);
  memory.amendments = pauses({{2, -1}});
  Coordinator coordinator = taken_over(memory);
  ASSERT_EQ(coordinator.holds(), (std::vector<Hold>{{2, -1}}));
  MissionPart repeated = memory_of(sent_by(advance(coordinator, at(2s))).revision + 1);
  repeated.amendments = pauses({{2, 9}});
  give(coordinator, repeated, at(3s));
  EXPECT_EQ(coordinator.holds(), (std::vector<Hold>{{2, 9}})) << "agents may have gone by it";
}

TEST(TakenOver, ACoordinatorOutnumbersARevisionThatOnlyTheWorldNames) {
  Coordinator coordinator = taken_over(memory_of(3));
  const std::int64_t before = sent_by(advance(coordinator, at(2s))).revision;
  WorldState world = world_where(0, {0, 0});
  world.roster_revision = before + 8;
  give(coordinator, world, at(2s));
  EXPECT_EQ(sent_by(advance(coordinator, at(3s))).revision, before) << "its sender may still run";
  EXPECT_GT(sent_by(advance(coordinator, at(3600ms))).revision, before + 8);
  give(coordinator, world, at(3700ms));
  EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(3700ms))).empty()) << "once is enough";
}

TEST(TakenOver, ACoordinatorYieldsThoughTheWorldIsTheFirstToNameTheNewersRevision) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  WorldState world = world_where(0, {0, 0});
  world.roster_revision = 1000;
  give(coordinator, world, at(1s));
  for (std::chrono::milliseconds now{1100}; now < 4s; now += 200ms) {
    const Outbox out = advance(coordinator, at(now));
    for (const auto& part : only<MissionPart>(out)) ASSERT_LT(part.revision, 1000);
    give(coordinator, alive(kSuccessorLife, now.count()), at(now));
  }
  MissionPart newer = memory_of(1000);
  newer.header.incarnation = kSuccessorLife;
  give(coordinator, newer, at(4s));
  EXPECT_EQ(coordinator.reason(), "another coordinator has taken the mission over");
}

TEST(TakenOver, ARecordedSignOfLifeIsNone) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  give(coordinator, alive(kSuccessorLife, 7), at(1s));
  give(coordinator, alive(kSuccessorLife, 7), at(5s));
  MissionPart repeated = memory_of(1000);
  repeated.header.incarnation = kSuccessorLife;
  give(coordinator, repeated, at(5s));
  EXPECT_FALSE(coordinator.finished());
}

TEST(TakenOver, ACoordinatorIgnoresItsOwnAndOlderMessages) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  MissionPart echo = memory_of(1000);
  echo.header.incarnation = kCoordinatorLife;
  give(coordinator, echo, at(1s));
  MissionPart predecessors = memory_of(0);
  predecessors.header.incarnation = 0xc2;
  give(coordinator, predecessors, at(1s));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
}

TEST(TakenOver, OfTwoThatTakeOverAtOnceOneYields) {
  const auto both = [] {
    std::vector<Coordinator> two;
    for (const Incarnation incarnation : {kSuccessorLife, kSuccessorLife + 1}) {
      two.emplace_back(CoordinatorIdentity{0, incarnation, "here", kVersion},
                       encode_plan(small_mission(2)), Takeover::kIfRunning);
      advance(two.back(), at(0s));
      give(two.back(), status_of(0, 1), at(0s));
      give(two.back(), memory_of(5), at(0s));
    }
    return two;
  }();
  Coordinator one = both[0], other = both[1];
  const MissionPart ones = sent_by(advance(one, at(600ms)));
  const MissionPart others = sent_by(advance(other, at(600ms)));
  ASSERT_EQ(ones.revision, others.revision);
  give(one, alive(kSuccessorLife + 1), at(600ms));
  give(other, alive(kSuccessorLife), at(600ms));
  give(one, others, at(601ms));
  give(other, ones, at(601ms));
  EXPECT_NE(one.finished(), other.finished());
}

}  // namespace
}  // namespace ergocast
