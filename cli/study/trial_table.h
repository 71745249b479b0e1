// SPDX-License-Identifier: BSD-3-Clause
// The results of many trials: one CSV row for each seed, and a summary for people.
#pragma once

#include <string>

#include "lab/trial.h"

namespace ergocast::cli {

enum class Verdict { kFine, kTimedOut, kViolated, kDied };

/// The result of one seed, as a worker sends it.
struct TrialReport {
  lab::TrialFigures figures;
  Verdict verdict = Verdict::kFine;
  char what[600] = "";  ///< the violation, or how the process ended
};

/// Has a column `basis` if φ² is not in cosines.
std::string csv_header(const Basis& basis);
std::string csv_row(const TrialReport& report, const Basis& basis);

/// Sums over all trials so far.
struct TrialTotals {
  lab::TrialFigures sums;  ///< sums; recovery_max_s is the maximum
  std::int64_t trials = 0, timed_out = 0, failed = 0;
  double worst_metric = 0, worst_view_error = 0, recovery_sum_s = 0;

  void add(const TrialReport& report);
  /// Several lines; they name the basis of φ², unless it is cosines.
  std::string describe(double wall_s, const Basis& basis) const;
};

}  // namespace ergocast::cli
