// SPDX-License-Identifier: BSD-3-Clause
// Reads CSV files into columns by the names in their headers.
#include "studies/table.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "text/input_file.h"

namespace ergocast::studies {
namespace {

using Cells = std::vector<std::string>;

[[noreturn]] void complain(const std::filesystem::path& file, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + what);
}

Cells cells_of(const std::string& line) {
  Cells cells;
  std::istringstream in(line + ',');
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

void for_each_row(const std::filesystem::path& file,
                  const std::function<void(const Cells& columns, const Cells& cells)>& visit) {
  InputFile in(file);
  std::string line;
  if (in.problem()) complain(file, in.problem()->what);
  if (!std::getline(in, line)) complain(file, "cannot be read");
  const Cells columns = cells_of(line);
  bool any = false;
  for (; std::getline(in, line); any = true) {
    const Cells cells = cells_of(line);
    if (cells.size() != columns.size()) complain(file, "torn row: " + line);
    visit(columns, cells);
  }
  if (!any) complain(file, "has no rows");
}

double number_of(const std::string& cell) {
  return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(cell);
}

}  // namespace

Table read_table(const std::filesystem::path& file) {
  Table table;
  for_each_row(file, [&](const Cells& columns, const Cells& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (columns[i] != "result") {
        table[columns[i]].push_back(std::stod(cells[i]));
      } else if (cells[i] != "fine") {
        complain(file, "seed " + cells[0] + " " + cells[i]);
      }
    }
  });
  return table;
}

std::vector<StudyRuns> read_study(const std::filesystem::path& file) {
  std::vector<StudyRuns> points;
  for_each_row(file, [&](const Cells& columns, const Cells& cells) {
    const auto names = std::find(columns.begin(), columns.end(), "seed") - columns.begin();
    if (names == std::ssize(columns)) complain(file, "is no table of a study");
    const Cells name(cells.begin(), cells.begin() + names);
    if (points.empty() || points.back().names != name) points.push_back({name, {}});
    for (auto i = static_cast<std::size_t>(names); i < cells.size(); ++i) {
      points.back().columns[columns[i]].push_back(number_of(cells[i]));
    }
  });
  return points;
}

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

}  // namespace ergocast::studies
