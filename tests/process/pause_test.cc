// SPDX-License-Identifier: BSD-3-Clause
// `ergocast pause` and `ergocast resume`: real processes stop between two ticks and continue, even
// if one restarts meanwhile.
#include <algorithm>

#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

class PauseCommand : public RunningMission {
 protected:
  int send_command(const std::string& command) { return ergocast({command, "--lcm-url", kUrl}); }
  /// The text after "at tick " in the output: the tick and the time.
  std::string time_said() const {
    const std::string printed = output();
    const auto at = printed.find("at tick ") + 8, end = printed.find(" s", at);
    return printed.substr(at, end - at);
  }
  /// `status --json` has the time that counts, as `status` has, and also the world's tick.
  void expect_one_clock() {
    ergocast({"status", "--json", "--lcm-url", kUrl});
    const auto json = nlohmann::json::parse(output());
    Tick held = 0;
    for (const auto& hold : json["holds"]) held += hold[1].get<Tick>() - hold[0].get<Tick>();
    EXPECT_GT(held, 0);
    EXPECT_EQ(json["tick"].get<Tick>() + held, json["world_tick"]) << output();
    EXPECT_DOUBLE_EQ(json["t_s"], json["tick"].get<double>() * 0.1);
    EXPECT_FALSE(json.contains("counted_ticks"));
  }
  /// From the state of the team that `ergocast status` shows.
  bool shown(const std::string& part) {
    ergocast({"status", "--lcm-url", kUrl});
    return answered(part);
  }
  /// Whether all vehicles stand in each recorded tick between, and all rows count outside.
  void expect_standing(Tick from, Tick until) {
    int rows = 0;
    for (const auto& [tick, row] : recorded_rows(out())) {
      if (tick < from || tick >= until) continue;
      for (const auto& [id, one] : row) {
        EXPECT_TRUE(one.stands()) << "agent " << id << " at tick " << tick;
        ++rows;
      }
    }
    EXPECT_GE(rows, 4);
  }
};

TEST_F(PauseCommand, HoldsAMissionInLockstepWhichItsSimulationRepeats) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  EXPECT_EQ(send_command("resume"), 0) << output();
  EXPECT_TRUE(answered("is not paused")) << output();
  ASSERT_EQ(send_command("pause"), 0) << output();
  EXPECT_TRUE(answered("paused at tick ")) << output();
  const std::string paused_at = time_said();
  EXPECT_TRUE(shown("paused, tick " + paused_at.substr(0, paused_at.find(',')) + " of "))
      << output();
  EXPECT_TRUE(logs("coordinator", "mission is paused from tick ")) << printed();
  EXPECT_EQ(send_command("pause"), 0) << output();
  EXPECT_TRUE(answered("paused already")) << output();
  signal_to({"ergocast-coordinator"}, SIGKILL);
  ASSERT_TRUE(eventually([&] { return send_command("resume") == 0; })) << output();
  EXPECT_TRUE(answered("goes on at tick ")) << output();
  EXPECT_EQ(time_said(), paused_at) << "no mission time passes";
  ASSERT_TRUE(moves_on());
  expect_one_clock();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  const auto holds = summary()["holds"];
  ASSERT_EQ(holds.size(), 1U);
  const Tick from = holds[0][0], until = holds[0][1];
  EXPECT_LT(from, until);
  EXPECT_EQ(summary()["held_ticks"], until - from);
  EXPECT_EQ(summary()["amendments"].size(), 2U);
  expect_standing(from, until);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(PauseCommand, HoldsAMissionInRealTimeInWhichAnAgentRestarts) {
  Child mission =
      launch_endless(scenario("pace: REALTIME realtime_factor: 10"), {"--lcm-url", kUrl});
  ASSERT_EQ(send_command("pause"), 0) << output();
  signal_to(agent(2), SIGKILL);
  ASSERT_TRUE(eventually([&] { return shown("4 of 4 agents alive") && shown("paused, tick "); }))
      << output();
  ASSERT_EQ(send_command("resume"), 0) << output();
  ASSERT_TRUE(moves_on());
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  const auto holds = summary()["holds"];
  ASSERT_EQ(holds.size(), 1U);
  // A command may be late by the time for which old ones are held.
  expect_standing(holds[0][0].get<Tick>() + 10, holds[0][1]);
}

TEST_F(PauseCommand, WaitsUntilAllVehiclesStand) {
  const auto slow = scenario("pace: REALTIME realtime_factor: 10");
  std::ofstream(slow, std::ios::app)
      << "world { speed_limit_mps: 20 }\n"
         "vehicle { kind: ACCELERATION max_acceleration_mps2: 0.5 }\n";
  Child mission = launch_endless(slow, {"--lcm-url", kUrl});
  ASSERT_EQ(send_command("pause"), 0) << output();
  EXPECT_TRUE(answered(": 4 of 4 stand\n`ergocast resume`")) << output();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(PauseCommand, IsKnownToARecordWithoutASummary) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  ASSERT_EQ(send_command("pause"), 0) << output();
  ASSERT_TRUE(moves_on(3000));
  ASSERT_EQ(send_command("resume"), 0) << output();
  ASSERT_TRUE(moves_on());
  mission.send(SIGSTOP);  // it restarts no process
  kill_next({"ergocast-logger"});
  mission.send(SIGKILL);
  wait_for(mission);
  ASSERT_FALSE(std::filesystem::exists(out() / "summary.json"));
  ASSERT_TRUE(std::filesystem::exists(out() / "amendments.json"));
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(answered("identical to its simulation")) << output();
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
}

TEST_F(PauseCommand, ReportsWhyThereIsNothingToPause) {
  EXPECT_EQ(send_command("pause"), 4);
  EXPECT_TRUE(answered("no message of any run")) << output();
}

}  // namespace
}  // namespace ergocast::test
