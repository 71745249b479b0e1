// SPDX-License-Identifier: BSD-3-Clause
// The names of a team's clients: each process has a file, and a killed process has none.
#include "cli/watch/client_list.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "cli/watch/run_registry.h"
#include "tests/support/temp_folder.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;
using Names = std::vector<std::string>;

class NamedClients : public ::testing::Test {
 protected:
  NamedClients() { setenv("XDG_RUNTIME_DIR", own_.path().c_str(), 1); }
  std::string text_of(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(own_.path() / name).rdbuf();
    return text.str();
  }
  std::ptrdiff_t files() const {
    const auto folder = own_.path() / "ergocast";
    return std::distance(std::filesystem::directory_iterator(folder), {});
  }
  const test::TempFolder own_;
};

TEST_F(NamedClients, AreThoseOfTheRunAndItsOwnersAlone) {
  EXPECT_EQ(named_clients(1), Names());
  {
    ClientFile one, other;
    one.write(1, {"browser b", "browser a"});
    other.write(2, {"browser c"});
    EXPECT_EQ(named_clients(1), (Names{"browser a", "browser b"}));
    EXPECT_EQ(named_clients(2), Names{"browser c"});
    one.write(1, {"browser b"});
    EXPECT_EQ(named_clients(1), Names{"browser b"});
    EXPECT_TRUE(live_runs().warnings.empty());
    for (const auto& file : std::filesystem::directory_iterator(own_.path() / "ergocast"))
      EXPECT_EQ(file.status().permissions(), std::filesystem::perms(0600));
  }
  EXPECT_EQ(files(), 0);
}

TEST_F(NamedClients, OfAProcessThatWasKilledAreForgotten) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    ClientFile file;
    file.write(1, {"browser a"});
    (void)!write(ready[1], "x", 1);
    for (;;) pause();
  }
  char sign = 0;
  ASSERT_EQ(read(ready[0], &sign, 1), 1);
  EXPECT_EQ(named_clients(1), Names{"browser a"});
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(named_clients(1), Names());
  EXPECT_EQ(files(), 0);
}

TEST_F(NamedClients, StandFilesThatAreNone) {
  ClientFile file;
  file.write(1, {"browser a"});
  const auto folder = own_.path() / "ergocast";
  for (const char* text : {"", "[", "{}", "[1, {}, [\"x\"]]", "\"x\""}) {
    const auto bad = folder / ".clients-0000000000000001-99";
    std::ofstream(bad) << text;
    const int held = open(bad.c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(flock(held, LOCK_EX), 0);
    EXPECT_EQ(named_clients(1), Names{"browser a"}) << text;
    close(held);
  }
  // Even if what a link leads to looks like a live file.
  const auto elsewhere = own_.path() / "elsewhere";
  std::ofstream(elsewhere) << "[\"browser x\"]";
  const int held = open(elsewhere.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  std::filesystem::create_symlink(elsewhere, folder / ".clients-0000000000000001-96");
  std::filesystem::create_directory(folder / ".clients-0000000000000001-98");
  std::filesystem::create_symlink("/dev/zero", folder / ".clients-0000000000000001-97");
  EXPECT_EQ(named_clients(1), Names{"browser a"});
  close(held);
}

TEST_F(NamedClients, AreFewAndShortAndPrintable) {
  ClientFile file;
  file.write(1, Names(100, std::string("\x1b[2J") + std::string(300, 'a')));
  const Names named = named_clients(1);
  EXPECT_EQ(named.size(), kMostNamedClients);
  for (const std::string& name : named) {
    EXPECT_EQ(name.find('\x1b'), std::string::npos) << name;
    EXPECT_LT(name.size(), 220U);
  }
  // Nor are there more in the file of a process that has written more.
  file.write(1, {});
  const auto other = own_.path() / "ergocast/.clients-0000000000000001-99";
  std::string many = "[\"x\"";
  for (int i = 1; i < 100; ++i) many += ",\"x\"";
  std::ofstream(other) << many << ']';
  const int held = open(other.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  EXPECT_EQ(named_clients(1).size(), kMostNamedClients);
  close(held);
}

TEST_F(NamedClients, AreThoseOfAllProcesses) {
  ClientFile own;
  own.write(1, {"browser a"});
  // Another process's file: it is live while somebody holds its lock.
  const auto other = own_.path() / "ergocast/.clients-0000000000000001-99";
  std::ofstream(other) << "[\"browser b\"]";
  const int held = open(other.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  EXPECT_EQ(named_clients(1), (Names{"browser a", "browser b"}));
  close(held);
  EXPECT_EQ(named_clients(1), Names{"browser a"});
  EXPECT_FALSE(std::filesystem::exists(other));
}

TEST_F(NamedClients, AreLoggedWhenTheyComeAndGo) {
  Names notes;
  const Instant start{100s};
  {
    ClientList list(own_.path() / "watch.log", "watch",
                    [&](const std::string& note) { notes.push_back(note); });
    list.update(0, {"browser a"}, start);
    EXPECT_EQ(notes, Names());  // no team is known
    list.update(7, {"browser a"}, start);
    list.update(7, {"browser a"}, start);
    EXPECT_EQ(notes, Names{"browser a is connected"});
    list.update(7, {"browser b"}, start + 2s);
    EXPECT_EQ(notes,
              (Names{"browser a is connected", "browser b is connected", "browser a has left"}));
    EXPECT_EQ(named_clients(7), Names{"browser b"});
    // One that connects again and again does not fill the log.
    for (int i = 0; i < 100; ++i) list.update(7, {std::to_string(i)}, start + 3s);
    EXPECT_EQ(notes.size(), 3U + 4);
  }
  EXPECT_EQ(named_clients(7), Names());
  const std::string log = text_of("watch.log");
  EXPECT_NE(log.find(" info watch: browser a is connected\n"), std::string::npos) << log;
  EXPECT_NE(log.find(" info watch: browser a has left\n"), std::string::npos) << log;
}

}  // namespace
}  // namespace ergocast::cli
