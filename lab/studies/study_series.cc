// SPDX-License-Identifier: BSD-3-Clause
// The field with the most values becomes the main one; every combination of the others makes one
// series.
#include "lab/studies/study_series.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "text/read_number.h"

namespace ergocast::studies {
namespace {

/// The values of field `field` (−1: the scenarios), each once.
std::vector<std::string> values_of(const Study& study, int field) {
  std::vector<std::string> values;
  for (const StudyPoint& point : study.points) {
    const std::string& value =
        field < 0 ? point.scenario : point.values[static_cast<std::size_t>(field)];
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

int main_field(const Study& study) {
  int best = study.fields.empty() ? -1 : 0;
  for (int i = 1; i < static_cast<int>(study.fields.size()); ++i) {
    if (values_of(study, i).size() > values_of(study, best).size()) best = i;
  }
  return best;
}

/// Sorts values that are all numbers.
void sort_by_number(StudyLayout& layout) {
  std::vector<std::pair<double, std::string>> sorted;
  for (const std::string& value : layout.values) {
    const auto number = read_number<double>(value);
    if (!number) return;
    sorted.emplace_back(*number, value);
  }
  std::sort(sorted.begin(), sorted.end());
  layout.values.clear();
  for (const auto& [number, value] : sorted) {
    layout.numbers.push_back(number);
    layout.values.push_back(value);
  }
}

/// What a point is besides its value of the main field.
std::string series_of(const StudyPoint& point, const Study& study, int main) {
  const bool several_scenarios = main >= 0 && values_of(study, -1).size() > 1;
  std::string name = several_scenarios ? point.scenario : "";
  for (std::size_t i = 0; i < study.fields.size(); ++i) {
    if (static_cast<int>(i) == main) continue;
    name += (name.empty() ? "" : ", ") + study.fields[i] + " = " + point.values[i];
  }
  return name;
}

}  // namespace

StudyLayout layout_of(const Study& study) {
  StudyLayout layout;
  const int main = main_field(study);
  layout.field = main < 0 ? "scenario" : study.fields[static_cast<std::size_t>(main)];
  layout.values = values_of(study, main);
  sort_by_number(layout);
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    const StudyPoint& point = study.points[i];
    const std::string name = series_of(point, study, main);
    const auto [at, is_new] = index.emplace(name, layout.series.size());
    if (is_new) layout.series.push_back({name, std::vector<std::size_t>(layout.values.size())});
    const std::string& value =
        main < 0 ? point.scenario : point.values[static_cast<std::size_t>(main)];
    const auto place =
        std::find(layout.values.begin(), layout.values.end(), value) - layout.values.begin();
    layout.series[at->second].points[static_cast<std::size_t>(place)] = i;
  }
  return layout;
}

}  // namespace ergocast::studies
