// SPDX-License-Identifier: BSD-3-Clause
// Removes small patches of cells from a grid.
#pragma once

#include <cstddef>

#include "target/contour/cell_grid.h"

namespace ergocast {

/// What a cell of a map is. A closed one was free, but no body can be there.
enum : std::uint8_t { kFreeCell = 0, kOccupiedCell = 1, kUnknownCell = 2, kClosedCell = 3 };

/// The number of free cells.
std::size_t count_free(const CellGrid& cells);

/// Makes patches of fewer than `least` unknown cells free. Such a patch has free cells all around
/// it, also at its corners, and the grid's edge nowhere.
void free_unknown_specks(CellGrid& cells, std::size_t least);

/// Closes patches of fewer than `least` free cells. Cells of a patch have sides in common.
void close_pockets(CellGrid& cells, std::size_t least);

}  // namespace ergocast
