// SPDX-License-Identifier: BSD-3-Clause
// One table of quantities yields the header, writes each row and reads it back.
#include "studies/study_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

#include "text/read_number.h"

namespace ergocast::studies {
namespace {

std::string text_of(double value) {
  if (std::isnan(value)) return "";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

template <class Number>
bool read_into(std::string_view cell, Number& value) {
  const auto number = read_number<Number>(cell);
  if (number) value = *number;
  return number.has_value();
}

/// The cell's number; nan for an empty one.
bool read(std::string_view cell, double& value) {
  value = std::numeric_limits<double>::quiet_NaN();
  if (cell.empty()) return true;
  return read_into(cell, value);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

constexpr Quantity kQuantities[] = {
    {"ergodic_metric", &StudyFigures::metric},
    {"detection_probability", &StudyFigures::detection_probability},
    {"time_to_half_s", &StudyFigures::half_time_s},
    {"time_to_four_fifths_s", &StudyFigures::four_fifths_time_s},
    {"objects_found", &StudyFigures::objects_found},
    {"time_to_first_find_s", &StudyFigures::first_find_time_s},
    {"wrong_confirmations", &StudyFigures::wrong_confirmations},
    {"greatest_age_s", &StudyFigures::greatest_age_s},
    {"sliced_wasserstein_m", &StudyFigures::wasserstein_m},
    {"path_m", &StudyFigures::path_m},
    {"slope", &StudyFigures::slope},
    {"offset2_mean_m2", &StudyFigures::offset2_mean_m2},
    {"offset2_max_m2", &StudyFigures::offset2_max_m2},
    {"edge_share", &StudyFigures::edge_share},
    {"speed_mean_mps", &StudyFigures::speed_mean_mps},
};

}  // namespace

std::span<const Quantity> quantities() { return kQuantities; }

std::string name_of(const StudyPoint& point, const Study& study) {
  const bool one_scenario =
      std::all_of(study.points.begin(), study.points.end(),
                  [&](const auto& other) { return other.scenario == point.scenario; });
  std::string name = one_scenario && !study.fields.empty() ? "" : point.scenario;
  for (std::size_t i = 0; i < study.fields.size(); ++i) {
    name += (name.empty() ? "" : ", ") + study.fields[i] + " = " + point.values[i];
  }
  return name;
}

StudyTable::StudyTable(const Study& study) : study_(study) {
  double longest_s = 0;
  for (const StudyPoint& point : study.points) {
    agents_ = std::max(agents_, static_cast<std::size_t>(point.agents));
    longest_s = std::max(longest_s, point.duration_s);
  }
  while (steps_ < kLadder_s.size() && kLadder_s[steps_] < longest_s) ++steps_;
}

std::string StudyTable::header() const {
  std::string line = "scenario";
  for (const std::string& field : study_.fields) line += ',' + field;
  line += ",seed,agents,messages";
  for (const Quantity& quantity : kQuantities) line += std::string(",") + quantity.column;
  for (std::size_t i = 0; i < steps_; ++i) {
    char time[16];  // "1.25", never "1e+06"
    const auto end =
        std::to_chars(time, time + sizeof time, kLadder_s[i], std::chars_format::fixed).ptr;
    line += ",ergodic_metric_at_" + std::string(time, end) + "_s";
  }
  for (std::size_t i = 0; i < agents_; ++i) line += ",escape_time_" + std::to_string(i) + "_s";
  return line;
}

std::string StudyTable::line(const StudyRow& row) const {
  const StudyFigures& figures = row.figures;
  std::string line = study_.points[row.point].scenario;
  for (const std::string& value : study_.points[row.point].values) line += ',' + value;
  line += ',' + std::to_string(figures.seed) + ',' + std::to_string(figures.agents) + ',' +
          std::to_string(figures.messages);
  for (const Quantity& quantity : kQuantities) line += ',' + text_of(figures.*quantity.value);
  for (std::size_t i = 0; i < steps_; ++i) line += ',' + text_of(figures.metric_at[i]);
  for (std::size_t i = 0; i < agents_; ++i) line += ',' + text_of(figures.escape_time_s[i]);
  return line;
}

std::optional<std::size_t> StudyTable::point_of(const std::vector<std::string_view>& cells) const {
  const auto found =
      std::find_if(study_.points.begin(), study_.points.end(), [&](const StudyPoint& p) {
        return cells[0] == p.scenario &&
               std::equal(p.values.begin(), p.values.end(), cells.begin() + 1);
      });
  if (found == study_.points.end()) return std::nullopt;
  return static_cast<std::size_t>(found - study_.points.begin());
}

std::optional<StudyRow> StudyTable::parse(std::string_view line) const {
  const std::vector<std::string_view> cells = cells_of(line);
  const std::size_t numbers = 4 + study_.fields.size();  // where they begin
  if (cells.size() != numbers + std::size(kQuantities) + steps_ + agents_) return std::nullopt;
  const std::optional<std::size_t> point = point_of(cells);
  if (!point) return std::nullopt;
  StudyRow row{*point, {}};
  StudyFigures& figures = row.figures;
  figures.complete = true;
  bool good = read_into(cells[numbers - 3], figures.seed) &&
              read_into(cells[numbers - 2], figures.agents) &&
              read_into(cells[numbers - 1], figures.messages);
  figures.metric_at.fill(std::numeric_limits<double>::quiet_NaN());
  figures.escape_time_s.fill(std::numeric_limits<double>::quiet_NaN());
  auto cell = cells.begin() + static_cast<std::ptrdiff_t>(numbers);
  for (const Quantity& quantity : kQuantities)
    good = read(*cell++, figures.*quantity.value) && good;
  for (std::size_t i = 0; i < steps_; ++i) good = read(*cell++, figures.metric_at[i]) && good;
  for (std::size_t i = 0; i < agents_; ++i) good = read(*cell++, figures.escape_time_s[i]) && good;
  if (!good) return std::nullopt;
  return row;
}

}  // namespace ergocast::studies
