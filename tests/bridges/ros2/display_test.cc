// SPDX-License-Identifier: BSD-3-Clause
// What is left of a target in the display for ROS 2: less where sensors were, and nowhere more.
#include "bridges/ros2/display.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "tests/support/team.h"

namespace ergocast::ros2 {
namespace {

using namespace std::chrono_literals;
using namespace test;

class RosDisplay : public ::testing::Test {
 protected:
  RosDisplay() {
    mission_.sensor.radius_m = 150;
    mission_.sensor.detections_per_s = 1;
    announce(mission_);
    send(mission_part(1, MissionState::kRunning, roster_of(2)));
  }
  void send(const Message& message) {
    display_.receive(message, Bus::kSwarm, kCoordinator, Instant{1s});
  }
  void move(Tick tick, const std::vector<Eigen::Vector3d>& x_m) {
    display_.receive(world_state(tick, x_m), Bus::kWorld, kWorld, Instant{1s});
  }
  std::size_t cell_at(const OccupancyGrid& grid, double x_m, double y_m) const {
    const auto at = [&](double where_m) {
      return static_cast<std::size_t>(where_m / grid.resolution_m);
    };
    return at(y_m) * grid.width + at(x_m);
  }

  Mission mission_ = small_mission(2);
  Display display_{kRun, Instant{0s}, false};
};

TEST_F(RosDisplay, ShowsWhatIsLeft) {
  ASSERT_TRUE(display_.begun());
  const Eigen::Vector3d here_m{500, 600, 0}, there_m{1500, 1400, 0};
  move(0, {there_m, there_m});
  const OccupancyGrid before = display_.left();
  for (Tick tick = 1; tick < 300; ++tick) move(tick, {here_m, here_m});
  const OccupancyGrid target = display_.target(), left = display_.left();
  ASSERT_EQ(left.data.size(), target.data.size());
  EXPECT_EQ(before.data[cell_at(before, 500, 600)], target.data[cell_at(target, 500, 600)]);
  ASSERT_GT(target.data[cell_at(target, 500, 600)], 0);
  EXPECT_EQ(left.data[cell_at(left, 500, 600)], 0);
  EXPECT_EQ(left.data[cell_at(left, 1000, 1000)], target.data[cell_at(target, 1000, 1000)]);
  for (std::size_t i = 0; i < left.data.size(); ++i) EXPECT_LE(left.data[i], target.data[i]) << i;
}

}  // namespace
}  // namespace ergocast::ros2
