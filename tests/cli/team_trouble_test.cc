// SPDX-License-Identifier: BSD-3-Clause
// Which agents and processes are late, silent, waiting or gone, and whether that is trouble.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "cli/team/team_view.h"
#include "tests/cli/watched_team.h"

namespace ergocast {
namespace {

using namespace test;

struct TeamViewRealtime : TeamViewTest {
  static Mission mission() {
    Mission mission = small_mission(4);
    mission.timing.pace = Pace::kRealtime;
    mission.timing.realtime_factor = 2;
    return mission;
  }
  TeamViewRealtime() : TeamViewTest(mission()) {}
};

TEST_F(TeamViewTest, AnAgentWithoutMessagesIsLateThenSilentAndStandsFirst) {
  hear_mission(at(0s));
  for (const auto time : {0s, 1s, 2s, 3s}) hear_all(at(time), 0, time > 0s ? 2 : kUnassigned);
  EXPECT_EQ(condition(2, at(900ms)), Condition::kOk);
  EXPECT_EQ(condition(2, at(1s)), Condition::kLate);
  EXPECT_EQ(condition(2, at(2999ms)), Condition::kLate);
  EXPECT_EQ(condition(2, at(3s)), Condition::kSilent);
  const TeamPicture picture = view_.picture(at(3s));
  EXPECT_EQ(picture.agents.front().author.agent, 2);
  EXPECT_EQ(picture.agents.front().silent_s, 3);
  EXPECT_EQ(picture.agents[1].author.agent, 0) << "the others in their order";
  EXPECT_EQ(picture.agents_alive, 3);
  EXPECT_TRUE(picture.trouble);
}

TEST_F(TeamViewTest, AMemberWithoutAnyMessageIsSilentSinceWeListen) {
  hear_mission(at(0s));
  hear_all(at(2s), 0, 3);
  EXPECT_EQ(condition(3, at(2900ms)), Condition::kUnheard);
  EXPECT_EQ(condition(3, at(3s)), Condition::kSilent);
  EXPECT_FALSE(row(3, at(3s)).status);
  EXPECT_EQ(row(3, at(3500ms)).silent_s, 3.5);
}

TEST_F(TeamViewTest, AReplayKeepsNoProcessAlive) {
  hear_mission(at(0s));
  give(view_, status(1, 7), at(0s));
  for (int i = 1; i < 10; ++i) give(view_, status(1, 7), at(i * 1s));
  EXPECT_EQ(row(1, at(9s)).silent_s, 9);
}

TEST_F(TeamViewTest, AnAgentThatWaitsIsNamedWithTheProcessThatItWaitsFor) {
  hear_mission(at(0s));
  AgentStatus waiting = status(1, 1, 5);
  waiting.waiting_for = 3;
  give(view_, waiting, at(0s));
  EXPECT_EQ(condition(1, at(0s)), Condition::kOk) << "in lockstep every agent waits now and then";
  waiting.header.sequence = 2;
  give(view_, waiting, at(800ms));
  EXPECT_EQ(condition(1, at(800ms)), Condition::kWaiting);
  waiting.header = {kRun, 1, incarnation_of(1), 3, 6};
  give(view_, waiting, at(900ms));
  EXPECT_EQ(condition(1, at(900ms)), Condition::kOk) << "it has moved on";
  waiting.header.sequence = 4;
  waiting.waiting_for = kWorld;
  give(view_, waiting, at(1s));
  EXPECT_EQ(condition(1, at(1s)), Condition::kWaiting)
      << "an agent itself reports it only after a while";
}

TEST_F(TeamViewTest, ASlowLoopIsLate) {
  hear_mission(at(0s));
  AgentStatus slow = status(1, 1);
  slow.loop_lag_s = 0.49;
  give(view_, slow, at(0s));
  EXPECT_EQ(condition(1, at(0s)), Condition::kOk);
  slow.header.sequence = 2;
  slow.loop_lag_s = 0.5;
  give(view_, slow, at(0s));
  EXPECT_EQ(condition(1, at(0s)), Condition::kLate);
}

TEST_F(TeamViewRealtime, AnAgentHalfASecondBehindTheWorldIsLate) {
  hear_mission(at(0s));
  // dt 0.1 s at twice the speed: ten ticks are half a second, and one is on its way.
  give(view_, world_state(51, {{1, 1, 0}}), at(0s));
  give(view_, status(0, 1, 41), at(0s));
  give(view_, status(1, 1, 40), at(0s));
  EXPECT_EQ(condition(0, at(0s)), Condition::kOk);
  EXPECT_EQ(condition(1, at(0s)), Condition::kLate);
}

TEST_F(TeamViewTest, ARestartedAgentIsOneRowThatCountsItsFormerIncarnations) {
  std::vector<RosterEntry> roster = roster_of(4);
  roster[1].active_until = 20;
  roster.push_back({{1, 71}, 20, 30});
  roster.push_back({{1, 7}, 30, -1});
  hear_mission(at(0s), roster);
  AgentStatus successor = status(1, 1, 35);
  successor.header.incarnation = 7;
  give(view_, successor, at(0s));
  const AgentRow one = row(1, at(0s));
  EXPECT_EQ(one.author.incarnation, 7u);
  EXPECT_EQ(one.restarts, 2);
  EXPECT_EQ(one.condition, Condition::kOk);
  EXPECT_EQ(view_.picture(at(0s)).agents.size(), 4u);
  EXPECT_EQ(row(0, at(0s)).restarts, 0);
}

TEST_F(TeamViewTest, AnAgentThatHasLeftForGoodIsGoneAndMissing) {
  std::vector<RosterEntry> roster = roster_of(4);
  roster[2].active_until = 20;
  hear_mission(at(0s), roster);
  hear_all(at(0s), 30, 2);
  EXPECT_EQ(condition(2, at(0s)), Condition::kGone);
  EXPECT_TRUE(view_.complete());
  const TeamPicture picture = view_.picture(at(0s));
  EXPECT_EQ(picture.agents.back().author.agent, 2);
  EXPECT_EQ(picture.agents_alive, 3);
  EXPECT_EQ(picture.agents_expected, 4);
  EXPECT_TRUE(picture.trouble);
}

TEST_F(TeamViewTest, AProcessThatFallsSilentIsTrouble) {
  for (const AgentId silent : {kCoordinator, kWorld, kLogger}) {
    announce(small_mission(1));
    TeamView view(kRun, at(0s));
    give(view, test::mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
    for (const auto time : {0s, 3s}) {
      give(view, status(0, sequence_of(at(time))), at(time));
      if (silent != kCoordinator || time == 0s) give(view, coordinator_at(0), at(time));
      if (silent != kWorld || time == 0s) give(view, world_state(0, {{1, 1, 0}}), at(time));
      if (silent != kLogger || time == 0s)
        give(view, RecordAck{{kRun, kLogger, kLoggerLife, next_sequence(), 0}}, at(time));
    }
    const TeamPicture picture = view.picture(at(3s));
    EXPECT_TRUE(picture.trouble) << silent;
    for (const ProcessRow& row : picture.processes) {
      EXPECT_EQ(row.trouble, row.silent_s == 3) << row.name;
    }
  }
}

TEST_F(TeamViewTest, BeforeTheStartAMissingWorldOrOptionalLoggerIsNoTrouble) {
  hear_mission(at(0s), roster_of(4), 0, MissionState::kWaiting);
  give(view_, coordinator_at(0), at(3s));
  for (AgentId id = 0; id < 4; ++id) give(view_, status(id, 1), at(3s));
  EXPECT_FALSE(view_.picture(at(3s)).trouble);
  EXPECT_TRUE(view_.complete());
}

TEST(TeamViewOfAReplay, JudgesSilenceByMissionTimeAlone) {
  TeamView view(kRun, at(0s), false, true);
  announce(small_mission(1));
  give(view, test::mission_part(0, MissionState::kRunning, roster_of(1), ""), at(0s));
  give(view, coordinator_at(0), at(0s));
  AgentStatus status = status_of(0, 1, 0);
  give(view, status, at(0s));
  const double dt_s = small_mission(1).timing.dt_s;
  give(view, world_state(static_cast<Tick>(5.9 / dt_s), {{1, 1, 0}}), at(60s));
  TeamPicture picture = view.picture(at(100s));
  EXPECT_TRUE(picture.replay);
  EXPECT_FALSE(picture.trouble);
  EXPECT_EQ(picture.agents_alive, 1);
  give(view, world_state(static_cast<Tick>(6.2 / dt_s), {{1, 1, 0}}), at(100s));
  picture = view.picture(at(100s));
  EXPECT_TRUE(picture.trouble);
  EXPECT_EQ(picture.agents.at(0).condition, Condition::kSilent);
  EXPECT_EQ(picture.agents_alive, 0);
}

}  // namespace
}  // namespace ergocast
