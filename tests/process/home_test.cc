// SPDX-License-Identifier: BSD-3-Clause
// Stations: real processes go home and rest there until the mission's end; people see both.
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

class AgentsWithAStation : public RunningMission {
 protected:
  /// The number of agents that `ergocast status` shows with that word.
  int shown(const std::string& word) {
    ergocast({"status", "--lcm-url", kUrl});
    int count = 0;
    const std::string text = output();
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++count;
    return count;
  }
};

TEST_F(AgentsWithAStation, RestAtHomeAsStatusAndSummaryReport) {
  // They rest from tick 2000 of 10^8 on.
  const auto file = scenario(
      "", "kind { name: \"robots\" count: 4 station { x_m: 500 y_m: 400 } reserve_s: 9999800 }\n");
  Child mission = launch_endless(file, {"--lcm-url", kUrl});
  EXPECT_TRUE(eventually([&] { return shown("rests") == 4; })) << output() << printed();
  ASSERT_TRUE(moves_on());
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  const auto stations = summary()["stations"];
  EXPECT_EQ(stations["agents"], 4);
  EXPECT_EQ(stations["home"], 4) << stations;
  EXPECT_TRUE(stations["late"].empty()) << stations;
  EXPECT_TRUE(printed("4 of 4 agents home in time")) << printed();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

// Without a reserve they must be there at the mission's end, after its last row.
TEST_F(AgentsWithAStation, AreJudgedAtTheEndWithoutAReserve) {
  const auto file =
      scenario("", "kind { name: \"robots\" count: 4 station { x_m: 500 y_m: 400 } }\n");
  EXPECT_EQ(ergocast({"simulate", file, "--out", out()}), 0) << output();
  EXPECT_NE(output().find("4 of 4 agents home in time"), std::string::npos) << output();
  EXPECT_EQ(summary()["stations"]["home"], 4) << summary()["stations"];
  EXPECT_LT(summary()["stations"]["farthest_m"], 10);
}

TEST_F(AgentsWithAStation, AreNotJudgedWhereTheMissionEndsBefore) {
  const auto file =
      scenario("", "kind { name: \"robots\" count: 4 station { x_m: 500 y_m: 400 } }\n");
  Child mission = launch_endless(file, {"--lcm-url", kUrl});
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  EXPECT_TRUE(printed("no agent had to be home yet")) << printed();
  EXPECT_EQ(summary()["stations"]["agents"], 0);
}

}  // namespace
}  // namespace ergocast::test
