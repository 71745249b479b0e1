// SPDX-License-Identifier: BSD-3-Clause
// A process that this one starts, watches and ends.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ergocast {

class Child {
 public:
  struct Program {
    std::vector<std::string> command;  ///< path and arguments
    std::filesystem::path log;         ///< gets both output streams; lost where it cannot be opened
    int signal_if_orphaned;            ///< what the kernel sends it when this process is gone
  };

  /// Starts it in a process group of its own, so that Ctrl-C reaches only whoever watches it. An
  /// error if the system has no place for a process; whether it executes the program shows later.
  static std::variant<Child, std::string> start(const Program& program);

  pid_t pid() const { return pid_; }
  /// Takes note if it has ended.
  bool running();
  /// Sends a signal, if it still runs.
  void send(int signal);

  /// After its end: the exit code, or nothing if a signal ended it.
  std::optional<int> exit_code() const;
  /// After its end: whether there ever was a program, or the system would not execute it.
  bool executed() const;
  /// "exited with code 3", "was killed by SIGSEGV" or "could not be executed".
  std::string fate() const;

 private:
  explicit Child(pid_t pid) : pid_(pid) {}
  pid_t pid_;
  std::optional<int> status_;  // as waitpid() gives it
};

/// The last lines of a text file, for telling why a process ended.
std::string last_lines(const std::filesystem::path& file, int count);

}  // namespace ergocast
