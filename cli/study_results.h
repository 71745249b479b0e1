// SPDX-License-Identifier: BSD-3-Clause
// What a study shows when its runs are there, flown or merged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/study_directory.h"

namespace ergocast::cli {

struct StudyResults {
  const studies::Study& study;
  std::string command;                       ///< that makes it, but for --out
  const std::vector<std::string>& missions;  ///< the command of one mission of each point
  std::uint64_t first_seed;
  std::filesystem::path out;
};

/// Sorts the table, prints the points and their commands, and writes the page. An error if one of
/// the files cannot be written.
std::optional<std::string> conclude(StudyDirectory& directory, const StudyResults& results);

}  // namespace ergocast::cli
