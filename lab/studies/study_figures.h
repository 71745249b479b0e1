// SPDX-License-Identifier: BSD-3-Clause
// The figures of a study.
//
// One varied field is told apart within a figure: the one with the most values. What remains, the
// scenarios and the other fields, makes series: a panel or a colour each.
#pragma once

#include <vector>

#include "lab/studies/study_summary.h"
#include "report/figures.h"

namespace ergocast::studies {

/// φ² against the field, then φ² over time and the escapes of each series.
/// @pre a summary for each point
std::vector<Figure> study_figures(const Study& study, const std::vector<PointSummary>& summaries);

}  // namespace ergocast::studies
