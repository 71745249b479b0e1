// SPDX-License-Identifier: BSD-3-Clause
// The results of a study whose runs were simulated or merged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/study/study_directory.h"

namespace ergocast::cli {

struct StudyResults {
  const studies::Study& study;
  std::string command;                       ///< makes it, without --out
  const std::vector<std::string>& missions;  ///< the command of one mission of each point
  std::uint64_t first_seed;
  std::filesystem::path out;
  const std::vector<std::string>& measures;  ///< columns of study.csv to print besides
};

/// Sorts the table, prints the points and their commands, and writes the page. An error if one of
/// the files cannot be written.
std::optional<std::string> conclude(StudyDirectory& directory, const StudyResults& results);

}  // namespace ergocast::cli
