// SPDX-License-Identifier: BSD-3-Clause
// The clients of a team's displays on this host: `ergocast status` and every page name them.
//
// Each process that serves clients keeps a file with their names in the registry of live runs
// (cli/watch/run_registry.h). No message carries them, and no agent knows of them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "runtime/bus/socket.h"

namespace spdlog {
class logger;
}

namespace ergocast::cli {

/// Limit (Page): clients of one process that `ergocast status` and the page name. Beyond it: the
/// rest is not named.
inline constexpr std::size_t kMostNamedClients = 64;

/// The file of this process. It is live while the process holds its lock, so the kernel ends it.
class ClientFile {
 public:
  ClientFile() = default;
  ClientFile(const ClientFile&) = delete;
  ClientFile& operator=(const ClientFile&) = delete;
  ~ClientFile();
  /// Only its owner can read it. Where the registry cannot be used, nothing is written.
  void write(RunId run, const std::vector<std::string>& names);

 private:
  std::string name_;  // empty: there is no file
  std::optional<Socket> folder_, file_;
};

/// The clients of all processes of this user that show this run, sorted. Files of processes that
/// were killed are removed.
std::vector<std::string> named_clients(RunId run);

/// Names the clients of this process in its file, and writes each arrival and departure to the log
/// of the run directory, so that the record has them.
class ClientList {
 public:
  using Note = std::function<void(const std::string& sentence)>;
  /// @param log   gets a sentence for each arrival and departure; empty: none
  /// @param note  gets the same sentences; null: nothing does
  ClientList(const std::filesystem::path& log, const std::string& process_name, Note note);
  /// Call it a few times a second. @param run  0: not known yet
  void update(RunId run, std::vector<std::string> names, Instant now);
  /// Writes a sentence about a client.
  void note(const std::string& sentence);

 private:
  std::shared_ptr<spdlog::logger> log_;  // null: there is none
  Note note_;
  ClientFile file_;
  RunId run_ = 0;
  std::vector<std::string> names_;
  Instant second_{};
  int notes_ = 0;  // since `second_`
};

}  // namespace ergocast::cli
