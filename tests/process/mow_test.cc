// SPDX-License-Identifier: BSD-3-Clause
// Real agents that mow: the same mission as its simulation, and a new target is mown from its tick
// on.
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

class Mowing : public RunningMission {
 protected:
  /// A new target around a place, as a scenario's block.
  std::filesystem::path peak_at(double x_m, double y_m) {
    const auto file = folder_ / "peak.textproto";
    std::ofstream(file) << "target { gaussians { mean_x_m: " << x_m << " mean_y_m: " << y_m
                        << " sigma_m: 100 } }\n";
    return file;
  }
};

TEST_F(Mowing, IsTheSameMissionAsItsSimulation) {
  ASSERT_EQ(ergocast({"run", scenario(), "--set", "law.kind=MOW", "--duration", "60", "--out",
                      out(), "--lcm-url", kUrl}),
            0)
      << output();
  EXPECT_GT(summary()["detection"]["probability"].get<double>(), 0.02);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(Mowing, FollowsANewTarget) {
  Child mission =
      launch_endless(scenario(), {"--lockstep", "--set", "law.kind=MOW", "--lcm-url", kUrl});
  ASSERT_EQ(amend({"--target", peak_at(1800, 1800)}), 0) << output();
  // Once all agents are in the corner of the new target, and no sooner, the mission is stopped.
  const auto all_are_there = [&] {
    if (ergocast({"status", "--json", "--lcm-url", kUrl}) != 0) return false;
    const auto status = nlohmann::json::parse(output());
    if (status["agents"].size() != 4) return false;
    for (const auto& agent : status["agents"]) {
      const auto& x_m = agent["position_m"];
      if (!x_m.is_array() || x_m[0] < 1200 || x_m[1] < 1200) return false;
    }
    return true;
  };
  EXPECT_TRUE(eventually(all_are_there, mission.pid())) << output();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

}  // namespace
}  // namespace ergocast::test
