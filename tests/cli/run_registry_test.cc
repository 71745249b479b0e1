// SPDX-License-Identifier: BSD-3-Clause
// The registry of live runs: its entries, stale entries, and the owner of a trusted folder.
#include "cli/watch/run_registry.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/temp_folder.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

class RunRegistry : public ::testing::Test {
 protected:
  RunRegistry() { setenv("XDG_RUNTIME_DIR", own_.path().c_str(), 1); }

  static LiveRun example() {
    LiveRun run;
    run.run = 0xa1;
    run.scenario = "lake";
    run.version = "1.2.3";
    run.started = "2026-01-31T12:00:00Z";
    run.url.base_port = 24003;
    run.run_dir = "/home/you/runs/la\nke";
    run.key_file = "/home/you/mission.coordinator.key";
    run.pid = 77;
    return run;
  }
  static std::unique_ptr<RunEntry> written(const LiveRun& run) {
    auto entry = RunEntry::write(run);
    if (!entry) ADD_FAILURE() << entry.error();
    return std::move(entry).value();
  }
  fs::path folder() const { return own_.path() / "ergocast"; }
  fs::path file() const { return folder() / "00000000000000a1.json"; }
  void write(const fs::path& path, const std::string& text) const { std::ofstream(path) << text; }
  static mode_t mode_of(const fs::path& path) {
    struct stat status {};
    EXPECT_EQ(lstat(path.c_str(), &status), 0) << path;
    return status.st_mode & 07777;
  }
  /// The only warning about a registry without live runs.
  static std::string warning() {
    const LiveRuns found = live_runs();
    EXPECT_TRUE(found.runs.empty());
    EXPECT_EQ(found.warnings.size(), 1U);
    return found.warnings.empty() ? "" : found.warnings.front();
  }

  const test::TempFolder own_;
};

TEST_F(RunRegistry, AnEntryReadsBackAndIsItsOwnersAlone) {
  EXPECT_TRUE(live_runs().runs.empty());
  const auto entry = written(example());
  EXPECT_EQ(mode_of(folder()), 0700U);
  EXPECT_EQ(mode_of(file()), 0600U);
  const LiveRuns found = live_runs();
  EXPECT_TRUE(found.warnings.empty());
  ASSERT_EQ(found.runs.size(), 1U);
  EXPECT_EQ(to_json_text(found.runs[0]), to_json_text(example()));
  EXPECT_EQ(found.runs[0].url.base(), example().url.base());
  EXPECT_EQ(found.runs[0].key_file, example().key_file);
}

TEST_F(RunRegistry, TheEndRemovesIt) {
  written(example()).reset();
  EXPECT_TRUE(fs::is_empty(folder()));
  const LiveRuns found = live_runs();
  EXPECT_TRUE(found.runs.empty() && found.warnings.empty());
}

TEST_F(RunRegistry, RunsAreInTheOrderInWhichTheyStarted) {
  LiveRun later = example();
  later.run = 0x3;
  later.started = "2026-01-31T12:00:01Z";
  const auto second = written(later), first = written(example());
  const LiveRuns found = live_runs();
  ASSERT_EQ(found.runs.size(), 2U);
  EXPECT_EQ(found.runs[0].run, 0xa1U);
}

