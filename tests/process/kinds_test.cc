// SPDX-License-Identifier: BSD-3-Clause
// Real processes of several kinds: their record, the output about them, and an unknown kind.
#include <fstream>

#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

class MixedRun : public OwnHost {};

TEST_F(MixedRun, InLockstepIsItsSimulationAndTheRecordNamesTheKinds) {
  ASSERT_EQ(ergocast({"run", scenario_file("mixed_team"), "--lockstep", "--duration", "10", "--out",
                      out()}),
            0)
      << output();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  const auto agents = summary()["agents"];
  ASSERT_EQ(agents.size(), 4u);
  EXPECT_EQ(agents[0]["kind"], "scout");
  EXPECT_EQ(agents[3]["kind"], "inspector");
  const std::string page = text_of(out() / "report.html");
  EXPECT_NE(page.find("inspector: 2 agents, u_max = 6 m/s, sees a Gaussian of 2 m"), page.npos);
}

TEST_F(MixedRun, OfUnlikeVehiclesThatKeepADistanceIsItsSimulation) {
  std::string text = text_of(scenario_file("crowded_team"));
  const std::string team = "agents {";
  text.replace(text.find(team), team.size(), team + R"(
  kind { name: "wing" count: 2 vehicle { kind: FIXED_WING max_turn_radps: 3 min_speed_mps: 5 } }
  kind { name: "copter" count: 2 vehicle { kind: ACCELERATION max_acceleration_mps2: 20 } }
  kind { name: "rover" count: 1 speed_limit_mps: 9 vehicle { kind: UNICYCLE max_turn_radps: 2 } }
  kind { name: "float" count: 1 })");
  const auto scenario = folder_ / "unlike.textproto";
  std::ofstream(scenario) << text;
  ASSERT_EQ(ergocast({"run", scenario, "--lockstep", "--duration", "10", "--out", out()}), 0)
      << output();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_GE(summary()["separation"]["nearest_m"], 8);
  EXPECT_EQ(summary()["speed_limit"]["mps"], 20);
  EXPECT_EQ(summary()["speed_limit"]["kinds"]["rover"], 9);
  const std::string page = text_of(out() / "report.html");
  EXPECT_NE(page.find("limited to 9 m/s, vehicles that turn by at most 2 rad/s, also on the spot"),
            page.npos);
}

class KindByHand : public ByHand {};

TEST_F(KindByHand, ThatTheMissionDoesNotHaveEndsTheAgentWithASentence) {
  Program& coordinator = hand("ergocast-coordinator", {scenario_file("mixed_team")});
  Program& stranger = hand("ergocast-agent", {"--id", "0", "--kind", "diver"});
  EXPECT_EQ(wait_for(stranger.child), 4) << stranger.printed();
  EXPECT_TRUE(stranger.prints("the mission has no kind \"diver\": its kinds are scout, inspector"))
      << stranger.printed() << coordinator.printed();
}

}  // namespace
}  // namespace ergocast::test
