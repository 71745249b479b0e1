// SPDX-License-Identifier: BSD-3-Clause
// Finds the reason why a polygon is invalid.
#pragma once

#include <optional>
#include <string>

#include "target/polygon.h"

namespace ergocast {

struct PolygonFlaw {
  int hole = -1;  ///< the invalid hole, or −1 for the outline
  std::string what, remedy;
  int corner = -1;  ///< of that ring, the one to mend; −1: none alone
};

/// The first error of `polygon`: fewer than three vertices, a vertex twice in a row, all vertices
/// on a line, an area below `min_area_m2`, edges that touch or cross, holes that are outside or in
/// one another.
std::optional<PolygonFlaw> flaw_of(const Polygon& polygon, double min_area_m2);

}  // namespace ergocast
