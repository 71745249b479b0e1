// SPDX-License-Identifier: BSD-3-Clause
// Checks whether children of this process have ended, without reaping them: the test reaps its
// children itself.
#include "tests/process/support/waiting.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/process/signals.h"
#include "tests/support/own_host.h"

namespace ergocast::test {
namespace {

/// How often a wait checks its condition after the last process has ended. The test itself may have
/// messages to read, or wait for the end of another process.
constexpr int kLastLooks = 10;
constexpr int kMissionFailed = 4;

enum class ProgramEnd { kNone, kInOrder, kFailed, kSeen };

struct Watched {
  pid_t pid;
  std::string command;
  std::filesystem::path log;
  bool in_a_team;
  bool reported = false;
};
std::vector<Watched> watched;

/// How a child that is not reaped yet has ended.
std::optional<siginfo_t> ended_status(pid_t pid) {
  siginfo_t status{};
  if (waitid(P_PID, static_cast<id_t>(pid), &status, WEXITED | WNOHANG | WNOWAIT) != 0) return {};
  return status;
}

ProgramEnd end_of_program(const Watched& program) {
  const auto status = ended_status(program.pid);
  if (!status) return ProgramEnd::kSeen;
  if (status->si_pid == 0) return ProgramEnd::kNone;
  if (status->si_code != CLD_EXITED) {
    const bool sent =
        status->si_status == SIGKILL || status->si_status == SIGTERM || status->si_status == SIGINT;
    return sent ? ProgramEnd::kInOrder : ProgramEnd::kFailed;
  }
  const bool with_its_team = program.in_a_team && status->si_status == kMissionFailed;
  return status->si_status == 0 || with_its_team ? ProgramEnd::kInOrder : ProgramEnd::kFailed;
}

std::string fate_of_program(const Watched& program) {
  const auto status = ended_status(program.pid);
  if (!status) return "has ended";
  if (status->si_code == CLD_EXITED) {
    return "exited with code " + std::to_string(status->si_status);
  }
  return std::string("was killed by SIG") + signal_name(status->si_status);
}

void report_end(Watched& program) {
  constexpr int kLines = 25;
  if (std::exchange(program.reported, true)) return;
  ADD_FAILURE() << program.command << '\n'
                << fate_of_program(program) << " while the test waited; its output ended with\n"
                << last_lines(program.log, kLines);
}

/// Whether the wait is in vain; then the reason is reported, unless `quiet`.
bool in_vain(pid_t awaited, bool quiet) {
  bool all_have_ended = !watched.empty();
  Watched* last = nullptr;
  for (Watched& program : watched) {
    const ProgramEnd end = end_of_program(program);
    all_have_ended = all_have_ended && end != ProgramEnd::kNone;
    const bool this_one = program.pid == awaited && end != ProgramEnd::kNone;
    if (end != ProgramEnd::kFailed && !this_one) {
      if (end != ProgramEnd::kSeen || last == nullptr) last = &program;
      continue;
    }
    if (!quiet) report_end(program);
    return true;
  }
  if (!all_have_ended || !descendants().empty()) return false;
  if (!quiet) report_end(*last);
  return true;
}

/// How many waits are within each other. Only the outermost ends early. So a command that a
/// condition runs still answers in the last check.
struct Depth {
  Depth() { ++now; }
  ~Depth() { --now; }
  static inline int now = 0;
};

bool look_until(const std::function<bool()>& condition, const std::function<void()>& pause,
                pid_t awaited) {
  const Depth depth;
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  for (int looks = 0; !condition(); pause()) {
    if (Depth::now == 1 && in_vain(awaited, looks < kLastLooks)) {
      if (looks++ == kLastLooks) return false;
    } else if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
  }
  return true;
}

void sleep_a_little() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

}  // namespace

Child start_watched(const Child::Program& program) {
  Child child = Child::start(program).value();
  std::string command;
  for (const std::string& word : program.command) command += (command.empty() ? "" : " ") + word;
  const std::string name = std::filesystem::path(program.command.front()).filename();
  watched.push_back({child.pid(), command, program.log, name.starts_with("ergocast-")});
  return child;
}

void forget_watched() { watched.clear(); }

bool eventually(const std::function<bool()>& condition, const std::function<void()>& pause) {
  return look_until(condition, pause ? pause : sleep_a_little, 0);
}

bool eventually(const std::function<bool()>& condition, pid_t awaited) {
  return look_until(condition, sleep_a_little, awaited);
}

}  // namespace ergocast::test
