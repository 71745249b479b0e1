// SPDX-License-Identifier: BSD-3-Clause
// A coordinator that finds a mission already under way. It listens, takes over what the agents
// know, and never competes with another coordinator.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/coordinator/driven_coordinator.h"

namespace ergocast {
namespace {

using namespace test;

constexpr Incarnation kSuccessorLife = 0xc1;

Coordinator successor(Takeover takeover, RunId run = 0,
                      std::vector<std::byte> plan = encode_plan(small_mission(2))) {
  return {{run, kSuccessorLife, "here", kVersion}, std::move(plan), takeover};
}

/// An agent's copy of the predecessor's message at `tick`.
MissionPart memory_of(std::int64_t revision, std::vector<RosterEntry> roster = roster_of(2),
                      Tick tick = 0, MissionState state = MissionState::kRunning) {
  MissionPart part = mission_part(revision, state, std::move(roster));
  part.header.tick = tick;
  part.plan = encode_plan(small_mission(2));
  return part;
}

/// A coordinator that has taken over `memory`, at 1 s.
Coordinator taken_over(const MissionPart& memory) {
  Coordinator coordinator = successor(Takeover::kIfRunning, 0, memory.plan);
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  give(coordinator, memory, at(0s));
  advance(coordinator, at(1s));
  EXPECT_TRUE(coordinator.took_over());
  return coordinator;
}

/// A message that only a running coordinator sends.
TeamStatus alive(Incarnation incarnation, std::int64_t sequence = 1) {
  TeamStatus status;
  status.header = {kRun, kCoordinator, incarnation, sequence, 0};
  status.host = "there";
  return status;
}

const MissionPart& sent_by(const Outbox& out) {
  for (const Outgoing& outgoing : out) {
    if (const auto* part = std::get_if<MissionPart>(&outgoing.message)) return *part;
  }
  static const MissionPart nothing{};
  ADD_FAILURE() << "no mission was sent";
  return nothing;
}

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
  newest.holds = {{2, -1}};
  give(coordinator, newest, at(1200ms));
  EXPECT_LE(coordinator.next_wakeup(), at(1200ms));
  advance(coordinator, at(1200ms));
  ASSERT_TRUE(coordinator.took_over());
  EXPECT_EQ(coordinator.holds(), newest.holds) << "agents may have gone by it";
}

TEST(Takeover, WaitsForTheRevisionOfWhichItHasAPart) {
  MissionPart part = memory_of(13);
  part.parts = 2;
  Coordinator coordinator = that_lacks_the_newest(part);
  part.part = 1;
  part.plan = {};
  part.roster = {};
  part.holds = {{2, -1}};
  give(coordinator, part, at(1200ms));
  advance(coordinator, at(1200ms));
  ASSERT_TRUE(coordinator.took_over());
  EXPECT_EQ(coordinator.holds(), part.holds);
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
  memory.holds = {{2, -1}};
  Coordinator coordinator = taken_over(memory);
  ASSERT_EQ(coordinator.holds(), memory.holds);
  MissionPart repeated = memory_of(sent_by(advance(coordinator, at(2s))).revision + 1);
  repeated.holds = {{2, 9}};
  give(coordinator, repeated, at(3s));
  EXPECT_EQ(coordinator.holds(), repeated.holds) << "agents may have gone by it";
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
