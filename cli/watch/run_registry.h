// SPDX-License-Identifier: BSD-3-Clause
// The live runs of this user on this host: a folder with one file for each `ergocast run`.
//
// The folder is $XDG_RUNTIME_DIR/ergocast, or /tmp/ergocast-<user id> where XDG_RUNTIME_DIR names
// no folder that is this user's alone. A run is live while its process holds the lock of its file,
// so the kernel ends the entry, however the process ends.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/bus/socket.h"

namespace ergocast::cli {

/// The contents of a run's file.
struct LiveRun {
  RunId run = 0;
  std::string scenario, version;
  std::string started;  ///< "2026-01-31T12:00:00Z"
  LcmUrl url;
  std::filesystem::path run_dir, key_file;  ///< absolute; no key file: empty
  int pid = 0;                              ///< of `ergocast run`
  /// It still reads its scenario, and computes modes. It has no processes, and neither URL nor
  /// folder.
  bool preparing = false;
};

std::string to_json_text(const LiveRun& run);
/// The run, or the error in the text.
Result<LiveRun> live_run_from(std::string_view text);

/// The folder, whether it exists or not.
std::filesystem::path run_registry();
/// Opens the folder. Without it an invalid descriptor, or it is made. An error if it is not this
/// user's alone, or if it cannot be made.
Result<Socket> open_run_registry(bool make);

/// The file <run>.json of this process's run: only its owner can read it; it is removed at the end.
class RunEntry {
 public:
  /// Makes the folder if it is missing. An error if the folder is not this user's alone, or if it
  /// cannot be written.
  static Result<std::unique_ptr<RunEntry>> write(const LiveRun& run);
  RunEntry(const RunEntry&) = delete;
  RunEntry& operator=(const RunEntry&) = delete;
  ~RunEntry();

 private:
  RunEntry(int folder, int file, std::string name);
  int folder_, file_;
  std::string name_;
};

struct LiveRuns {
  std::vector<LiveRun> runs;          ///< in the order in which they were started
  std::vector<std::string> warnings;  ///< one sentence for each unusable entry
};

/// Reads the folder. An entry whose run was killed is reported and removed; a file that is no entry
/// is reported and left alone.
LiveRuns live_runs();

}  // namespace ergocast::cli
