// SPDX-License-Identifier: BSD-3-Clause
// The example driver in place of ergocast-sim; everything else is unchanged.
#include "tests/process/mission.h"
#include "tests/process/record.h"

namespace ergocast::test {
namespace {

class DrivenRobots : public ByHand {
 protected:
  /// The default mission by the clock, ten times as fast.
  std::filesystem::path realtime_scenario(const std::string& duration_s) {
    return scenario("pace: REALTIME realtime_factor: 10 duration_s: " + duration_s);
  }
};

TEST_F(DrivenRobots, FlyAWholeMissionWhoseRecordIsComplete) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  Program& coordinator = hand("ergocast-coordinator", {realtime_scenario("30")});
  EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.said();
  EXPECT_EQ(wait_for(driver.child), 0) << driver.said();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.said();
  EXPECT_TRUE(driver.says("finished at tick 300: mission complete")) << driver.said();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["ticks"], 300);
}

TEST_F(DrivenRobots, StandStillAtOnceWhenTheyAreToldToStop) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  hand("ergocast-coordinator", {realtime_scenario(kEndless)});
  ASSERT_TRUE(recorded(30000)) << driver.said();
  ASSERT_EQ(ergocast({"stop", "--now", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(driver.child), 0) << driver.said();
  EXPECT_TRUE(driver.says("stopped at once")) << driver.said();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.said();
  const auto rows = recorded_rows(out());
  ASSERT_FALSE(rows.empty());
  for (const auto& [id, row] : rows.rbegin()->second) EXPECT_TRUE(row.stands()) << id;
}

TEST_F(DrivenRobots, RefuseAMissionInLockstep) {
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  Program& coordinator = hand("ergocast-coordinator", {scenario()});
  EXPECT_EQ(wait_for(driver.child), 4) << driver.said();
  EXPECT_TRUE(driver.says("give it pace: REALTIME")) << driver.said();
  EXPECT_TRUE(coordinator.says("running")) << coordinator.said();
}

}  // namespace
}  // namespace ergocast::test
