// SPDX-License-Identifier: BSD-3-Clause
// Log lines in the journal's format.
#include "runtime/process/logging.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace ergocast {
namespace {

TEST(Journal, IsTheStreamWithTheDeviceAndInodeThatSystemdNames) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  struct stat info {};
  ASSERT_EQ(fstat(ends[1], &info), 0);
  const std::string name = std::to_string(info.st_dev) + ':' + std::to_string(info.st_ino);
  EXPECT_TRUE(is_journal(name.c_str(), ends[1]));
  EXPECT_FALSE(is_journal((name + "0").c_str(), ends[1]));
  EXPECT_FALSE(is_journal("", ends[1]));
  EXPECT_FALSE(is_journal(nullptr, ends[1]));
  EXPECT_FALSE(is_journal(name.c_str(), -1));
  close(ends[0]);
  close(ends[1]);
}

TEST(Journal, EveryLineHasThePriorityAndTheProcess) {
  EXPECT_EQ(journal_lines(6, "agent-3", "joining"), "<6>agent-3: joining\n");
  EXPECT_EQ(journal_lines(3, "sim", "no route. As root:\n  ip link\n\n  ip route"),
            "<3>sim: no route. As root:\n<3>sim:   ip link\n<3>sim:   ip route\n");
}

}  // namespace
}  // namespace ergocast
