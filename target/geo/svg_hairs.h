// SPDX-License-Identifier: BSD-3-Clause
// Finds lines of a painting that are thinner than a cell, so that they are brighter than their
// colour.
//
// Such a line is what the opening of the darkness by 3 × 3 cells removes: no square of that size
// around it is as dark. The points of areas that are as dark themselves are none, for they end
// within a few cells.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "target/contour/cell_grid.h"

namespace ergocast {

/// The darkness of a cell that is solid. Others have 0, as white paper, up to kMostFaint.
inline constexpr std::uint8_t kSolidDarkness = 255, kMostFaint = 250;

/// Column and row of the first cell, row by row, that is part of such a line.
std::optional<std::pair<int, int>> first_hair(const CellGrid& darkness);

}  // namespace ergocast
