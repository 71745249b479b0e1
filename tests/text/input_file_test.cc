// SPDX-License-Identifier: BSD-3-Clause
// Regular files are read within a limit. Everything else is refused at once.
#include "text/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using Kind = FileProblem::Kind;

class InputFileTest : public ::testing::Test {
 protected:
  std::filesystem::path written(const std::string& content) const {
    std::ofstream(folder_.path() / "file", std::ios::binary) << content;
    return folder_.path() / "file";
  }
  static std::optional<Kind> refusal(const std::filesystem::path& file) {
    const InputFile stream(file);
    const auto opened = open_input(file);
    const auto read = read_whole(file, 1000);
    EXPECT_EQ(stream.problem().has_value(), !read);
    EXPECT_EQ(!opened, !read);
    EXPECT_EQ(stream.bad(), !read);
    return read ? std::nullopt : std::optional(read.error().kind);
  }

  test::TempFolder folder_;
};

// No process writes into the pipe: a program that opens it to read would never continue.
TEST_F(InputFileTest, RefusesWhatIsNoRegularFile) {
  const auto pipe = folder_.path() / "pipe", link = folder_.path() / "link";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink(pipe, link);
  EXPECT_EQ(refusal(pipe), Kind::kNoFile);
  EXPECT_EQ(refusal(link), Kind::kNoFile);
  EXPECT_EQ(refusal("/dev/zero"), Kind::kNoFile);
  EXPECT_EQ(refusal(folder_.path()), Kind::kNoFile);
  EXPECT_EQ(refusal(folder_.path() / "missing"), Kind::kMissing);
  EXPECT_EQ(refusal(written("a")), std::nullopt);
}

TEST_F(InputFileTest, IsReadWholeUpToTheLimit) {
  const std::string content = std::string("a\0b\n", 4) + std::string(70000, 'x');
  const auto file = written(content);
  EXPECT_EQ(read_whole(file, content.size()).value(), content);
  EXPECT_EQ(read_whole(file, content.size() - 1).error().kind, Kind::kTooLarge);
  EXPECT_NE(read_whole("/proc/self/status", 100000).value().find("VmHWM"), std::string::npos)
      << "its size is given as 0";
  EXPECT_EQ(read_whole("/proc/self/status", 100).error().kind, Kind::kTooLarge);
}

TEST_F(InputFileTest, OfATerabyteTakesNoMemory) {
  const auto file = written("a");
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40);
  const auto read = read_whole(file, std::size_t{1} << 30);
  EXPECT_EQ(read.error().what, "is longer than the limit, 1073741824 bytes");
}

TEST_F(InputFileTest, ComesInLinesAndLongLinesInPieces) {
  const std::string long_line(10000, 'x'), just(4095, 'y');
  InputFile in(written("one\n\n" + just + '\n' + long_line + "\nlast"));
  std::string line;
  EXPECT_EQ(next_line(in, line, 20000), LineEnd::kBreak);
  EXPECT_EQ(line, "one");
  EXPECT_EQ(next_line(in, line, 20000), LineEnd::kBreak);
  EXPECT_EQ(line, "");
  EXPECT_EQ(next_line(in, line, 20000), LineEnd::kBreak);
  EXPECT_EQ(line, just);
  EXPECT_EQ(next_line(in, line, 5000), LineEnd::kMore);
  EXPECT_LT(line.size(), 10000U);
  const std::string piece = line;
  EXPECT_EQ(next_line(in, line, 5000), LineEnd::kBreak);
  EXPECT_EQ(piece + line, long_line);
  EXPECT_EQ(next_line(in, line, 20000), LineEnd::kFile);
  EXPECT_EQ(line, "last");
  EXPECT_EQ(next_line(in, line, 20000), LineEnd::kNone);
}

}  // namespace
}  // namespace ergocast
