// SPDX-License-Identifier: BSD-3-Clause
// Harmless text is unchanged, control characters are replaced, and the nearest name is found.
#include "text/printable.h"

#include <gtest/gtest.h>

#include "text/likeness.h"

namespace ergocast {
namespace {

TEST(Printable, LeavesTextAloneAndDisarmsWhatATerminalObeys) {
  EXPECT_EQ(printable("Ergocast: φ² → 0,\n\tas ever"), "Ergocast: φ² → 0,\n\tas ever");
  EXPECT_EQ(printable("\x1b[2J\r\x07\x7f"), "\\x1b[2J\\x0d\\x07\\x7f");
  EXPECT_EQ(printable("\xc2\x9b|\xc2\xa0|\xff|\xc3"), "\\xc2\\x9b|\xc2\xa0|\\xff|\\xc3");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(Likeness, OfAWordIsTheNearestNameOrNone) {
  const std::vector<std::string> names{"--seed", "--seeds", "--out", "--duration"};
  EXPECT_EQ(nearest("--sed", names), "--seed");
  EXPECT_EQ(nearest("--durtion", names), "--duration");
  EXPECT_EQ(nearest("--dura", names), "--duration");
  EXPECT_EQ(nearest("--colour", names), "");
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("lwa", "law"), 1);
}

}  // namespace
}  // namespace ergocast
