// SPDX-License-Identifier: BSD-3-Clause
// Shows a study as a page and as lines on a terminal.
#pragma once

#include <string>
#include <vector>

#include "studies/study_summary.h"

namespace ergocast::studies {

struct StudyFacts {
  const Study& study;
  std::string version;
  std::string command;                      ///< that makes the study
  std::vector<std::string> point_commands;  ///< one a point: runs its mission once
};

/// report.html: one page that needs nothing but itself.
std::string study_page(const StudyFacts& facts, const std::vector<PointSummary>& summaries);

/// One line a point below a head.
std::string study_text(const Study& study, const std::vector<PointSummary>& summaries);
/// The same of one quantity.
std::string quantity_text(const Study& study, const char* name,
                          const std::vector<QuantitySummary>& summaries);

}  // namespace ergocast::studies
