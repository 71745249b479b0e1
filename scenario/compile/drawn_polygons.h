// SPDX-License-Identifier: BSD-3-Clause
// Places the shapes of a drawing in the domain, as polygons with holes.
#pragma once

#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/result.h"
#include "target/geo/svg.h"
#include "target/polygon.h"

namespace ergocast {

struct PlacedPolygon {
  std::string member;  ///< the element of the file
  Polygon polygon;     ///< [m]
};

struct DrawnAs {
  bool solid_white = false;
  bool joined = true;  ///< whether shapes that touch or overlap become one
};

/// The drawing's viewBox becomes the planar domain. Exact shapes stay exact, with holes by their
/// fill-rule; a drawing with others, or whose shapes cross themselves, or each other if they are to
/// be joined, is painted. Then the polygons go around its solid cells, as those of maps do.
/// @returns a problem if the sides of both have ratios that differ by more than 0.1 %, or nothing
///          or more than 90 % of a painted drawing is solid
Result<std::vector<PlacedPolygon>, PolygonFileProblem> place_drawing(const Drawing& drawing,
                                                                     const Box& domain,
                                                                     const DrawnAs& as);

}  // namespace ergocast
