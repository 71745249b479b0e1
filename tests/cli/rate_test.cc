// SPDX-License-Identifier: BSD-3-Clause
// The remaining time must not jump: its rate changes slowly and converges to the true one.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/progress_line.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

TEST(Rate, OfAnUnevenPaceIsSteadyAndRightInTheMean) {
  Rate rate;
  ProgressLine::Clock::time_point now{1h};
  double count = 0, least = 1e9, most = 0;
  rate.measure(count, now);
  for (int turn = 0; turn < 200; ++turn) {
    now += 500ms;
    count +=
        turn % 2 == 0 ? 100 : 900;  // half a second as slow as 200/s, another as fast as 1800/s
    const double per_s = rate.measure(count, now);
    if (turn < 60) continue;
    least = std::min(least, per_s);
    most = std::max(most, per_s);
  }
  EXPECT_GT(least, 850);
  EXPECT_LT(most, 1150);
}

TEST(Rate, IsKnownFromTheFirstMeasurementAndFollowsALastingChange) {
  Rate rate;
  ProgressLine::Clock::time_point now{1h};
  rate.measure(0, now);
  EXPECT_EQ(rate.measure(100, now + 1s), 100);
  double per_s = 0;
  for (int s = 1; s <= 30; ++s) per_s = rate.measure(100 + 10 * s, now + 1s + s * 1s);
  EXPECT_NEAR(per_s, 10, 1);
}

TEST(Rate, LeavesOutTheTimeInWhichNothingIsCountedOnPurpose) {
  Rate rate;
  ProgressLine::Clock::time_point now{1h};
  rate.measure(0, now);
  ASSERT_EQ(rate.measure(100, now + 1s), 100);
  for (int s = 1; s <= 60; ++s) EXPECT_EQ(rate.interrupt(100, now + s * 1s), 100);
  EXPECT_EQ(rate.measure(200, now + 61s), 100);
}

}  // namespace
}  // namespace ergocast::cli
