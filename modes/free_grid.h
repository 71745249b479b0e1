// SPDX-License-Identifier: BSD-3-Clause
// The cells of a domain with walls, and which of them see each other.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/result.h"
#include "core/motion/free_region.h"

namespace ergocast {

/// Whether the straight way from one place to another is free. For a place and itself: whether the
/// place is free. Places are from the domain's lower left corner.
using Sees = std::function<bool(const Eigen::Vector2d&, const Eigen::Vector2d&)>;

/// A grid of nearly square cells over a domain; its numbers are those of FreeModes.
struct FreeGrid {
  Eigen::Vector2d origin_m, size_m;
  int columns, rows;
  std::vector<std::int32_t> owner, place, around;
  /// Neighbours that see each other, the lower number first: along x and along y.
  std::vector<std::pair<int, int>> doors_x, doors_y;

  int cell_count() const { return static_cast<int>(place.size()); }
};

/// About 80 × 80 cells, or as many for other shapes of the domain; up to 226 × 226 where narrow
/// ways need them. A cell is free if its middle is free. Two neighbours see each other if their
/// middles do, and no gap is between them that is too narrow for bodies. Free cells that are cut
/// off from the largest part count as walls.
/// @param bodies  where they can be, in a domain with the origin 0; null: points, which pass all
///                gaps. So do bodies in the grid if too much of it were cut off without.
/// @return  or a sentence: nothing is free, or more than a hundredth of it is cut off
Result<FreeGrid> free_grid(const Box& domain, const Sees& sees, const FreeRegion* bodies = nullptr);

}  // namespace ergocast
