// SPDX-License-Identifier: BSD-3-Clause
// The summary is valid JSON for any bytes, and its text on the mission's goal has only known facts.
#include "logger/summary.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/team.h"

namespace ergocast::test {
namespace {

TEST(Summary, IsWrittenWhateverBytesTheNetworkBrought) {
  std::ostringstream trajectory, metrics;
  announce(small_mission(1));
  Recorder recorder(kRun, kLoggerLife, trajectory, metrics);
  give(recorder, mission_part(1, MissionState::kRunning, roster_of(1)), at(0s));
  give(recorder, Stop{{kRun, kOperator, 1, 1, 0}, true, "caf\xe9", true}, at(0s));
  const auto read = nlohmann::json::parse(to_text(summarize(recorder, {})));
  EXPECT_EQ(read["result"], "failed");
  EXPECT_EQ(read["reason"], "caf\xef\xbf\xbd") << "the replacement character";
}

/// The summary's text on the goal after one recorded tick.
nlohmann::ordered_json goal_after_a_tick(double goal_ergodic_metric) {
  Mission mission = small_mission(1);
  mission.goal_ergodic_metric = goal_ergodic_metric;
  std::ostringstream trajectory, metrics;
  announce(mission);
  Recorder recorder(kRun, kLoggerLife, trajectory, metrics);
  give(recorder, mission_part(1, MissionState::kRunning, roster_of(1)), at(0s));
  for (const Tick tick : {0, 1}) give(recorder, world_state(tick, {{100, 500, 0}}), at(0s));
  advance(recorder, at(0s));
  const auto summary = summarize(recorder, {});
  return summary.contains("goal") ? summary["goal"] : nlohmann::ordered_json();
}

TEST(Summary, ReportsWhetherTheGoalIsReachedIfThereIsOne) {
  EXPECT_TRUE(goal_after_a_tick(0).is_null());
  EXPECT_EQ(goal_after_a_tick(1e6)["reached"], true);
  EXPECT_EQ(goal_after_a_tick(1e-6)["reached"], false);
  EXPECT_EQ(goal_after_a_tick(1e-6)["ergodic_metric"], 1e-6);
}

/// The second of two agents answers from tick 10 on.
TEST(Summary, ReportsHowMuchADistanceHasCost) {
  Mission mission = small_mission(2);
  mission.speed_limit_mps = 40;
  mission.separation.distance_m = 30;
  for (const bool apart : {true, false}) {
    if (!apart) mission.separation = {};
    std::ostringstream trajectory, metrics;
    announce(mission);
    Recorder recorder(kRun, kLoggerLife, trajectory, metrics);
    std::vector<RosterEntry> roster = roster_of(2);
    roster[1].active_from = 10;
    give(recorder, mission_part(1, MissionState::kRunning, roster), at(0s));
    for (const AgentId id : {0, 1}) {
      AgentStatus status = status_of(id, 1, 29);
      status.blocked_ticks = 5 * (id + 1);
      status.longest_block_ticks = 4 - id;
      give(recorder, status, at(0s));
    }
    const auto summary = summarize(recorder, {});
    ASSERT_EQ(summary.contains("separation"), apart);
    ASSERT_EQ(summary["agents"][1].contains("blocked_ticks"), apart);
    if (!apart) continue;
    EXPECT_EQ(summary["separation"]["distance_m"], 30);
    EXPECT_EQ(summary["separation"]["blocked_share"], 15.0 / 50);
    EXPECT_EQ(summary["separation"]["longest_block_s"], 4 * mission.timing.dt_s);
    EXPECT_EQ(summary["agents"][1]["blocked_ticks"], 10);
    EXPECT_EQ(summary["agents"][1]["longest_block_ticks"], 3);
  }
}

TEST(Summary, LeavesOutWhatIsNotKnown) {
  std::ostringstream trajectory, metrics;
  announce(small_mission(1));
  const Recorder recorder(kRun, kLoggerLife, trajectory, metrics);
  const auto summary = summarize(recorder, {});
  EXPECT_EQ(summary["result"], "stopped");
  EXPECT_EQ(summary["ticks"], 0);
  EXPECT_TRUE(summary["ergodic_metric"]["first"].is_null());
  EXPECT_TRUE(summary["log_log_slope"].is_null());
  EXPECT_TRUE(summary["ticks_per_s"].is_null());
  EXPECT_TRUE(summary["agents"].empty());
}

}  // namespace
}  // namespace ergocast::test
