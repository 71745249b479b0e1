// SPDX-License-Identifier: BSD-3-Clause
// The agents that the coordinator admits, their numbers, and the start of the mission.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "tests/coordinator/driven_coordinator.h"

namespace ergocast {
namespace {

using namespace test;

TEST(CoordinatorAdmits, EachAgentUnderTheNumberItAsksFor) {
  Coordinator coordinator = coordinator_of(small_mission(3));
  give(coordinator, hello_of(2), at(0s));
  give(coordinator, hello_of(0), at(0s));
  ASSERT_EQ(coordinator.roster().size(), 2u);
  EXPECT_EQ(coordinator.roster()[0].author, author_of(0)) << "in the order of numbers";
  EXPECT_EQ(coordinator.roster()[1].author, author_of(2));
  EXPECT_TRUE(coordinator.roster()[0].active_at(0));
}

TEST(CoordinatorAdmits, AnAgentWithoutAWishUnderTheLowestFreeNumber) {
  Coordinator coordinator = coordinator_of(small_mission(3));
  give(coordinator, hello_of(1), at(0s));
  give(coordinator, hello_of(kUnassigned, 71), at(0s));
  give(coordinator, hello_of(kUnassigned, 72), at(0s));
  ASSERT_EQ(coordinator.roster().size(), 3u);
  EXPECT_EQ(coordinator.roster()[0].author, (Author{0, 71}));
  EXPECT_EQ(coordinator.roster()[2].author, (Author{2, 72}));
}

TEST(CoordinatorAdmits, BeyondThePlanUnderTheNextNumberUpToTheLimit) {
  Coordinator coordinator = coordinator_of(small_mission(2));
  give(coordinator, hello_of(5), at(0s));
  for (Incarnation incarnation = 1; incarnation <= kMaxAgents + 72; ++incarnation) {
    give(coordinator, hello_of(kUnassigned, incarnation), at(0s));
  }
  ASSERT_EQ(coordinator.roster().size(), static_cast<std::size_t>(kMaxAgents));
  EXPECT_EQ(coordinator.roster()[2].author, (Author{2, 3})) << "the first beyond the plan";
  EXPECT_EQ(coordinator.roster()[5].author, author_of(5))
      << "an agent that asks for a number gets it";
  for (AgentId id = 0; id < kMaxAgents; ++id) {
    EXPECT_EQ(coordinator.roster()[static_cast<std::size_t>(id)].author.agent, id);
  }
}

TEST(CoordinatorAdmits, NoAgentUnderANumberThatDoesNotExist) {
  Coordinator coordinator = coordinator_of(small_mission(2));
  for (const AgentId id : {kMaxAgents, kMaxAgents + 70, -2, -70}) {
    give(coordinator, hello_of(id, 71), at(0s));
  }
  EXPECT_TRUE(coordinator.roster().empty());
}

TEST(CoordinatorAdmits, NoAgentOfAnotherMission) {
  Coordinator coordinator = coordinator_of(small_mission(2));
  Hello foreign = hello_of(0);
  foreign.header.run = kRun + 1;
  give(coordinator, foreign, at(0s));
  give(coordinator, hello_of(0, 0), at(0s));
  Hello no_agent = hello_of(0);
  no_agent.header.sender = kWorld;
  give(coordinator, no_agent, at(0s));
  EXPECT_TRUE(coordinator.roster().empty());
}

TEST(CoordinatorAdmits, OneProcessOnce) {
  Coordinator coordinator = coordinator_of(small_mission(3));
  for (int i = 0; i < 5; ++i) give(coordinator, hello_of(kUnassigned, 71), at(i * 1s));
  EXPECT_EQ(coordinator.roster().size(), 1u);
}

TEST(CoordinatorAdmits, NotTheYoungerOfTwoWithOneNumberWhileTheElderRuns) {
  Coordinator coordinator = coordinator_of(small_mission(2));
  give(coordinator, hello_of(0), at(0s));
  give(coordinator, hello_of(0, 99), at(1s));
  give(coordinator, status_of(0, 1), at(2s));
  give(coordinator, hello_of(0, 99), at(4900ms));
  ASSERT_EQ(coordinator.roster().size(), 1u);
  EXPECT_EQ(coordinator.roster()[0].author, author_of(0));
}

TEST(CoordinatorAdmits, ARestartedAgentOnceItsFormerIncarnationIsSilent) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  give(coordinator, world_where(7, {6, 6}), at(1s));
  give(coordinator, hello_of(0, 99), at(2999ms));
  EXPECT_EQ(coordinator.roster().size(), 2u);
  give(coordinator, hello_of(0, 99), at(3s));
  ASSERT_EQ(coordinator.roster().size(), 3u);
  const auto entry = [&](Incarnation incarnation) {
    return *std::find_if(coordinator.roster().begin(), coordinator.roster().end(),
                         [&](const auto& e) { return e.author.incarnation == incarnation; });
  };
  EXPECT_EQ(entry(incarnation_of(0)).active_until, 7) << "out at the tick at which";
  EXPECT_EQ(entry(99).active_from, 7) << "the other comes in";
  EXPECT_EQ(entry(99).active_until, -1);
}

TEST(CoordinatorAdmits, NoMoreIncarnationsOfANumberThanItsLimit) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  Instant now = at(0s);
  for (Incarnation incarnation = 5000; incarnation < 5000 + 2 * kMaxIncarnationsPerAgent;
       ++incarnation) {
    give(coordinator, status_of(1, static_cast<std::int64_t>(incarnation)), now += 4s);
    give(coordinator, hello_of(0, incarnation), now);
  }
  const auto incarnations =
      std::count_if(coordinator.roster().begin(), coordinator.roster().end(),
                    [](const RosterEntry& entry) { return entry.author.agent == 0; });
  EXPECT_EQ(incarnations, kMaxIncarnationsPerAgent);
}

