// SPDX-License-Identifier: BSD-3-Clause
// Turns stop requests into a descriptor that an event loop can wait for.
#pragma once

namespace ergocast {

/// Makes SIGINT and SIGTERM of this process readable from a descriptor. To be created before any
/// thread starts. SIGPIPE is ignored; SIGCHLD gets its default action.
class StopSignals {
 public:
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  int fd() const { return fd_; }
  /// The number of signals since the last call.
  int take();

  /// Removes the mask in a child process, before it executes a program.
  static void restore_in_child();

 private:
  int fd_;
};

/// The name of a signal without "SIG": "SEGV".
const char* signal_name(int signal);

}  // namespace ergocast
