// The study.csv of `ergocast study`, read back point by point.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ergocast::studies {

/// All runs of one combination, ascending by seed.
struct StudyRuns {
  std::vector<std::string> names;  ///< the scenario, then the values of the varied fields
  std::map<std::string, std::vector<double>> columns;  ///< the numbers; what does not exist is nan

  const std::vector<double>& of(const std::string& column) const { return columns.at(column); }
  /// escape_time_<i>_s of all agents together, ascending.
  std::vector<double> escape_times_s() const;
};

/// In the order of the file. Throws std::runtime_error, which names the file, if it cannot be read
/// or has no runs.
std::vector<StudyRuns> read_study(const std::filesystem::path& file);

}  // namespace ergocast::studies
