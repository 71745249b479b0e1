// SPDX-License-Identifier: BSD-3-Clause
// Has librsvg paint a drawing, and says which cells are solid.
//
// It is loaded when a drawing needs it, in a bounded child process.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>

#include "core/base/result.h"
#include "target/contour/cell_grid.h"
#include "target/geo/polygon_file.h"

namespace ergocast {

/// Finer details are not seen.
/// Limit (Files of a scenario): cells along the longer side of a drawing that is painted. Beyond
/// it: walls are widened to whole cells.
inline constexpr int kPaintedCells = 2048;

/// Cells of one side, row by row from the drawing's lower left corner; the lowest may be cut.
struct PaintedDrawing {
  CellGrid solid;  ///< 1: some of the cell is painted, and darker than kSolidLuminance
  double cell;     ///< the side, in units of the viewBox
  /// Column and row of a line that is too thin to be as dark as it is meant (svg_hairs.h).
  std::optional<std::pair<int, int>> hair = std::nullopt;
};

/// @param svg          well-formed, without entities and addresses outside of it
/// @param size         of its viewBox
/// @param solid_white  whether paint of any colour is solid
Result<PaintedDrawing, PolygonFileProblem> paint_svg(const std::string& svg,
                                                     const Eigen::Vector2d& size, bool solid_white);

}  // namespace ergocast
