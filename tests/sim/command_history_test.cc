// SPDX-License-Identifier: BSD-3-Clause
// Commands in any order: which are kept, and which is in force.
#include "sim/command_history.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast::test {
namespace {

Command command(Tick tick, double x_mps) { return command_of(0, tick, {x_mps, 0, 0}); }

TEST(CommandHistory, KeepsTheLastTwoInAnyOrder) {
  CommandHistory history;
  EXPECT_EQ(history.last(), nullptr);
  history.take(command(4, 4));
  EXPECT_EQ(history.before(), nullptr);
  history.take(command(2, 2));
  history.take(command(3, 3));
  history.take(command(1, 1));
  ASSERT_NE(history.before(), nullptr);
  EXPECT_EQ(history.answered(), 4);
  EXPECT_EQ(history.before()->header.tick, 3);
  history.take(command(7, 7));
  EXPECT_EQ(history.answered(), 7);
  EXPECT_EQ(history.before()->header.tick, 4);
  history.clear();
  EXPECT_EQ(history.answered(), -1);
  EXPECT_EQ(history.before(), nullptr);
}

TEST(CommandHistory, OnlyZeroVelocityCorrectsACommand) {
  CommandHistory history;
  history.take(command(4, 4));
  history.take(command(4, 5));
  EXPECT_EQ(history.last()->velocity_mps.x(), 4);
  history.take(command(4, 0));
  EXPECT_EQ(history.last()->velocity_mps.x(), 0);
  history.take(command(4, 4));
  EXPECT_EQ(history.last()->velocity_mps.x(), 0);
}

TEST(CommandHistory, OnlySuccessiveCommandsWithoutATickShowThatThereIsNoAnswer) {
  CommandHistory history;
  Command first = command(-1, 0), later = first, next = first;
  later.header.sequence += 2;
  next.header.sequence += 3;
  history.take(first);
  history.take(later);
  EXPECT_EQ(history.before(), nullptr) << "the answer to tick 0 may be between the two";
  history.take(next);
  EXPECT_NE(history.before(), nullptr);
  EXPECT_EQ(history.answered(), -1);
}

TEST(CommandHistory, HoldsACommandInRealTimeOnly) {
  CommandHistory history;
  history.take(command(4, 4));
  Timing timing{.dt_s = 0.25, .command_hold_s = 0.5};
  timing.pace = Pace::kLockstep;
  EXPECT_EQ(history.velocity_mps(4, timing).x(), 4);
  EXPECT_EQ(history.velocity_mps(5, timing).x(), 0);
  timing.pace = Pace::kRealtime;
  EXPECT_TRUE(history.in_force(6, timing));
  EXPECT_FALSE(history.in_force(7, timing));
  history.stand();
  EXPECT_EQ(history.velocity_mps(4, timing).x(), 0);
}

TEST(CommandHistory, ACommandWithoutATickIsNeverInForce) {
  CommandHistory history;
  history.take(command(-1, 3));
  EXPECT_FALSE(history.in_force(-1, {}));
  EXPECT_EQ(history.velocity_mps(-1, {}).x(), 0);
}

}  // namespace
}  // namespace ergocast::test
