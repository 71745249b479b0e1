// SPDX-License-Identifier: BSD-3-Clause
// Polygons around the solid cells of a grid, with few corners.
//
// Solid cells that have only a corner in common are joined there, so thin diagonal walls stay
// closed. Free cells with only a corner in common are apart.
#pragma once

#include <optional>
#include <vector>

#include "target/contour/cell_grid.h"
#include "target/polygon.h"

namespace ergocast {

/// Where straight edges may replace the stairs of cells.
enum class Straightening {
  kOutwards,  ///< by at most half a cell into free cells; every solid cell is solid as a whole
  kBothWays,  ///< by 7/16 of a cell to either side; the centre of every solid cell is solid
};

/// The most sides of cells between solid and free. A map with more is noise.
/// Limit (Files of a scenario): sides of cells between free and other space in an occupancy map.
/// Beyond it: the scenario is refused.
inline constexpr std::size_t kMaxCellSides = std::size_t{1} << 22;

/// The solid cells, which are those above 0, as polygons in units of a cell from the grid's
/// south-western corner. All around the grid is free. No rings touch, and no centre of a free cell
/// is inside: no wall is opened and no passage is closed. Nothing if there are more than
/// kMaxCellSides.
std::optional<std::vector<Polygon>> polygons_around(const CellGrid& cells,
                                                    Straightening straightening);

}  // namespace ergocast
