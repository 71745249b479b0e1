// SPDX-License-Identifier: BSD-3-Clause
// Versions are compared number by number, and the older host is the one to update.
#include "text/versions.h"

#include <gtest/gtest.h>

namespace ergocast {
namespace {

TEST(Versions, AreComparedNumberByNumber) {
  EXPECT_TRUE(is_older_version("0.2.0", "0.3.0"));
  EXPECT_FALSE(is_older_version("0.3.0", "0.2.0"));
  EXPECT_FALSE(is_older_version("0.3.0", "0.3.0"));
  EXPECT_TRUE(is_older_version("0.9.1", "0.10"));
  EXPECT_TRUE(is_older_version("0.3", "0.3.1"));
  EXPECT_FALSE(is_older_version("0.3", "0.3.0"));
}

TEST(Versions, ReceivedTextThatIsNoVersionIsTheOldest) {
  for (const char* text : {"", "x", "..", "99999999999999999999", "-"}) {
    EXPECT_TRUE(is_older_version(text, "0.3.0")) << text;
    EXPECT_FALSE(is_older_version("0.3.0", text)) << text;
  }
}

TEST(Versions, TheOlderHostIsToBeUpdated) {
  EXPECT_EQ(update_of_hosts("rover", "0.2.0", "this host", "0.3.0"), "update rover to 0.3.0");
  EXPECT_EQ(update_of_hosts("rover", "0.10.0", "this host", "0.9.0"), "update this host to 0.10.0");
}

}  // namespace
}  // namespace ergocast
