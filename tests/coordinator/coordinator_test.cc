// SPDX-License-Identifier: BSD-3-Clause
// A coordinator whose mission runs, driven by hand: what it repeats, which agent a time-out names,
// and that the end reaches all processes.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/coordinator/driven_coordinator.h"

namespace ergocast {
namespace {

using namespace test;

// ---- what it repeats ----

TEST(CoordinatorRepeats, TheWholeMissionOnceASecondOnBothBuses) {
  Coordinator coordinator = running_coordinator(small_mission(1));
  for (int second = 1; second <= 3; ++second) {
    EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(second * 1s - 1ms))).empty());
    int on_bus[kBusCount] = {0, 0, 0};
    for (const Outgoing& out : advance(coordinator, at(second * 1s))) {
      if (std::holds_alternative<MissionPart>(out.message)) ++on_bus[static_cast<int>(out.bus)];
    }
    EXPECT_EQ(on_bus[static_cast<int>(Bus::kSwarm)], 1);
    EXPECT_EQ(on_bus[static_cast<int>(Bus::kCommand)], 1);
    EXPECT_EQ(on_bus[static_cast<int>(Bus::kWorld)], 0);
  }
}

TEST(CoordinatorRepeats, SoonerForAProcessThatLacksTheMissionButWithoutAFlood) {
  Coordinator coordinator = running_coordinator(small_mission(1));
  int missions = 0;
  for (int ms = 1; ms <= 1000; ++ms) {
    give(coordinator, hello_of(0), at(ms * 1ms));
    missions += static_cast<int>(only<MissionPart>(advance(coordinator, at(ms * 1ms))).size());
  }
  EXPECT_EQ(missions, 2 * 10) << "every 100 ms, on two buses";
}

TEST(CoordinatorRepeats, TheHostItRunsOn) {
  Coordinator coordinator = coordinator_of(small_mission(1));
  EXPECT_EQ(only<TeamStatus>(advance(coordinator, at(0s))).at(0).host, "here");
}

TEST(CoordinatorRepeats, PlansAndRostersOfAnySizeInPartsThatAFollowerPutsTogether) {
  Mission mission = small_mission(30);
  mission.domain.size_m.x() = 4000;
  mission.basis.modes_x = 12;
  mission.basis.modes_y = 10;
  mission.target_coefficients = Coefficients::Zero(120);
  mission.target_coefficients[0] = 1;
  Coordinator coordinator = coordinator_of(mission);
  admit_all(coordinator, 30, at(0s));
  const auto parts = only<MissionPart>(advance(coordinator, at(0s)));
  ASSERT_EQ(parts.size(), 2u * 5u) << "five parts on two buses";
  MissionFollower follower;
  for (const MissionPart& part : parts) {
    EXPECT_LE(part.roster.size(), static_cast<std::size_t>(kMaxRosterEntriesPerMessage));
    EXPECT_LE(part.plan.size(), static_cast<std::size_t>(kMaxPlanBytesPerMessage));
    follower.receive(part);
  }
  EXPECT_EQ(follower.plan(), encode_plan(mission));
  EXPECT_TRUE(follower.mission());
  ASSERT_EQ(follower.roster().size(), 30u);
  for (AgentId id = 0; id < 30; ++id)
    EXPECT_NE(follower.entry_of(incarnation_of(id)), nullptr) << id;
}

TEST(CoordinatorRepeats, ANewRevisionForEveryChange) {
  Coordinator coordinator = coordinator_of(small_mission(2));
  std::int64_t last = only<MissionPart>(advance(coordinator, at(0s))).at(0).revision;
  const auto next_revision = [&](Instant now) {
    const auto parts = only<MissionPart>(advance(coordinator, now));
    return parts.empty() ? -1 : parts[0].revision;
  };
  give(coordinator, hello_of(0), at(1ms));
  EXPECT_GT(next_revision(at(1ms)), last);
  last = next_revision(at(1001ms));
  EXPECT_GE(last, 0);
  give(coordinator, hello_of(1), at(1002ms));
  EXPECT_GT(next_revision(at(1002ms)), last) << "admission and start";
  last = next_revision(at(3s));
  coordinator.end(false, "enough", at(3s));
  EXPECT_GT(next_revision(at(3s)), last);
}

