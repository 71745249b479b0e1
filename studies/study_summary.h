// SPDX-License-Identifier: BSD-3-Clause
// Summarises the runs of each point of a study.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "report/statistics.h"
#include "studies/study_table.h"

namespace ergocast::studies {

struct PointSummary {
  std::size_t runs = 0;
  Estimate metric;  ///< φ² at the end: the median
  /// φ² at the end against the study's first point: the geometric mean of the ratios of equal
  /// seeds. Nothing if they share none.
  std::optional<Estimate> ratio;
  /// t [s] and the median of φ², at the times that all runs have; the end is last.
  std::vector<std::pair<double, Estimate>> metric_over_time;
  std::optional<double> slope;  ///< median
  /// Medians of the probability that the team has found an object at the end, and of the time after
  /// which it was ½ [s]; infinite if most runs never get there.
  std::optional<Estimate> found, half_time_s;
  /// One for each agent of each run that starts on a manifold, ascending; infinite at the end.
  std::vector<double> escape_times_s;
  double offset2_mean_m2 = 0;                               ///< mean over the runs
  double offset2_max_m2 = 0;                                ///< greatest of all runs
  double edge_share = 0, speed_mean_mps = 0, messages = 0;  ///< means over the runs

  /// The share of escape_times_s up to `t_s`. @pre there are some
  double escaped_share(double t_s) const;
};

/// One quantity of a point's runs.
struct QuantitySummary {
  std::size_t runs = 0;
  Estimate value;  ///< the median of the runs that have it
  /// Against the study's first point, as PointSummary::ratio. Nothing if one of the point's values
  /// is 0 or infinite.
  std::optional<Estimate> ratio;
};

/// One a point.
std::vector<QuantitySummary> summarize(const Study& study, const std::vector<StudyRow>& rows,
                                       const Quantity& quantity);

/// One a point; a point without runs has runs == 0 and nothing else.
std::vector<PointSummary> summarize(const Study& study, const std::vector<StudyRow>& rows);

}  // namespace ergocast::studies
