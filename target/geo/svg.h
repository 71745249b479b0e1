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

/// One filled element.
struct DrawnShape {
  std::string element;                              ///< "line 12: <path>"
  std::vector<std::vector<Eigen::Vector2d>> rings;  ///< corners in order, none twice in a row
  /// Whether a point is inside where an odd number of rings is around it (fill-rule evenodd); else
  /// where the rings around it do not go round it as often one way as the other (nonzero).
  bool even_odd = false;
};

/// Lengths are in units of the drawing's viewBox, from its lower left corner: x to the right, y up.
struct Drawing {
  Eigen::Vector2d size;  ///< of the viewBox; both above 0
  /// The filled shapes, exact, if the drawing has nothing but dark rects, polygons and straight
  /// paths: at least one.
  std::vector<DrawnShape> shapes;
  /// Why the shapes are not all of it, "line 12: <circle> is no straight shape"; then it has to be
  /// painted. Empty: they are.
  std::string paint_because;
  std::string to_paint;  ///< the same drawing for paint_svg()
};

/// Reads a drawing, and refuses what could be lost in painting it: text, pictures, scripts, unknown
/// elements and properties, broken data, references to what is not there. Elements of other
/// languages, such as Inkscape's own, show nothing.
/// @param solid_white  whether shapes of any colour are solid, not only those that are darker than
///                     kSolidLuminance
Result<Drawing, PolygonFileProblem> read_svg(const std::filesystem::path& file,
                                             bool solid_white = false);
Result<Drawing, PolygonFileProblem> parse_svg(std::string_view text, bool solid_white = false);

}  // namespace ergocast
