// SPDX-License-Identifier: BSD-3-Clause
// Moves every ring, and subtracts what the holes take of a polygon.
#include "target/polygon.h"

namespace ergocast {
namespace {

Ring from_corner(Ring ring, const Eigen::Vector2d& corner_m) {
  for (Eigen::Vector2d& x_m : ring) x_m -= corner_m;
  return ring;
}

}  // namespace

Polygon from_corner(const Polygon& polygon, const Eigen::Vector2d& corner_m) {
  Polygon moved{from_corner(polygon.outline, corner_m), {}};
  for (const Ring& hole : polygon.holes) moved.holes.push_back(from_corner(hole, corner_m));
  return moved;
}

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
