// SPDX-License-Identifier: BSD-3-Clause
// Follows the log lines of a mission's processes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ergocast::cli {

/// Follows all files of a folder. Long lines are cut. If a file grows faster than it is read, only
/// its newest lines are taken.
class LogLines {
 public:
  static constexpr std::uintmax_t kMostBytes = 16 << 10;  ///< of a file at once

  explicit LogLines(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The complete lines since the last call, sorted by time; empty if the folder does not exist.
  std::vector<std::string> take();

 private:
  std::filesystem::path folder_;
  std::map<std::filesystem::path, std::uintmax_t> read_;  // bytes of each file
};

}  // namespace ergocast::cli