TEST(CoordinatorRepeats, HowTheTeamIs) {
  Coordinator coordinator = running_coordinator(small_mission(4));
  const double metrics[] = {9, 1, 3, 5};
  for (AgentId id = 0; id < 4; ++id) {
    AgentStatus status = status_of(id, 1, 0);
    status.ergodic_metric = metrics[id];
    give(coordinator, status, id == 2 ? at(0s) : at(2s));
  }
  WorldState world = world_where(7, {6, 6, 6, 6});
  world.missed_deadlines = 12;
  give(coordinator, world, at(2s));
  const auto teams = only<TeamStatus>(advance(coordinator, at(3s)));
  ASSERT_EQ(teams.size(), 1u);
  EXPECT_EQ(teams[0].state, MissionState::kRunning);
  EXPECT_EQ(teams[0].tick_count, 100);
  EXPECT_EQ(teams[0].header.tick, 7);
  EXPECT_EQ(teams[0].agents_alive, 3);
  EXPECT_EQ(teams[0].agents_expected, 4);
  EXPECT_EQ(teams[0].silent_agent, 2) << "silent for 3 s";
  EXPECT_EQ(teams[0].missed_deadlines, 12);
  EXPECT_TRUE(teams[0].ergodic_metric == 3 || teams[0].ergodic_metric == 5) << "a median";
}

// ---- time-outs ----

Mission impatient(int agents, OnTimeout on_timeout = OnTimeout::kEndMission) {
  Mission mission = small_mission(agents);
  mission.timing.lockstep_timeout_s = 10;
  mission.timing.on_timeout = on_timeout;
  return mission;
}

/// Each agent sends at `now` a status with the agent that it waits for.
void all_alive(Coordinator& coordinator, const std::vector<AgentId>& waiting_for, Instant now) {
  for (std::size_t id = 0; id < waiting_for.size(); ++id) {
    give(coordinator,
         status_of(static_cast<AgentId>(id), now.time_since_epoch().count() + 1, -1,
                   waiting_for[id]),
         now);
  }
}

TEST(CoordinatorTimeOut, NamesTheAgentThatHasNotAnsweredAndEndsTheMission) {
  Coordinator coordinator = running_coordinator(impatient(3));
  give(coordinator, world_where(5, {5, 4, 5}), at(1s));
  all_alive(coordinator, {-1, -1, -1}, at(10500ms));
  advance(coordinator, at(10999ms));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
  advance(coordinator, at(11s));
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
  EXPECT_NE(coordinator.reason().find("agent 1 has not answered tick 5"), std::string::npos)
      << coordinator.reason();
}

TEST(CoordinatorTimeOut, StartsAgainWithEveryTick) {
  Coordinator coordinator = running_coordinator(impatient(1));
  for (int i = 0; i < 5; ++i) {
    give(coordinator, world_where(i, {i - 1}), at(i * 9s));
    advance(coordinator, at(i * 9s + 8s));
    EXPECT_EQ(coordinator.state(), MissionState::kRunning);
  }
}

/// The tick at which this incarnation left, as the roster has it.
Tick until(const Coordinator& coordinator, const Author& author) {
  for (const RosterEntry& entry : coordinator.roster()) {
    if (entry.author == author) return entry.active_until;
  }
  ADD_FAILURE() << "no member";
  return 0;
}

TEST(CoordinatorTimeOut, StartsAgainWithAnAdmissionThatTheTickWaitsFor) {
  for (const OnTimeout on_timeout : {OnTimeout::kEndMission, OnTimeout::kEvict}) {
    Coordinator coordinator = running_coordinator(impatient(2, on_timeout));
    give(coordinator, world_where(5, {5, 4}), at(1s));
    all_alive(coordinator, {-1}, at(10s));
    advance(coordinator, at(10900ms));
    give(coordinator, hello_of(1, 99), at(10900ms));
    all_alive(coordinator, {-1}, at(20800ms));
    advance(coordinator, at(20899ms));
    EXPECT_EQ(coordinator.state(), MissionState::kRunning) << "its time has only begun";
    EXPECT_EQ(until(coordinator, {1, 99}), -1);
    advance(coordinator, at(20900ms));
    const bool evicts = on_timeout == OnTimeout::kEvict;
    EXPECT_EQ(coordinator.state(), evicts ? MissionState::kRunning : MissionState::kFailed);
    EXPECT_EQ(until(coordinator, {1, 99}), evicts ? 5 : -1);
  }
}

/// A starting world asks the team for its state, and waits for `whom`.
Hello question_of_world(Incarnation incarnation, AgentId whom) {
  return {{kRun, kWorld, incarnation, next_sequence(), 0}, whom, "", ""};
}

