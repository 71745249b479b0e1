// SPDX-License-Identifier: BSD-3-Clause
// What ends an agent, and its last messages.
#include <gtest/gtest.h>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

TEST(AgentEnd, AStopAtOnceEndsItAndTheLastStatusReportsItOnce) {
  for (const bool failed : {false, true}) {
    Agent agent = running_agent(small_mission(1));
    advance(agent, at(0s));
    const auto last = only<AgentStatus>(
        deliver(agent, Stop{{kRun, kOperator, 1, 1, 0}, failed, "enough", true}, at(1ms)));
    EXPECT_TRUE(agent.finished());
    EXPECT_EQ(agent.failed(), failed);
    EXPECT_EQ(agent.reason(), "enough");
    ASSERT_EQ(last.size(), 1u);
    EXPECT_EQ(last[0].phase, AgentPhase::kFinished);
    EXPECT_TRUE(deliver(agent, world_state(0, {{100, 500, 0}}), at(1h)).empty()) << "final";
  }
}

TEST(AgentEnd, AStopOfAnotherRunDoesNot) {
  Agent agent = running_agent(small_mission(1));
  give(agent, Stop{{kRun + 1, kOperator, 1, 1, 0}, false, "enough", true}, at(0s));
  EXPECT_FALSE(agent.finished());
}

TEST(AgentEnd, AStopInOrderIsTheCoordinatorsToObey) {
  Agent agent = running_agent(small_mission(1));
  give(agent, Stop{{kRun, kOperator, 1, 1, 0}, false, "enough"}, at(0s));
  EXPECT_FALSE(agent.finished());
}

TEST(AgentEnd, ItsLastCommandAfterAStopAtOnceIsToStandStill) {
  for (const bool had_answered : {false, true}) {
    Agent agent = running_agent(small_mission(2));
    advance(agent, at(0s));
    deliver(agent, world_state(0, {{100, 500, 0}, {200, 500, 0}}));
    if (had_answered) {
      Agent teammate = running_agent(small_mission(2), 1);
      advance(teammate, at(0s));
      for (const Contribution& block :
           only<Contribution>(deliver(teammate, world_state(0, {{100, 500, 0}, {200, 500, 0}})))) {
        deliver(agent, block);
      }
    }
    const auto last = only<Command>(
        deliver(agent, Stop{{kRun, kOperator, 1, 1, 0}, false, "enough", true}, at(1ms)));
    ASSERT_EQ(last.size(), 1u) << had_answered;
    EXPECT_EQ(last[0].velocity_mps, Eigen::Vector3d(0, 0, 0));
    EXPECT_EQ(last[0].position_m, Eigen::Vector3d(100, 500, 0));
    EXPECT_EQ(last[0].header.tick, 0);
    EXPECT_TRUE(advance(agent, at(2ms)).empty()) << "final";
  }
}

TEST(AgentEnd, TheMissionsEndIsItsEnd) {
  Agent done = running_agent(small_mission(1));
  give(done, mission_part(1, MissionState::kEnded, roster_of(1), "mission complete"), at(0s));
  EXPECT_TRUE(done.finished());
  EXPECT_FALSE(done.failed());
  Agent failed = running_agent(small_mission(1));
  give(failed, mission_part(1, MissionState::kFailed, roster_of(1), "agent 3 is late"), at(0s));
  EXPECT_TRUE(failed.finished());
  EXPECT_TRUE(failed.failed());
  EXPECT_EQ(failed.reason(), "agent 3 is late");
}

TEST(AgentEnd, LeavingIsNoFailure) {
  Agent agent = running_agent(small_mission(1));
  agent.leave("SIGTERM");
  EXPECT_TRUE(agent.finished());
  EXPECT_FALSE(agent.failed());
  EXPECT_EQ(only<AgentStatus>(advance(agent, at(0s))).at(0).phase, AgentPhase::kFinished);
}

TEST(AgentEnd, ComesByItselfOnceThePlansLastTickIsLongPastAndNoMessagesArrive) {
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.realtime_factor = 2;
  Agent agent = running_agent(mission);
  deliver(agent, world_state(40, {{100, 500, 0}}), at(5s));  // 60 ticks of 0.05 s are left
  give(agent, status_of(1, 1), at(37s));                     // a teammate may be cut off as we are
  advance(agent, at(38s));
  EXPECT_FALSE(agent.finished());
  const auto last = only<AgentStatus>(advance(agent, at(38s + 1ms)));
  EXPECT_TRUE(agent.finished());
  EXPECT_TRUE(agent.failed());
  EXPECT_EQ(agent.reason(),
            "nothing arrives from the world or the coordinator, and the mission must be over by "
            "now: check this host's network");
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0].phase, AgentPhase::kFinished);
}

TEST(AgentEnd, DoesNotComeWhileTheWorldOrTheCoordinatorSendsMessages) {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  for (auto now = 0s; now < 1h; now += 35s) {  // 10 s are planned
    give(agent, mission_part(0, MissionState::kRunning, roster_of(1)), at(now));
    advance(agent, at(now + 34s));
    EXPECT_FALSE(agent.finished());
  }
  for (auto now = 1h + 0s; now < 2h; now += 35s) {
    give(agent, world_state(7, {{100, 500, 0}}), at(now));
    advance(agent, at(now + 34s));
    EXPECT_FALSE(agent.finished());
  }
}

TEST(AgentEnd, ComesByItselfInLockstepOnceNoTickCouldHaveWaitedForIt) {
  Mission mission = small_mission(1);
  mission.timing.lockstep_timeout_s = 600;
  Agent agent = running_agent(mission);
  deliver(agent, world_state(0, {{100, 500, 0}}), at(5s));
  advance(agent, at(635s));
  EXPECT_FALSE(agent.finished());
  advance(agent, at(636s));
  EXPECT_TRUE(agent.finished());
}

TEST(AgentEnd, AnEvictedAgentStopsAtTheNamedTick) {
  std::vector<RosterEntry> roster = roster_of(2);
  roster[0].active_until = 3;
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  announce(mission);
  const MissionPart eviction = mission_part(1, MissionState::kRunning, roster);

  Agent there = running_agent(mission);
  deliver(there, world_state(3, {{100, 500, 0}}));
  give(there, eviction, at(0s));
  EXPECT_TRUE(there.finished());
  EXPECT_TRUE(there.failed());
  EXPECT_EQ(there.reason(), "evicted from the roster at tick 3");

  Agent behind = running_agent(mission);
  deliver(behind, world_state(1, {{100, 500, 0}}));
  give(behind, eviction, at(0s));
  EXPECT_EQ(only<Command>(deliver(behind, world_state(2, {{100, 500, 0}}))).size(), 1u);
  EXPECT_TRUE(only<Command>(deliver(behind, world_state(3, {{100, 500, 0}}))).empty());
  EXPECT_TRUE(behind.finished());
  EXPECT_EQ(behind.reason(), "evicted from the roster at tick 3");
}

}  // namespace
}  // namespace ergocast
