// SPDX-License-Identifier: BSD-3-Clause
// The lines that the processes of a mission log, while they do so.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ergocast::cli {

/// Follows all files of a folder. Lines are cut to a limit, and of a file that grows faster than it
/// is read only the newest are taken.
class LogLines {
 public:
  static constexpr std::uintmax_t kMostBytes = 16 << 10;  ///< of a file at once

  explicit LogLines(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The whole lines since the last call, by their times; none if there is no such folder.
  std::vector<std::string> take();

 private:
  std::filesystem::path folder_;
  std::map<std::filesystem::path, std::uintmax_t> read_;  // bytes of each file
};

}  // namespace ergocast::cli
