// SPDX-License-Identifier: BSD-3-Clause
// The parts of this study. Each runs its missions with seeds 1 … `seeds`, adds the figures and
// prints a table.
#pragma once

#include <array>
#include <string>

#include "studies/changing/results.h"

namespace ergocast::studies {

/// When φ² is measured, after a jump.
inline constexpr std::array kMeasured_s = {100, 200, 600};
inline std::string measured_at(int at_s) { return "after " + std::to_string(at_s) + " s"; }

/// Peaks that jump once, ideal teams.
void study_jumps(int seeds, Results& results);
/// Peaks that drift, ideal teams.
void study_drifts(int seeds, Results& results);
/// Peaks that jump once, teams that exchange messages.
void study_messages(int seeds, Results& results);

}  // namespace ergocast::studies