TEST(CoordinatorTimeOut, NamesTheAgentForWhichAWorldThatBeginsWaits) {
  for (const bool heard_a_world : {false, true}) {
    Coordinator coordinator = running_coordinator(impatient(3));
    // The former world had the answers of all agents but another one.
    if (heard_a_world) give(coordinator, world_where(5, {4, 5, 5}), at(0s));
    for (int tenths = 0; tenths <= 100; ++tenths) {
      const Instant now = at(tenths * 100ms);
      EXPECT_EQ(coordinator.state(), MissionState::kRunning);
      give(coordinator, question_of_world(kWorldLife + 1, 1), now);
      all_alive(coordinator, {kWorld, kWorld, kWorld}, now);
      advance(coordinator, now);
    }
    EXPECT_EQ(coordinator.state(), MissionState::kFailed);
    EXPECT_NE(coordinator.reason().find("agent 1 has not answered tick"), std::string::npos)
        << coordinator.reason();
  }
}

TEST(CoordinatorTimeOut, AcceptsTheWorldThatHasBegunOnceItSendsAState) {
  Coordinator coordinator = running_coordinator(impatient(2));
  give(coordinator, question_of_world(kWorldLife, 0), at(0s));
  give(coordinator, world_where(5, {5, 4}), at(500ms));
  all_alive(coordinator, {-1, -1}, at(10s));
  advance(coordinator, at(10500ms));
  EXPECT_NE(coordinator.reason().find("agent 1 has not answered tick 5"), std::string::npos)
      << coordinator.reason();
}

TEST(CoordinatorTimeOut, StartsAgainWithAWorldThatBeginsButNotWithARecordingOfOne) {
  Coordinator coordinator = running_coordinator(impatient(1));
  give(coordinator, world_where(5, {4}), at(0s));
  const Hello question = question_of_world(kWorldLife + 1, 0);
  give(coordinator, question, at(9s));
  for (int s = 9; s < 19; ++s) {
    give(coordinator, question, at(s * 1s));
    give(coordinator, question_of_world(kWorldLife + 1, 0), at(s * 1s));
    advance(coordinator, at(s * 1s));
    EXPECT_EQ(coordinator.state(), MissionState::kRunning) << s << " s";
  }
  advance(coordinator, at(19s));
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
}

TEST(CoordinatorTimeOut, IsNotPutOffByRepeatsOfTheSameTick) {
  Coordinator coordinator = running_coordinator(impatient(1));
  for (int i = 0; i <= 10; ++i) {
    give(coordinator, world_where(1, {0}), at(i * 1s));
    advance(coordinator, at(i * 1s));
  }
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
}

/// The agent that the reason names if no answer to tick 5 has arrived.
/// @param waiting_for  as each agent reports it
std::string blamed(const std::vector<AgentId>& waiting_for) {
  const auto agents = static_cast<int>(waiting_for.size());
  Coordinator coordinator = running_coordinator(impatient(agents));
  give(coordinator, world_where(5, std::vector<Tick>(waiting_for.size(), 4)), at(1s));
  all_alive(coordinator, waiting_for, at(10500ms));
  advance(coordinator, at(11s));
  return coordinator.reason().substr(0, coordinator.reason().find(" has"));
}

TEST(CoordinatorTimeOut, DoesNotBlameAnAgentThatWaitsForATeammate) {
  EXPECT_EQ(blamed({1, -1}), "agent 1");
  EXPECT_EQ(blamed({-1, 0}), "agent 0");
  EXPECT_EQ(blamed({2, 2, -1}), "agent 2");
  // 1 waits for 0, and 0 for 2, which is the end of the chain.
  EXPECT_EQ(blamed({2, 0, -1}), "agent 2");
  // Two agents that wait for each other: one of them must be named.
  EXPECT_EQ(blamed({1, 0}), "agent 0");
}

TEST(CoordinatorTimeOut, BlamesTheSilentFirstAndAmongThemTheOneSilentForLongest) {
  // 0 reports that it waits for 1. The last message of 1 is 2 s old; that of 2 is from the start.
  Coordinator coordinator = running_coordinator(impatient(3));
  give(coordinator, world_where(5, {4, 4, 4}), at(1s));
  give(coordinator, status_of(1, 1, 4), at(9s));
  give(coordinator, status_of(0, 1, 4, 1), at(10500ms));
  advance(coordinator, at(11s));
  EXPECT_NE(coordinator.reason().find("agent 2 has not answered tick 5"), std::string::npos)
      << coordinator.reason();
}

TEST(CoordinatorTimeOut, NamesTheWorldIfAllAgentsHaveAnswered) {
  Coordinator coordinator = running_coordinator(impatient(2));
  give(coordinator, world_where(5, {5, 5}), at(1s));
  all_alive(coordinator, {-1, -1}, at(10s));
  advance(coordinator, at(11s));
  EXPECT_NE(coordinator.reason().find("the world has not gone beyond tick 5"), std::string::npos)
      << coordinator.reason();
}

