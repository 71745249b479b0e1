// SPDX-License-Identifier: BSD-3-Clause
// What the figures of the study of Theorem 1 are drawn from.
#pragma once

#include <filesystem>
#include <vector>

#include "studies/theorems/escape_points.h"

namespace ergocast::studies {

/// theorem_1_*.csv
void write_theorem1_curves(const std::vector<Row>& rows, const std::filesystem::path& curves);

}  // namespace ergocast::studies
