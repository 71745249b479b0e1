// SPDX-License-Identifier: BSD-3-Clause
// Key files come back as written; loose permissions, other files and other text are refused.
#include "runtime/process/key_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

class KeyFile : public testing::Test {
 protected:
  fs::path file(const std::string& text, mode_t mode = 0600) const {
    const fs::path path = folder_ / "a.key";
    std::ofstream(path) << text;
    ::chmod(path.c_str(), mode);
    return path;
  }
  /// Why the text is no key; empty if it is one.
  std::string problem(const std::string& text, mode_t mode = 0600) const {
    const auto read = read_key_file(file(text, mode));
    return read ? "" : read.error();
  }
  const test::TempFolder own_;
  const fs::path& folder_ = own_.path();
};

TEST_F(KeyFile, WhatIsWrittenIsReadAgain) {
  const MissionKey key = make_mission_key();
  const fs::path coordinator = folder_ / "c.key", team = folder_ / "t.key";
  ASSERT_EQ(write_key_file(coordinator, key_text(key, true)), std::nullopt);
  ASSERT_EQ(write_key_file(team, key_text(key, false)), std::nullopt);
  struct stat info {};
  ASSERT_EQ(::stat(team.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600u);
  const auto all = read_key_file(coordinator).value();
  const auto members = read_key_file(team).value();
  EXPECT_EQ(all.shared, key.shared);
  EXPECT_EQ(all.coordinator, key.coordinator);
  EXPECT_EQ(all.signing, key.signing);
  EXPECT_EQ(members.shared, key.shared);
  EXPECT_EQ(members.coordinator, key.coordinator);
  EXPECT_FALSE(members.signing.has_value());
}

TEST_F(KeyFile, NoTwoKeysAreAlike) {
  const MissionKey one = make_mission_key(), other = make_mission_key();
  EXPECT_NE(one.shared, other.shared);
  EXPECT_NE(one.coordinator, other.coordinator);
}

TEST_F(KeyFile, NoFileIsWrittenOver) {
  const fs::path path = file("precious");
  const auto problem = write_key_file(path, "key");
  ASSERT_TRUE(problem.has_value());
  EXPECT_NE(problem->find(path.string()), std::string::npos) << *problem;
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_EQ(text.str(), "precious");
}

TEST_F(KeyFile, LoosePermissionsAreRefusedWithTheRemedy) {
  const std::string text = key_text(make_mission_key(), true);
  for (const mode_t mode : {0600, 0400, 0700}) EXPECT_EQ(problem(text, mode), "") << mode;
  for (const mode_t mode : {0640, 0604, 0660, 0602, 0620, 0644, 0601, 0777}) {
    EXPECT_NE(problem(text, mode).find("chmod 600"), std::string::npos) << mode;
  }
}

TEST_F(KeyFile, OnlyACredentialOfSystemdMayBeReadableByItsGroup) {
  const std::string text = key_text(make_mission_key(), false);
  const fs::path credentials = folder_ / "credentials";
  fs::create_directory(credentials);
  const auto is_read = [](const fs::path& path) { return read_key_file(path).has_value(); };
  ::setenv("CREDENTIALS_DIRECTORY", credentials.c_str(), 1);
  const fs::path inside = credentials / "a.key";
  fs::copy_file(file(text, 0440), inside);
  EXPECT_TRUE(is_read(inside));
  for (const mode_t mode : {0444, 0460, 0450, 0404}) {
    ::chmod(inside.c_str(), mode);
    EXPECT_FALSE(is_read(inside)) << mode;
  }
  // Neither a file of the same name elsewhere nor the target of a link is accepted.
  EXPECT_FALSE(is_read(folder_ / "a.key"));
  fs::remove(inside);
  fs::create_symlink(folder_ / "a.key", inside);
  EXPECT_FALSE(is_read(inside));
  for (const char* folder : {"", "/"}) {
    ::setenv("CREDENTIALS_DIRECTORY", folder, 1);
    EXPECT_FALSE(is_read(folder_ / "a.key")) << folder;
  }
  ::unsetenv("CREDENTIALS_DIRECTORY");
  EXPECT_FALSE(is_read(folder_ / "a.key"));
}

TEST_F(KeyFile, OtherThingsThanFilesAreRefused) {
  const auto of = [](const fs::path& path) { return read_key_file(path).error(); };
  EXPECT_NE(of(folder_ / "missing").find("No such file"), std::string::npos);
  EXPECT_NE(of(folder_).find("not a file"), std::string::npos);
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(of(pipe).find("not a file"), std::string::npos);
}

TEST_F(KeyFile, OtherTextIsRefusedWithFileAndLine) {
  const std::string good = key_text(make_mission_key(), true);
  const std::string other = key_text(make_mission_key(), true);
  const auto line = [](const std::string& text, int number) {
    std::istringstream lines(text);
    std::string at;
    for (int i = 0; i < number; ++i) std::getline(lines, at);
    return at + "\n";
  };
  EXPECT_NE(problem("").find(":1:"), std::string::npos);
  EXPECT_NE(problem("ergocast key 2\n").find(":1: not a key file"), std::string::npos);
  EXPECT_NE(problem(line(good, 1) + line(good, 2)).find("missing"), std::string::npos);
  EXPECT_NE(problem(good + "more\n").find(":5:"), std::string::npos);
  EXPECT_NE(problem(line(good, 1) + "shared 12\n" + line(good, 3)).find(":2:"), std::string::npos);
  EXPECT_NE(problem(line(good, 1) + "shared " + std::string(64, 'g')).find(":2:"),
            std::string::npos);
  EXPECT_NE(problem(good + std::string(5000, '0')).find("too long for a key"), std::string::npos);
  EXPECT_NE(
      problem(line(good, 1) + line(good, 2) + line(good, 3) + line(other, 4)).find("different"),
      std::string::npos);
}

}  // namespace
}  // namespace ergocast
