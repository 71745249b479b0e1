// SPDX-License-Identifier: BSD-3-Clause
// A table on a disk that is full and then has room again.
#include "logger/line_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class LineFileTest : public ::testing::Test {
 protected:
  LineFileTest() {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &former_);
  }
  ~LineFileTest() override { room(former_.rlim_cur); }
  /// From now on no file may grow beyond so many bytes.
  void room(rlim_t bytes) {
    const rlimit limit{bytes, former_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }

  rlimit former_{};
  const test::TempFolder folder_;
  const fs::path file_ = folder_.path() / "lines.csv";
};

TEST_F(LineFileTest, HalfALineIsTakenBackAndNothingIsLost) {
  LineFile lines;
  lines.open(file_);
  ASSERT_TRUE(lines << "1,2,3\n4,5,6\n" << std::flush);
  room(15);
  EXPECT_FALSE(lines << "7,8,9\n" << std::flush);
  EXPECT_EQ(lines.error(), EFBIG);
  EXPECT_EQ(text_of(file_), "1,2,3\n4,5,6\n");
  lines.clear();
  EXPECT_FALSE(lines.flush()) << "there is still no room";
  room(former_.rlim_cur);
  lines.clear();
  ASSERT_TRUE(lines.flush());
  EXPECT_EQ(lines.error(), 0);
  EXPECT_EQ(text_of(file_), "1,2,3\n4,5,6\n7,8,9\n");
}

TEST_F(LineFileTest, WhatIsWholeOfSeveralLinesStays) {
  LineFile lines;
  lines.open(file_);
  room(15);
  EXPECT_FALSE(lines << "1,2,3\n4,5,6\n7,8,9\n" << std::flush);
  EXPECT_EQ(text_of(file_), "1,2,3\n4,5,6\n");
  room(former_.rlim_cur);
  lines.clear();
  ASSERT_TRUE(lines << "10\n" << std::flush);
  EXPECT_EQ(text_of(file_), "1,2,3\n4,5,6\n7,8,9\n10\n");
}

TEST_F(LineFileTest, TriesByItselfOnceSixtyFourKilobytesWait) {
  LineFile lines;
  lines.open(file_);
  const std::string line = std::string(1023, 'x') + '\n';
  for (int i = 0; i < 63; ++i) lines << line;
  EXPECT_EQ(fs::file_size(file_), 0U);
  lines << line;
  EXPECT_EQ(fs::file_size(file_), 65536U);
  room(65536);
  for (int i = 0; i < 63; ++i) EXPECT_TRUE(lines << line);
  EXPECT_FALSE(lines << line) << "a writer that stops here keeps no more than this in memory";
  room(former_.rlim_cur);
  lines.clear();
  ASSERT_TRUE(lines.flush());
  EXPECT_EQ(fs::file_size(file_), 2 * 65536U);
}

TEST_F(LineFileTest, ThatCannotBeOpenedIsBadAndReportsWhy) {
  LineFile lines;
  lines.open("/nowhere/at/all.csv");
  EXPECT_FALSE(lines);
  EXPECT_EQ(lines.error(), ENOENT);
}

}  // namespace
}  // namespace ergocast