TEST(CoordinatorAdmits, NoAgentToATickThatTheTeamHasCovered) {
  // The coordinator did not receive the world's last state, and the world stopped.
  Coordinator coordinator = running_coordinator(small_mission(2));
  give(coordinator, world_where(7, {6, 6}), at(1s));
  AgentStatus status = status_of(1, 1);
  status.header.tick = 8;
  give(coordinator, status, at(1s));
  give(coordinator, hello_of(0, 99), at(3s));
  ASSERT_EQ(coordinator.roster().size(), 3u);
  for (const RosterEntry& entry : coordinator.roster()) {
    if (entry.author == author_of(1)) continue;
    EXPECT_EQ(entry.author == author_of(0) ? entry.active_until : entry.active_from, 8);
  }
}

// A container engine restarts a stopped agent within a second and does not pass on its number.
TEST(CoordinatorAdmits, AnAgentWithoutAWishAsTheSuccessorOfOneThatFallsSilent) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  const auto ask_at = [&](Instant now) {
    give(coordinator, hello_of(kUnassigned, 99), now);
    return coordinator.roster().size();
  };
  EXPECT_EQ(ask_at(at(500ms)), 2u);
  give(coordinator, status_of(1, 1), at(600ms));
  EXPECT_EQ(ask_at(at(2999ms)), 2u) << "agent 0 may be dead";
  ASSERT_EQ(ask_at(at(3s)), 3u);
  EXPECT_TRUE(
      std::any_of(coordinator.roster().begin(), coordinator.roster().end(), [](const auto& entry) {
        return entry.author == Author{0, 99};
      }));
}

TEST(CoordinatorAdmits, AnAgentWithoutAWishOnceAllMembersHaveSentAStatus) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  give(coordinator, hello_of(kUnassigned, 99), at(500ms));
  give(coordinator, status_of(0, 1), at(600ms));
  give(coordinator, status_of(1, 1), at(600ms));
  give(coordinator, hello_of(kUnassigned, 99), at(700ms));
  ASSERT_EQ(coordinator.roster().size(), 3u);
  EXPECT_EQ(coordinator.roster()[2].author, (Author{2, 99}));
}

