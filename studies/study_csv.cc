#include "studies/study_csv.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace ergocast::studies {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line + ",");
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

double number_of(const std::string& cell) {
  return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(cell);
}

}  // namespace

std::vector<double> StudyRuns::escape_times_s() const {
  std::vector<double> times_s;
  for (const auto& [column, values] : columns) {
    if (!column.starts_with("escape_time_")) continue;
    std::copy_if(values.begin(), values.end(), std::back_inserter(times_s),
                 [](double value) { return !std::isnan(value); });
  }
  std::sort(times_s.begin(), times_s.end());
  return times_s;
}

std::vector<StudyRuns> read_study(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = cells_of(line);
  const auto seed = std::find(header.begin(), header.end(), "seed");
  if (seed == header.end()) throw std::runtime_error(file.string() + ": is no table of a study");
  const auto names = static_cast<std::size_t>(seed - header.begin());
  std::vector<StudyRuns> all;
  while (std::getline(stream, line)) {
    std::vector<std::string> cells = cells_of(line);
    if (cells.size() != header.size())
      throw std::runtime_error(file.string() + ": has a torn line");
    const std::vector<std::string> name(cells.begin(),
                                        cells.begin() + static_cast<std::ptrdiff_t>(names));
    if (all.empty() || all.back().names != name) all.push_back({name, {}});
    for (std::size_t i = names; i < cells.size(); ++i) {
      all.back().columns[header[i]].push_back(number_of(cells[i]));
    }
  }
  if (all.empty()) throw std::runtime_error(file.string() + ": has no runs");
  return all;
}

}  // namespace ergocast::studies
