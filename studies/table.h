// SPDX-License-Identifier: BSD-3-Clause
// Reads the CSV files for tables and figures: numbers by column.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ergocast::studies {

using Table = std::map<std::string, std::vector<double>>;

/// A file of `ergocast simulate --seeds … --out FILE` or of a part of a study: numbers by column,
/// in the order of the file. Throws std::runtime_error with the file's name if the file cannot be
/// read, has no rows or an incomplete one, or if one of its missions failed.
Table read_table(const std::filesystem::path& file);

/// All runs of one point of a study, ascending by seed.
struct StudyRuns {
  std::vector<std::string> names;  ///< the scenario, then the values of the varied fields
  Table columns;                   ///< what does not exist is nan

  const std::vector<double>& of(const std::string& column) const { return columns.at(column); }
  /// escape_time_<i>_s of all agents together, ascending; infinite where one did not escape.
  std::vector<double> escape_times_s() const;
};

/// The study.csv of `ergocast study`, point by point in the order of the file. Throws as
/// read_table().
std::vector<StudyRuns> read_study(const std::filesystem::path& file);

}  // namespace ergocast::studies
