// SPDX-License-Identifier: BSD-3-Clause
// A child process that this process starts, watches and ends.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace ergocast {

class Child {
 public:
  struct Program {
    std::vector<std::string> command;  ///< path and arguments
    std::filesystem::path log;         ///< gets both output streams; lost if it cannot be opened
    int signal_if_orphaned;            ///< the kernel sends it when this process ends
    std::vector<std::string> environment = {};  ///< "NAME=VALUE", besides this process's own
    std::vector<int> descriptors = {};          ///< it has them as 3, 4, …, and no others

    /// Adds a descriptor. @return the path under which the program can open the file again
    std::string hand(int descriptor);
  };

  /// Starts the program in its own process group, so that Ctrl-C reaches only this process. An
  /// error if the system cannot create a process. executed() tells later whether it ran the
  /// program.
  static Result<Child> start(const Program& program);

  pid_t pid() const { return pid_; }
  /// Whether it runs; if it has ended, the result is stored.
  bool running();
  /// Sends a signal if the process still runs.
  void send(int signal);

  /// After its end: the exit code, or nothing if a signal ended it.
  std::optional<int> exit_code() const;
  /// After its end: whether the system executed the program.
  bool executed() const;
  /// "exited with code 3", "was killed by SIGSEGV" or "could not be executed".
  std::string fate() const;

 private:
  explicit Child(pid_t pid) : pid_(pid) {}
  pid_t pid_;
  std::optional<int> status_;  // as waitpid() gives it
};

/// How long to wait before a process is started again, after so many ends or failed starts: 0.5, 1,
/// 2, 4, 4 … s.
std::chrono::nanoseconds restart_delay(int failures);

/// The last lines of a text file, to explain why a process ended.
std::string last_lines(const std::filesystem::path& file, int count);

}  // namespace ergocast
