// SPDX-License-Identifier: BSD-3-Clause
// How long the messages of a mission may gather.
#include "runtime/bus/gathering.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast::test {
namespace {

using namespace std::chrono_literals;

Mission mission_with(Pace pace, double dt_s, double realtime_factor) {
  Mission mission = small_mission(4);
  mission.basis.modes_x = mission.basis.modes_y = 16;  // two blocks
  mission.timing.pace = pace;
  mission.timing.dt_s = dt_s;
  mission.timing.realtime_factor = realtime_factor;
  return mission;
}

TEST(GatheringOf, AMissionInRealTimeIsHalfATickAndAtMost50Ms) {
  EXPECT_EQ(gathering_of(mission_with(Pace::kRealtime, 0.02, 1), 4).at_most, 10ms);
  EXPECT_EQ(gathering_of(mission_with(Pace::kRealtime, 0.02, 2), 4).at_most, 5ms);
  EXPECT_EQ(gathering_of(mission_with(Pace::kRealtime, 10, 1), 4).at_most, 50ms);
  EXPECT_EQ(gathering_of(mission_with(Pace::kRealtime, 0.02, 100), 4).at_most, 0ms);
  EXPECT_EQ(gathering_of(mission_with(Pace::kLockstep, 0.02, 1), 4).at_most, 0ms);
  EXPECT_EQ(gathering_of(mission_with(Pace::kRealtime, 0.02, 1), 4).datagrams, 8U);
}

}  // namespace
}  // namespace ergocast::test
