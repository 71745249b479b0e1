// SPDX-License-Identifier: BSD-3-Clause
// Draws a ring with few corners along a line of cells.
#pragma once

#include "core/base/rings.h"
#include "target/contour/cell_rings.h"
#include "target/contour/contour.h"

namespace ergocast {

/// A ring in the band around the line that `straightening` allows, in units of a cell. It goes
/// round the same way, with solid on its left. The bands of two lines of the same cells have no
/// point in common, so neither have their rings.
Ring straight_ring(const CellRing& line, const CellGrid& cells, Straightening straightening);

}  // namespace ergocast
