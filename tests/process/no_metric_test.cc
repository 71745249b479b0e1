// SPDX-License-Identifier: BSD-3-Clause
// A φ² that is no number fails a mission, and the failure names the cause.
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

class NoMetric : public RunningMission {
 protected:
  void TearDown() override {
    unsetenv("LD_PRELOAD");
    RunningMission::TearDown();
  }
};

TEST_F(NoMetric, FailsARun) {
  std::string text = text_of(scenario());
  const std::string law = "law {";
  text.insert(text.find(law) + law.size(), " memory_half_life_s: 2 ");
  const auto forgetful = folder_ / "forgetful.textproto";
  std::ofstream(forgetful) << text;
  setenv("LD_PRELOAD", ERGOCAST_NO_NUMBER, 1);
  EXPECT_EQ(ergocast({"run", forgetful, "--duration", "10", "--out", out()}), 4) << output();
  EXPECT_NE(output().find("failed: mission complete, but phi^2 is not a number from tick 20 on"),
            output().npos)
      << output();
  EXPECT_EQ(summary()["result"], "failed");
  EXPECT_EQ(summary()["record_complete"], true);
}

}  // namespace
}  // namespace ergocast::test
