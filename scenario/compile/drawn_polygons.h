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

/// The drawing's viewBox becomes the planar domain. A ring inside an odd number of others of its
/// shape is a hole of the innermost; a hole's holes are polygons again.
/// @returns a problem if the sides of both have ratios that differ by more than 0.1 %
Result<std::vector<PlacedPolygon>, PolygonFileProblem> place_drawing(const Drawing& drawing,
                                                                     const Box& domain);

}  // namespace ergocast