TEST(CoordinatorAdmits, AReplayedStatusKeepsNoAgentAlive) {
  Coordinator coordinator = coordinator_of(small_mission(1));
  give(coordinator, hello_of(0), at(0s));
  give(coordinator, status_of(0, 5), at(1s));
  give(coordinator, status_of(0, 5), at(3s));
  give(coordinator, status_of(0, 4), at(3s));
  give(coordinator, hello_of(0, 99), at(4s));
  EXPECT_EQ(coordinator.roster().size(), 2u);
}

// ---- what a newcomer knows ----

/// The newest revision that it sends until `now`.
std::int64_t newest_sent(Coordinator& coordinator, Instant now) {
  for (const MissionPart& part : only<MissionPart>(advance(coordinator, now))) return part.revision;
  ADD_FAILURE() << "no MISSION was sent";
  return -1;
}

TEST(CoordinatorAdmits, NoAgentWithoutTheNewestMissionAndRepeatsItSoon) {
  Coordinator coordinator = coordinator_of(small_mission(2));
  EXPECT_EQ(newest_sent(coordinator, at(0s)), 0);
  give(coordinator, hello_of(0, 71, -1), at(10ms));
  EXPECT_TRUE(coordinator.roster().empty());
  EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(99ms))).empty()) << "hellos flood no bus";
  EXPECT_EQ(newest_sent(coordinator, at(100ms)), 0);
  give(coordinator, hello_of(0, 71, 0), at(110ms));
  EXPECT_EQ(coordinator.roster().size(), 1u);
}

TEST(CoordinatorAdmits, ManyAtOnceThatKnowTheNewestRevision) {
  Coordinator coordinator = coordinator_of(small_mission(20));
  const std::int64_t known = newest_sent(coordinator, at(0s));
  for (AgentId id = 0; id < 20; ++id)
    give(coordinator, hello_of(id, incarnation_of(id), known), at(1ms));
  EXPECT_EQ(coordinator.roster().size(), 20u);
}

// An agent waited for the number of a running agent and gave up; its messages were recorded.
TEST(CoordinatorAdmits, NoAgentByAHelloFromBeforeTheHolderFellSilent) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  const std::int64_t known = newest_sent(coordinator, at(1s));
  give(coordinator, hello_of(0, 99, known), at(1s));
  advance(coordinator, at(2500ms));
  give(coordinator, hello_of(0, 99, known), at(3400ms));
  EXPECT_EQ(coordinator.roster().size(), 2u) << "and not before it has noticed the silence either";
  const std::int64_t newer = newest_sent(coordinator, at(3400ms));
  EXPECT_GT(newer, known) << "a silence is news";
  give(coordinator, hello_of(0, 99, known), at(3500ms));
  EXPECT_EQ(coordinator.roster().size(), 2u);
  give(coordinator, hello_of(0, 99, newer), at(3500ms));
  EXPECT_EQ(coordinator.roster().size(), 3u) << "the agent that still waits there";
}

// On a network with long delays, members fall silent and return faster than any HELLO arrives.
TEST(CoordinatorAdmits, OthersThoughAMemberFellSilentSinceTheirHello) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  const std::int64_t known = newest_sent(coordinator, at(1s));
  EXPECT_GT(newest_sent(coordinator, at(3400ms)), known) << "a silence is news";
  give(coordinator, hello_of(5, 99, known), at(3500ms));
  EXPECT_EQ(coordinator.roster().size(), 3u);
}

TEST(CoordinatorAdmits, NoAgentByAMessageToItsPredecessor) {
  announce(small_mission(2));
  Coordinator coordinator({0, 0xc1, "here", kVersion}, announced_plan, Takeover::kMust);
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  MissionPart memory = mission_part(7, MissionState::kRunning, roster_of(2));
  give(coordinator, memory, at(0s));
  const std::int64_t newest = newest_sent(coordinator, at(1s));
  give(coordinator, hello_of(5, 99, 8), at(1s));
  EXPECT_EQ(coordinator.roster().size(), 2u);
  give(coordinator, hello_of(5, 99, newest), at(1s));
  EXPECT_EQ(coordinator.roster().size(), 3u);
}

