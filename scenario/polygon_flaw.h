// SPDX-License-Identifier: BSD-3-Clause
// What makes a polygon none.
#pragma once

#include <optional>
#include <string>

#include "target/polygon.h"

namespace ergocast {

struct PolygonFlaw {
  int hole = -1;  ///< which hole is to blame, or −1 for the outline
  std::string what, remedy;
};

/// The first thing that is wrong with `polygon`: fewer than three vertices, one twice in a row, an
/// area below `min_area_m2`, edges that touch or cross, holes that are outside or in one another.
std::optional<PolygonFlaw> flaw_of(const Polygon& polygon, double min_area_m2);

}  // namespace ergocast
