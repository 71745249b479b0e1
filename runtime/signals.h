// SPDX-License-Identifier: BSD-3-Clause
// Requests to end, as something to wait for instead of something that interrupts.
#pragma once

namespace ergocast {

/// Turns SIGINT and SIGTERM of this process into a readable descriptor. To be made before any
/// thread starts, LCM's included. SIGPIPE is ignored,
/// SIGCHLD as it is by default.
class StopSignals {
 public:
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  int fd() const { return fd_; }
  /// How many have come since the last call.
  int take();

  /// Undoes the masking in a child process, before it executes something else.
  static void restore_in_child();

 private:
  int fd_;
};

/// The name of a signal without "SIG": "SEGV".
const char* signal_name(int signal);

}  // namespace ergocast
