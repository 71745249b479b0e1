// SPDX-License-Identifier: BSD-3-Clause
// Figures of the study of Theorem 1.
#pragma once

#include <filesystem>
#include <vector>

#include "lab/studies/theorems/escape_points.h"

namespace ergocast::studies {

/// theorem_1_*.svg
void draw_theorem1(const std::vector<Row>& rows, const std::filesystem::path& images);

}  // namespace ergocast::studies
