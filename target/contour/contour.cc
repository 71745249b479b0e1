// SPDX-License-Identifier: BSD-3-Clause
// Follows the sides of the cells, then straightens each line by itself.
#include "target/contour/contour.h"

#include <utility>

#include "target/contour/cell_rings.h"
#include "target/contour/straight_ring.h"

namespace ergocast {

std::optional<std::vector<Polygon>> polygons_around(const CellGrid& cells,
                                                    Straightening straightening) {
  const auto lines = rings_of_cells(cells, kMaxCellSides);
  if (!lines) return std::nullopt;
  std::vector<Polygon> polygons;
  std::vector<std::size_t> polygon_of(lines->size());
  for (std::size_t i = 0; i < lines->size(); ++i) {
    if ((*lines)[i].hole_of >= 0) continue;
    polygon_of[i] = polygons.size();
    polygons.push_back({straight_ring((*lines)[i], cells, straightening), {}});
  }
  for (const CellRing& line : *lines) {
    if (line.hole_of < 0) continue;
    Polygon& around = polygons[polygon_of[static_cast<std::size_t>(line.hole_of)]];
    around.holes.push_back(straight_ring(line, cells, straightening));
  }
  return polygons;
}

}  // namespace ergocast
