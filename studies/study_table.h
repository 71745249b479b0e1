// SPDX-License-Identifier: BSD-3-Clause
// A study's rows as lines of a CSV file: one row a run.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/study_run.h"

namespace ergocast::studies {

/// One combination of what is compared: a scenario, and a value for each varied field.
struct StudyPoint {
  std::string scenario;
  std::vector<std::string> values;  ///< one a field
  int agents = 1;
  double duration_s = 0;

  bool operator==(const StudyPoint&) const = default;
};

struct Study {
  std::vector<std::string> fields;  ///< varied fields, by path
  std::vector<StudyPoint> points;

  bool operator==(const Study&) const = default;
};

/// "law.epsilon = 0.1, time.dt_s = 1", with the scenario before it if there are several.
std::string name_of(const StudyPoint& point, const Study& study);

/// One run and which point it belongs to.
struct StudyRow {
  std::size_t point = 0;
  StudyFigures figures;
};

/// A number that every run has, by its column's name. Times are infinite if they never came.
struct Quantity {
  const char* column;
  double StudyFigures::*value;
};
std::span<const Quantity> quantities();

/// The columns that a study needs; docs/studies.md explains them. Numbers are written so that they
/// read back exactly; nan is an empty cell.
class StudyTable {
 public:
  explicit StudyTable(const Study& study);

  std::string header() const;
  std::string line(const StudyRow& row) const;
  /// Nothing for a line that is no row of this study.
  std::optional<StudyRow> parse(std::string_view line) const;

 private:
  std::optional<std::size_t> point_of(const std::vector<std::string_view>& cells) const;

  const Study& study_;
  std::size_t agents_ = 0,
              steps_ = 0;  // columns for the largest team and the longest mission
};

}  // namespace ergocast::studies
