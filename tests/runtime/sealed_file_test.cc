// SPDX-License-Identifier: BSD-3-Clause
// A file that a launcher hands to a process: no process can change it, and only a child that gets
// it can read it.
#include "runtime/process/sealed_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "runtime/process/child.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

SealedFile sealed(const std::string& text) {
  auto made = SealedFile::make("a plan", std::as_bytes(std::span(text)));
  EXPECT_TRUE(made);
  return made.value();
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SealedFile, IsReadAsOftenAsItIsOpened) {
  const SealedFile file = sealed("all of it");
  EXPECT_EQ(text_of(file.path()), "all of it");
  EXPECT_EQ(text_of(file.path()), "all of it");
}

TEST(SealedFile, CannotBeChanged) {
  const SealedFile file = sealed("all of it");
  EXPECT_NE(ftruncate(file.descriptor(), 3), 0);
  EXPECT_NE(ftruncate(file.descriptor(), 30), 0);
  EXPECT_LT(pwrite(file.descriptor(), "x", 1, 0), 0);
  EXPECT_EQ(text_of(file.path()), "all of it");
}

TEST(SealedFile, IsItsOwnersAlone) {
  const SealedFile file = sealed("a key");
  struct stat info {};
  ASSERT_EQ(fstat(file.descriptor(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0400U);
}

/// The output of `cat` for the last of these files, which it gets in this order.
std::string seen_by_child(const std::vector<SealedFile>& files) {
  const test::TempFolder folder;
  const auto log = folder.path() / "log";
  Child::Program program{{"/bin/cat"}, log, SIGKILL};
  std::string path;
  for (const SealedFile& file : files) path = program.hand(file.descriptor());
  program.command.push_back(path);
  auto child = Child::start(program);
  EXPECT_EQ(waitpid(child.value().pid(), nullptr, 0), child.value().pid());
  return text_of(log);
}

TEST(SealedFile, IsReadByTheChildThatIsGivenIt) {
  const SealedFile file = sealed("all of it"), other = sealed("another"), last = sealed("a third");
  EXPECT_EQ(seen_by_child({file}), "all of it");
  EXPECT_EQ(seen_by_child({last, other, file}), "all of it");
  EXPECT_EQ(seen_by_child({file, other, last}), "a third");
}

}  // namespace
}  // namespace ergocast
