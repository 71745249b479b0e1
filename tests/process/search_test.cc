// SPDX-License-Identifier: BSD-3-Clause
// Real agents that search: the same mission as its simulation, and it goes on if one is killed.
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

class Searching : public RunningMission {};

TEST_F(Searching, IsTheSameMissionAsItsSimulation) {
  const auto file = scenario();
  ASSERT_EQ(ergocast({"run", file, "--set", "law.kind=SEARCH", "--duration", "60", "--out", out(),
                      "--lcm-url", kUrl}),
            0)
      << output();
  EXPECT_GT(summary()["detection"]["probability"].get<double>(), 0.05);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  const auto simulated = folder_ / "simulated";
  ASSERT_EQ(ergocast({"simulate", file, "--set", "law.kind=SEARCH", "--duration", "60", "--out",
                      simulated}),
            0)
      << output();
  EXPECT_EQ(text_of(out() / "trajectories.csv"), text_of(simulated / "trajectories.csv"));
}

TEST_F(Searching, FindsMoreThanTheDefaultLawAndThanAgentsThatDoNotShare) {
  const auto found = [&](const std::string& law) {
    const auto run = folder_ / law;
    EXPECT_EQ(
        ergocast({"simulate",
                  std::filesystem::path(ERGOCAST_SOURCE_DIR) / "studies/law/random.textproto",
                  "--seed", "1", "--set", "law.kind=" + law, "--duration", "600", "--out", run}),
        0)
        << output();
    return nlohmann::json::parse(text_of(run / "summary.json"))["detection"]["probability"]
        .get<double>();
  };
  const double search = found("SEARCH");
  EXPECT_GT(search, found("COVER") + 0.05);
  EXPECT_GT(search, 0.94) << "found by agents that share nothing: 0.91";
}

TEST_F(Searching, GoesOnAfterAnAgentWasKilled) {
  Child mission = launch_held(scenario("duration_s: 60"),
                              {"--lockstep", "--set", "law.kind=SEARCH", "--lcm-url", kUrl});
  signal_to(agent(1), SIGKILL);
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["restarts"], 1);
}

}  // namespace
}  // namespace ergocast::test