TEST(CoordinatorAdmits, NoAgentOnceTheMissionIsOver) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  coordinator.end(false, "enough", at(1s));
  give(coordinator, hello_of(0, 99), at(10s));
  EXPECT_EQ(coordinator.roster().size(), 2u);
}

TEST(CoordinatorAdmits, ABoundedNumberOfIncarnations) {
  Coordinator coordinator = coordinator_of(small_mission(1));
  for (Incarnation incarnation = 1; incarnation <= 2000; ++incarnation) {
    give(coordinator, hello_of(0, incarnation), at(std::chrono::seconds(10 * incarnation)));
  }
  EXPECT_LE(coordinator.roster().size(), 4u * kMaxAgents);
}

TEST(CoordinatorAdmits, OnlyItsOwnVersionAndItRemembersRefusedHosts) {
  Coordinator coordinator = coordinator_of(small_mission(2));
  Hello hello = hello_of(0);
  hello.version = "9.9.9";
  give(coordinator, hello, at(0s));
  give(coordinator, hello, at(0s));
  EXPECT_TRUE(coordinator.roster().empty());
  EXPECT_EQ(coordinator.version_mismatches(),
            (std::set<std::pair<std::string, std::string>>{{"somewhere", "9.9.9"}}));
  for (int i = 0; i < 1000; ++i) {
    hello.host = std::to_string(i);
    give(coordinator, hello, at(0s));
  }
  EXPECT_EQ(coordinator.version_mismatches().size(), 64u) << "invented hosts cost no memory";
  give(coordinator, hello_of(0), at(0s));
  EXPECT_EQ(coordinator.roster().size(), 1u);
}

Mission mission_of_two_kinds() {
  Mission mission = small_mission(4);
  const double u_max_mps = mission.law.u_max_mps;
  mission.kinds = {{"fast", 3, u_max_mps}, {"fine", 1, u_max_mps}};
  return mission;
}

Hello hello_of_kind(AgentId id, Incarnation incarnation, const std::string& kind) {
  Hello hello = hello_of(id, incarnation);
  hello.kind = kind;
  return hello;
}

TEST(CoordinatorAdmits, EachAgentAsTheKindThatItBringsOrThatIsPlanned) {
  Coordinator coordinator = coordinator_of(mission_of_two_kinds());
  give(coordinator, hello_of(0, 10), at(0s));
  give(coordinator, hello_of_kind(1, 11, "fine"), at(0s));
  give(coordinator, hello_of(3, 13), at(0s));
  ASSERT_EQ(coordinator.roster().size(), 3u);
  EXPECT_EQ(coordinator.roster()[0].kind, 0);
  EXPECT_EQ(coordinator.roster()[1].kind, 1) << "brought";
  EXPECT_EQ(coordinator.roster()[2].kind, 1) << "planned";
}

TEST(CoordinatorAdmits, ANewcomerOfAKindOnlyWhereThePlanHasNoOther) {
  Coordinator coordinator = coordinator_of(mission_of_two_kinds());
  for (const Incarnation incarnation : {10, 11}) {
    give(coordinator, hello_of_kind(kUnassigned, incarnation, "fine"), at(0s));
    give(coordinator, hello_of_kind(kUnassigned, incarnation, "fine"), at(1s));
  }
  ASSERT_EQ(coordinator.roster().size(), 2u);
  EXPECT_EQ(coordinator.roster()[0].author, (Author{3, 10}));
  EXPECT_EQ(coordinator.roster()[1].author, (Author{4, 11})) << "beyond the plan";
}

TEST(CoordinatorAdmits, NoKindThatTheMissionDoesNotHave) {
  Coordinator coordinator = coordinator_of(mission_of_two_kinds());
  give(coordinator, hello_of_kind(0, 10, "slow"), at(0s));
  EXPECT_TRUE(coordinator.roster().empty());
  EXPECT_EQ(coordinator.unknown_kinds(),
            (std::set<std::pair<std::string, std::string>>{
                {"somewhere", "the mission has no kind \"slow\": its kinds are fast, fine"}}));
  Coordinator of_alike = coordinator_of(small_mission(1));
  give(of_alike, hello_of_kind(0, 10, "slow"), at(0s));
  EXPECT_TRUE(of_alike.roster().empty());
}

