// SPDX-License-Identifier: BSD-3-Clause
// Subtracts what the holes take of a polygon.
#include "target/polygon.h"

namespace ergocast {

double area_m2(const Polygon& polygon) {
  double area = area_m2(polygon.outline);
  for (const Ring& hole : polygon.holes) area -= area_m2(hole);
  return area;
}

bool contains(const Polygon& polygon, const Eigen::Vector2d& x_m) {
  if (!contains(polygon.outline, x_m)) return false;
  for (const Ring& hole : polygon.holes) {
    if (contains(hole, x_m)) return false;
  }
  return true;
}

}  // namespace ergocast
