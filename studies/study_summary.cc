// SPDX-License-Identifier: BSD-3-Clause
// Reduces the runs of each point to medians and means, and to ratios with the first point over
// common seeds.
#include "studies/study_summary.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ergocast::studies {
namespace {

using Runs = std::map<std::uint64_t, const StudyFigures*>;  // by seed

std::vector<Runs> runs_by_point(const Study& study, const std::vector<StudyRow>& rows) {
  std::vector<Runs> runs(study.points.size());
  for (const StudyRow& row : rows) runs[row.point][row.figures.seed] = &row.figures;
  return runs;
}

double mean_of(const Runs& runs, double (*value)(const StudyFigures&)) {
  double sum = 0;
  for (const auto& [seed, figures] : runs) sum += value(*figures);
  return sum / static_cast<double>(runs.size());
}

/// The values that are not nan.
std::vector<double> values_of(const Runs& runs, const auto& value) {
  std::vector<double> values;
  for (const auto& [seed, figures] : runs) {
    if (!std::isnan(value(*figures))) values.push_back(value(*figures));
  }
  return values;
}

/// The median of the values that are not nan.
std::optional<Estimate> median_of_known(const Runs& runs, double StudyFigures::*value) {
  const auto known = values_of(runs, [&](const StudyFigures& figures) { return figures.*value; });
  if (known.empty()) return std::nullopt;
  return median_of(known);
}

double metric_of(const StudyFigures& figures) { return figures.metric; }

/// Whether a ratio can have this value.
bool is_factor(double value) { return value > 0 && std::isfinite(value); }

/// The ratios of the pairs whose values are both factors.
std::optional<Estimate> ratio_to(const Runs& first, const Runs& runs, double StudyFigures::*value) {
  std::vector<double> ours, theirs;
  for (const auto& [seed, figures] : runs) {
    const auto twin = first.find(seed);
    if (twin == first.end()) continue;
    if (!is_factor(figures->*value) || !is_factor(twin->second->*value)) continue;
    ours.push_back(figures->*value);
    theirs.push_back(twin->second->*value);
  }
  if (ours.empty()) return std::nullopt;
  return ratio_of(ours, theirs);
}

std::vector<std::pair<double, Estimate>> over_time(const Runs& runs, double duration_s) {
  std::vector<std::pair<double, Estimate>> medians;
  for (std::size_t i = 0; i < kLadder_s.size() && kLadder_s[i] < duration_s; ++i) {
    const auto values = values_of(runs, [i](const StudyFigures& f) { return f.metric_at[i]; });
    if (!values.empty()) medians.emplace_back(kLadder_s[i], median_of(values));
  }
  medians.emplace_back(duration_s, median_of(values_of(runs, metric_of)));
  return medians;
}

std::vector<double> escape_times_of(const Runs& runs) {
  std::vector<double> times_s;
  for (const auto& [seed, figures] : runs) {
    std::copy_if(figures->escape_time_s.begin(), figures->escape_time_s.end(),
                 std::back_inserter(times_s), [](double t_s) { return !std::isnan(t_s); });
  }
  std::sort(times_s.begin(), times_s.end());
  return times_s;
}

PointSummary summary_of(const Runs& runs, const Runs& first, double duration_s) {
  PointSummary summary;
  summary.runs = runs.size();
  if (runs.empty()) return summary;
  summary.metric = median_of(values_of(runs, metric_of));
  summary.ratio = ratio_to(first, runs, &StudyFigures::metric);
  summary.metric_over_time = over_time(runs, duration_s);
  const auto slopes = values_of(runs, [](const StudyFigures& f) { return f.slope; });
  if (!slopes.empty()) summary.slope = median_of(slopes).value;
  summary.found = median_of_known(runs, &StudyFigures::detection_probability);
  summary.half_time_s = median_of_known(runs, &StudyFigures::half_time_s);
  summary.escape_times_s = escape_times_of(runs);
  summary.offset2_mean_m2 = mean_of(runs, [](const StudyFigures& f) { return f.offset2_mean_m2; });
  for (const auto& [seed, figures] : runs) {
    summary.offset2_max_m2 = std::max(summary.offset2_max_m2, figures->offset2_max_m2);
  }
  summary.edge_share = mean_of(runs, [](const StudyFigures& f) { return f.edge_share; });
  summary.speed_mean_mps = mean_of(runs, [](const StudyFigures& f) { return f.speed_mean_mps; });
  summary.messages =
      mean_of(runs, [](const StudyFigures& f) { return static_cast<double>(f.messages); });
  return summary;
}

}  // namespace

double PointSummary::escaped_share(double t_s) const {
  const auto end = std::upper_bound(escape_times_s.begin(), escape_times_s.end(), t_s);
  return static_cast<double>(end - escape_times_s.begin()) /
         static_cast<double>(escape_times_s.size());
}

std::vector<QuantitySummary> summarize(const Study& study, const std::vector<StudyRow>& rows,
                                       const Quantity& quantity) {
  const std::vector<Runs> runs = runs_by_point(study, rows);
  const auto value_of = [&](const StudyFigures& figures) { return figures.*quantity.value; };
  std::vector<QuantitySummary> summaries;
  for (const Runs& point : runs) {
    QuantitySummary& summary = summaries.emplace_back();
    const std::vector<double> values = values_of(point, value_of);
    summary.runs = values.size();
    if (values.empty()) continue;
    summary.value = median_of(values);
    if (std::ranges::all_of(values, is_factor))
      summary.ratio = ratio_to(runs[0], point, quantity.value);
  }
  return summaries;
}

std::vector<PointSummary> summarize(const Study& study, const std::vector<StudyRow>& rows) {
  const std::vector<Runs> runs = runs_by_point(study, rows);
  std::vector<PointSummary> summaries;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    summaries.push_back(summary_of(runs[i], runs[0], study.points[i].duration_s));
  }
  return summaries;
}

}  // namespace ergocast::studies