TEST(CoordinatorAdmits, NoAgentToABodyThatIsAnotherVehicleThanItsKinds) {
  Mission mission = mission_of_two_kinds();
  mission.speed_limit_mps = 20;
  mission.kinds[1].speed_limit_mps = 10;
  Coordinator coordinator = coordinator_of(mission);
  give(coordinator, hello_of_kind(1, 11, "fine"), at(0s));
  EXPECT_TRUE(coordinator.roster().empty());
  ASSERT_EQ(coordinator.unknown_kinds().size(), 1u);
  EXPECT_NE(coordinator.unknown_kinds().begin()->second.find("cannot drive number 1"),
            std::string::npos);
  for (const Incarnation incarnation : {12, 13}) {
    give(coordinator, hello_of_kind(kUnassigned, incarnation, "fine"), at(0s));
    give(coordinator, hello_of_kind(kUnassigned, incarnation, "fine"), at(1s));
  }
  ASSERT_EQ(coordinator.roster().size(), 1u) << "beyond the plan are vehicles of the first kind";
  EXPECT_EQ(coordinator.roster()[0].author, (Author{3, 12}));
}

TEST(CoordinatorAdmits, ASuccessorOfAnotherKindBesideItsPredecessorsEntry) {
  Coordinator coordinator = running_coordinator(mission_of_two_kinds());
  give(coordinator, hello_of_kind(0, 99, "fine"), at(60s));
  ASSERT_EQ(coordinator.roster().size(), 5u);
  for (const RosterEntry& entry : coordinator.roster()) {
    const bool is_fine = entry.author.incarnation == 99 || entry.author.agent == 3;
    EXPECT_EQ(entry.kind, is_fine ? 1 : 0) << entry.author.agent;
  }
}

TEST(CoordinatorStarts, WhenTheQuorumIsThereAndNotBefore) {
  Mission mission = small_mission(4);
  mission.quorum = 3;
  Coordinator coordinator = coordinator_of(mission);
  admit_all(coordinator, 2, at(0s));
  advance(coordinator, at(1s));
  EXPECT_EQ(coordinator.state(), MissionState::kWaiting);
  give(coordinator, hello_of(3), at(1s));
  const auto sent = only<MissionPart>(advance(coordinator, at(1s)));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
  ASSERT_FALSE(sent.empty()) << "and reports it at once";
  EXPECT_EQ(sent[0].state, MissionState::kRunning);
}

TEST(CoordinatorStarts, DoesNotCountAgentsThatHaveStoppedMeanwhile) {
  Coordinator coordinator = coordinator_of(small_mission(2));
  give(coordinator, hello_of(0), at(0s));
  give(coordinator, hello_of(1), at(4s));
  advance(coordinator, at(4s));
  EXPECT_EQ(coordinator.state(), MissionState::kWaiting);
  give(coordinator, status_of(0, 1), at(4s));
  advance(coordinator, at(4s));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
}

TEST(CoordinatorStarts, OrFailsByATimeOutThatNamesTheMissingAgents) {
  Mission mission = small_mission(4);
  mission.quorum = 3;
  mission.timing.admission_timeout_s = 20;
  Coordinator coordinator = coordinator_of(mission);
  advance(coordinator, at(100s));
  give(coordinator, hello_of(1), at(100s));
  give(coordinator, hello_of(2), at(100s));
  advance(coordinator, at(119999ms));
  EXPECT_EQ(coordinator.state(), MissionState::kWaiting);
  give(coordinator, status_of(1, 1), at(119s));
  advance(coordinator, at(120s));
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
  EXPECT_EQ(coordinator.reason(),
            "only 1 of the quorum of 3 agents were admitted; missing: 0, 2, 3")
      << "2 came and fell silent";
}

}  // namespace
}  // namespace ergocast
