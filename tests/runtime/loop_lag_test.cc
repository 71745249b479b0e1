// SPDX-License-Identifier: BSD-3-Clause
// The lateness and the blocked time of a loop, from the times that it reports.
#include "runtime/process/loop_lag.h"

#include <gtest/gtest.h>

namespace ergocast {
namespace {

using namespace std::chrono_literals;

Instant at(std::chrono::nanoseconds since_start) { return Instant{since_start}; }

TEST(LoopLag, IsNoneWhileTheLoopOnlyWaits) {
  LoopLag lag;
  lag.woke(at(1s), at(1s));
  lag.done(at(1s));
  EXPECT_EQ(lag.take_s(), 0);
}

TEST(LoopLag, IsHowMuchTooLateTheLoopWokeUp) {
  LoopLag lag;
  lag.woke(at(1s), at(1250ms));
  lag.done(at(1250ms));
  EXPECT_DOUBLE_EQ(lag.take_s(), 0.25);
}

TEST(LoopLag, IsZeroForALoopThatIsWokenBeforeItsTime) {
  LoopLag lag;
  lag.woke(at(10s), at(1s));
  lag.done(at(1s));
  EXPECT_EQ(lag.take_s(), 0);
}

TEST(LoopLag, IsHowLongATurnTook) {
  LoopLag lag;
  lag.woke(at(1s), at(1s));
  lag.done(at(3s));
  EXPECT_DOUBLE_EQ(lag.take_s(), 2);
}

TEST(LoopLag, IsTheWorstSinceItWasLastTaken) {
  LoopLag lag;
  for (const auto turn : {1s, 4s, 2s}) {
    lag.woke(at(0s), at(0s));
    lag.done(at(turn));
  }
  EXPECT_DOUBLE_EQ(lag.take_s(), 4);
  EXPECT_EQ(lag.take_s(), 0);
}

}  // namespace
}  // namespace ergocast
