// SPDX-License-Identifier: BSD-3-Clause
// Reads the filled shapes of an SVG drawing, such as a floor plan, as rings of corners.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "target/geo/polygon_file.h"

namespace ergocast {

/// One filled element. A point is inside where an odd number of rings is around it.
struct DrawnShape {
  std::string element;                              ///< "line 12: <path>"
  std::vector<std::vector<Eigen::Vector2d>> rings;  ///< corners in order, none twice in a row
};

/// Lengths are in units of the drawing's viewBox, from its lower left corner: x to the right, y up.
struct Drawing {
  Eigen::Vector2d size;  ///< of the viewBox; both above 0
  std::vector<DrawnShape> shapes;
};

/// The shapes of the elements rect, polygon and path, at least one; groups and their transforms
/// count. Text, and elements with fill="none" or display="none", are no shapes. Anything else is a
/// problem: curves, strokes without an area, pictures, copies, numbers that are not finite.
Result<Drawing, PolygonFileProblem> read_svg(const std::filesystem::path& file);
Result<Drawing, PolygonFileProblem> parse_svg(std::string_view text);

}  // namespace ergocast
