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
  setenv("LD_PRELOAD", ERGOCAST_NO_NUMBER, 1);
  EXPECT_EQ(ergocast({"run", scenario(), "--duration", "10", "--out", out()}), 4) << output();
  EXPECT_NE(output().find("failed: mission complete, but phi^2 is not a number from tick 0 on"),
            output().npos)
      << output();
  EXPECT_EQ(summary()["result"], "failed");
  EXPECT_EQ(summary()["record_complete"], true);
}

}  // namespace
}  // namespace ergocast::test
