// SPDX-License-Identifier: BSD-3-Clause
// The closed lines along the sides of cells between solid and free.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "target/contour/cell_grid.h"

namespace ergocast {

/// A corner of cells, or a direction along an axis.
struct CellCorner {
  int x = 0, y = 0;

  friend CellCorner operator+(CellCorner a, CellCorner b) { return {a.x + b.x, a.y + b.y}; }
  friend bool operator==(CellCorner a, CellCorner b) = default;
};

/// One step of such a line: from `from` by one cell along `along`, with solid on the left and free
/// on the right.
struct CellSide {
  CellCorner from, along;
  /// Whether the line turns right at `from` between two solid cells that have only this corner in
  /// common.
  bool pinched = false;
};

struct CellRing {
  std::vector<CellSide> sides;  ///< in order; the line turns at the first
  int hole_of = -1;             ///< the ring around the solid cells; −1: it is one itself
};

/// All such lines. Nothing if they have more than `most_sides` in all.
std::optional<std::vector<CellRing>> rings_of_cells(const CellGrid& cells, std::size_t most_sides);

}  // namespace ergocast
