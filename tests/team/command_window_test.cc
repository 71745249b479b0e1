// SPDX-License-Identifier: BSD-3-Clause
// How long a command that names a tick is obeyed, by the clock of its receiver.
#include "team/command_window.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast::test {
namespace {

TEST(CommandWindow, AdmitsEveryTickBeforeTheMissionHasBegun) {
  CommandWindow window;
  EXPECT_TRUE(window.admits(-1));
  window.note(-1, false, at(0s));
  window.note(-1, false, at(100s));
  EXPECT_TRUE(window.admits(-1));
  EXPECT_TRUE(window.admits(0));
}

TEST(CommandWindow, IsBetweenOneAndTwoLengthsWide) {
  CommandWindow window;
  const auto ticks_at = [](std::chrono::milliseconds time) { return Tick{time.count()}; };
  for (int tenths = 0; tenths <= 600; ++tenths) {
    const std::chrono::milliseconds time(100 * tenths);
    window.note(ticks_at(time), true, at(time));
    EXPECT_TRUE(window.admits(ticks_at(time)));
    EXPECT_TRUE(window.admits(std::max(Tick{0}, ticks_at(time - CommandWindow::kLength))))
        << time.count();
    EXPECT_FALSE(window.admits(ticks_at(time - 2 * CommandWindow::kLength) - 1)) << time.count();
  }
}

TEST(CommandWindow, AdmitsTheTickAtWhichTheMissionStands) {
  CommandWindow window;
  window.note(7, true, at(0s));
  for (int seconds = 1; seconds <= 600; ++seconds)
    window.note(7, true, at(std::chrono::seconds(seconds)));
  EXPECT_TRUE(window.admits(7)) << "the team is slow, and nothing has happened since";
  EXPECT_FALSE(window.admits(6));
}

// Received ticks may be those of a recording, too.
TEST(CommandWindow, WantsTheNewestTickUntilItsOwnerTakesPart) {
  CommandWindow window;
  window.note(100, false, at(0s));
  EXPECT_FALSE(window.admits(99));
  window.note(5000, false, at(1s));
  EXPECT_FALSE(window.admits(4999));
  window.note(6000, true, at(2s));
  EXPECT_FALSE(window.admits(5999)) << "sent before it began";
  window.note(6010, true, at(3s));
  EXPECT_TRUE(window.admits(6000)) << "sent since";
}

TEST(CommandWindow, AdmitsWhatWasSentWhileItsOwnerStood) {
  CommandWindow window;
  window.note(10, true, at(0s));
  window.note(10, true, at(6s));
  window.note(500, true, at(100s));
  EXPECT_TRUE(window.admits(10)) << "it is read only now";
  window.note(600, true, at(105s));
  window.note(600, true, at(110s));
  EXPECT_FALSE(window.admits(499));
}

}  // namespace
}  // namespace ergocast::test
