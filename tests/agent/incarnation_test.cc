// SPDX-License-Identifier: BSD-3-Clause
// How an agent joins, is replaced and ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

// ---- joining ----

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

// ---- restarts and the end ----

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
  paused.holds = {{1, -1}};
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
