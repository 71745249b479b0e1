// SPDX-License-Identifier: BSD-3-Clause
// How the points of a study are laid out for its figures.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lab/studies/study_table.h"

namespace ergocast::studies {

/// Points that differ in one field only.
struct StudySeries {
  std::string name;                 ///< empty if there is but one
  std::vector<std::size_t> points;  ///< in the order of StudyLayout::values; all have them
};

struct StudyLayout {
  std::string field;                ///< the one with the most values; "scenario" if none is varied
  std::vector<std::string> values;  ///< ascending if all are numbers, else in the order given
  std::vector<double> numbers;      ///< the same; empty if one is no number
  std::vector<StudySeries> series;
};

StudyLayout layout_of(const Study& study);

}  // namespace ergocast::studies