TEST(CoordinatorTimeOut, EvictsInsteadIfTheScenarioChoosesIt) {
  Coordinator coordinator = running_coordinator(impatient(2, OnTimeout::kEvict));
  give(coordinator, world_where(5, {5, 4}), at(1s));
  all_alive(coordinator, {-1, -1}, at(10s));
  const auto sent = only<MissionPart>(advance(coordinator, at(11s)));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
  ASSERT_FALSE(sent.empty());
  EXPECT_EQ(sent[0].roster[0].active_until, -1);
  EXPECT_EQ(sent[0].roster[1].active_until, 5) << "the tick it did not answer";
  advance(coordinator, at(20s));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning) << "the others have their time anew";
}

TEST(CoordinatorTimeOut, FailsWhenTheLastAgentIsEvicted) {
  Coordinator coordinator = running_coordinator(impatient(1, OnTimeout::kEvict));
  give(coordinator, world_where(5, {4}), at(1s));
  advance(coordinator, at(11s));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning) << "it may be restarted";
  advance(coordinator, at(21s));
  EXPECT_EQ(coordinator.state(), MissionState::kFailed);
  EXPECT_EQ(coordinator.reason(), "no agent is left to answer tick 5");
}

TEST(CoordinatorTimeOut, DoesNotExistInRealTime) {
  Mission mission = impatient(1);
  mission.timing.pace = Pace::kRealtime;
  Coordinator coordinator = running_coordinator(mission);
  give(coordinator, world_where(5, {4}), at(1s));
  advance(coordinator, at(1h));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
}

// ---- the end ----

TEST(CoordinatorEnds, WhenTheWorldHasReachedTheLastTick) {
  Coordinator coordinator = running_coordinator(small_mission(1));
  give(coordinator, world_where(99, {98}), at(1s));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
  give(coordinator, world_where(100, {99}), at(1s));
  EXPECT_EQ(coordinator.state(), MissionState::kEnded);
  EXPECT_EQ(coordinator.reason(), "mission complete");
}

TEST(CoordinatorEnds, IgnoresAWorldThatSendsOldTicks) {
  Coordinator coordinator = running_coordinator(impatient(1));
  give(coordinator, world_where(7, {6}), at(1s));
  give(coordinator, world_where(3, {3}), at(2s));
  EXPECT_EQ(coordinator.tick(), 7);
}

TEST(CoordinatorEnds, ByAStopWithItsReasonAndItsResult) {
  for (const bool failed : {false, true}) {
    Coordinator coordinator = running_coordinator(small_mission(1));
    give(coordinator, Stop{{kRun + 1, kOperator, 1, 1, 0}, failed, "not ours"}, at(1s));
    EXPECT_EQ(coordinator.state(), MissionState::kRunning);
    give(coordinator, Stop{{kRun, kOperator, 1, 1, 0}, failed, "enough"}, at(1s));
    EXPECT_EQ(coordinator.state(), failed ? MissionState::kFailed : MissionState::kEnded);
    EXPECT_EQ(coordinator.reason(), "enough");
  }
}

TEST(CoordinatorEnds, TheFirstEndIsFinal) {
  Coordinator coordinator = running_coordinator(small_mission(1));
  coordinator.end(false, "mission complete", at(1s));
  coordinator.end(true, "too late", at(2s));
  EXPECT_EQ(coordinator.state(), MissionState::kEnded);
  EXPECT_EQ(coordinator.reason(), "mission complete");
}

TEST(CoordinatorEnds, SendsTheEndTenTimesInASecondAndIsThenDone) {
  Coordinator coordinator = running_coordinator(small_mission(1));
  coordinator.end(true, "agent 3 is late", at(5s));
  int sent = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    for (const MissionPart& part : only<MissionPart>(advance(coordinator, at(5s + ms * 1ms)))) {
      EXPECT_EQ(part.state, MissionState::kFailed);
      EXPECT_EQ(part.reason, "agent 3 is late");
      ++sent;
    }
    ASSERT_FALSE(coordinator.finished());
  }
  EXPECT_EQ(sent, 2 * 10) << "on two buses";
  advance(coordinator, at(6s));
  EXPECT_TRUE(coordinator.finished());
}

TEST(CoordinatorEnds, WakesUpNoLaterThanItsNextMessage) {
  Coordinator coordinator = coordinator_of(small_mission(1));
  EXPECT_EQ(coordinator.next_wakeup(), Instant{}) << "at once, to begin";
  advance(coordinator, at(10s));
  EXPECT_EQ(coordinator.next_wakeup(), at(10s + 250ms)) << "the team's status";
  give(coordinator, hello_of(0), at(10s));
  EXPECT_LE(coordinator.next_wakeup(), at(10s)) << "a change is sent at once";
}

}  // namespace
}  // namespace ergocast
