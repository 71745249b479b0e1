// SPDX-License-Identifier: BSD-3-Clause
// Simulations whose φ² is no number fail and report it; tests/process/no_metric_test.cc has a real
// mission.
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

class NoMetric : public OwnHost {
 protected:
  void SetUp() override { setenv("ERGOCAST_BUG", "phi^2 is no number", 1); }
  void TearDown() override {
    unsetenv("ERGOCAST_BUG");
    OwnHost::TearDown();
  }
  int with_bug(std::vector<std::string> arguments) {
    return run("ergocast-with-bugs", std::move(arguments));
  }

  const std::string team_ = scenario_file("quadrimodal_corners");
};

TEST_F(NoMetric, FailsASimulation) {
  EXPECT_EQ(with_bug({"simulate", team_, "--duration", "10", "--out", out()}), 4) << output();
  EXPECT_TRUE(answered(", but phi^2 is not a number from tick 0 on")) << output();
  EXPECT_EQ(summary()["result"], "failed");
}

TEST_F(NoMetric, FailsEachOfManySimulations) {
  EXPECT_EQ(with_bug({"simulate", team_, "--duration", "10", "--seeds", "1:2", "--jobs", "1"}), 4)
      << output();
  for (const char* seed : {"seed 1: ", "seed 2: "})
    EXPECT_TRUE(answered(std::string(seed) + "phi^2 is not a number")) << output();
}

TEST_F(NoMetric, FailsEachRunOfAStudy) {
  EXPECT_EQ(with_bug({"study", team_, "--duration", "10", "--seeds", "1:2", "--out", out()}), 4)
      << output();
  for (const char* seed : {"seed 1: ", "seed 2: "})
    EXPECT_TRUE(answered(std::string(seed) + "phi^2 is not a number")) << output();
}

}  // namespace
}  // namespace ergocast::test