TEST_F(RunRegistry, AStaleEntryIsReportedOnceAndRemoved) {
  written(example()).reset();
  write(file(), to_json_text(example()));  // without a lock, as a killed process leaves it
  EXPECT_NE(warning().find("run 00000000000000a1 of lake, /home/you/runs/la\nke: its "
                           "`ergocast run` was killed"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_TRUE(live_runs().warnings.empty());
}

TEST_F(RunRegistry, ARunThatIsPreparedHasNoUrlAndNoFolder) {
  LiveRun run = example();
  run.preparing = true;
  auto entry = written(run);
  const LiveRuns found = live_runs();
  ASSERT_EQ(found.runs.size(), 1U);
  EXPECT_EQ(to_json_text(found.runs[0]), to_json_text(run));
  EXPECT_TRUE(found.runs[0].preparing);
  EXPECT_TRUE(found.runs[0].run_dir.empty());
  entry.reset();
  write(file(), to_json_text(run));  // as a killed process leaves it: it had started nothing
  EXPECT_TRUE(live_runs().warnings.empty());
  EXPECT_FALSE(fs::exists(file()));
}

TEST_F(RunRegistry, AFileThatIsNoEntryIsReportedAndLeftAlone) {
  written(example()).reset();
  std::string text = to_json_text(example());
  const auto with = [&text](const std::string& part, const std::string& other) {
    std::string changed = text;
    const auto at = changed.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return changed.replace(at, part.size(), other);
  };
  for (const auto& [content, why] : std::vector<std::pair<std::string, std::string>>{
           {"", "is no entry of a run"},
           {"[1, 2]", "is no entry of a run"},
           {text.substr(0, text.size() / 2), "is no entry of a run"},
           {with("\"scenario\"", "\"scenery\""), "scenario is missing"},
           {with("\"lake\"", "7"), "scenario is missing or no text"},
           {with("\"lake\"", "\"la\\u001bke\""), "scenario is no name"},
           {with("00000000000000a1", "a1"), "run_id is no number"},
           {with("00000000000000a1", "00000000000000a2"), "is not named after its run"},
           {with("udpm:", "tcp:"), "lcm_url: "},
           {with("\"/home/you/runs", "\"runs"), "run_dir is no absolute path"},
           {with("\"/home/you/mission", "\"mission"), "key_file is no absolute path"},
           {with("77", "\"x\""), "pid is missing or no number"},
           {with("77", "-1"), "pid is missing or no number"},
           {with("\"pid\"", "\"preparing\": 1, \"pid\""), "preparing is neither true nor false"},
           {text + std::string(1 << 16, ' '), "is larger than an entry can be"}}) {
    write(file(), content);
    const std::string printed = warning();
    EXPECT_NE(printed.find(file().string() + ": "), std::string::npos) << printed;
    EXPECT_NE(printed.find(why), std::string::npos) << printed << " instead of " << why;
    EXPECT_TRUE(fs::exists(file()));
  }
}

TEST_F(RunRegistry, NoLinkPipeOrFolderIsRead) {
  written(example()).reset();
  write(own_.path() / "elsewhere", to_json_text(example()));
  fs::create_symlink(own_.path() / "elsewhere", file());
  EXPECT_NE(warning().find("is no file of this user"), std::string::npos);
  fs::remove(file());
  ASSERT_EQ(mkfifo(file().c_str(), 0600), 0);
  EXPECT_NE(warning().find("is no file of this user"), std::string::npos);
  fs::remove(file());
  fs::create_directory(file());
  EXPECT_NE(warning().find("is no file of this user"), std::string::npos);
}

TEST_F(RunRegistry, AFolderThatOthersShareIsRefused) {
  fs::create_directory(folder());
  fs::permissions(folder(), fs::perms::owner_all | fs::perms::group_read);
  EXPECT_NE(warning().find("other users own it, read it or write to it"), std::string::npos);
  EXPECT_FALSE(RunEntry::write(example()));
  EXPECT_TRUE(fs::is_empty(folder()));
  fs::remove(folder());
  fs::create_directory(own_.path() / "other");
  fs::permissions(own_.path() / "other", fs::perms::owner_all);
  fs::create_symlink(own_.path() / "other", folder());
  EXPECT_NE(warning().find("is no folder"), std::string::npos);
  EXPECT_FALSE(RunEntry::write(example()));
  if (geteuid() != 0) return;
  fs::remove(folder());
  fs::create_directory(folder());
  fs::permissions(folder(), fs::perms::owner_all);
  ASSERT_EQ(chown(folder().c_str(), 12345, 12345), 0);
  EXPECT_NE(warning().find("other users own it"), std::string::npos);
}

TEST_F(RunRegistry, WithoutAFolderOfTheSessionItIsInTmp) {
  const fs::path fallback = "/tmp/ergocast-" + std::to_string(geteuid());
  EXPECT_EQ(run_registry(), folder());
  for (const char* other : {"", "relative", "/nowhere/at/all", "/usr"}) {
    setenv("XDG_RUNTIME_DIR", other, 1);
    EXPECT_EQ(run_registry(), fallback) << other;
  }
  unsetenv("XDG_RUNTIME_DIR");
  EXPECT_EQ(run_registry(), fallback);
}

}  // namespace
}  // namespace ergocast::cli
