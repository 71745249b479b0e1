// SPDX-License-Identifier: BSD-3-Clause
// Computes areas by the shoelace formula and membership by counting crossings.
#include "target/polygon.h"

#include <cmath>

namespace ergocast {

double area_m2(const Ring& ring) {
  double twice = 0;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i - 1] - ring[0], b = ring[i] - ring[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

double area_m2(const Polygon& polygon) {
  double area = area_m2(polygon.outline);
  for (const Ring& hole : polygon.holes) area -= area_m2(hole);
  return area;
}

bool contains(const Ring& ring, const Eigen::Vector2d& x_m) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y() > x_m.y()) == (b.y() > x_m.y())) continue;
    const double share = (x_m.y() - a.y()) / (b.y() - a.y());
    if (x_m.x() < a.x() + share * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

bool contains(const Polygon& polygon, const Eigen::Vector2d& x_m) {
  if (!contains(polygon.outline, x_m)) return false;
  for (const Ring& hole : polygon.holes) {
    if (contains(hole, x_m)) return false;
  }
  return true;
}

}  // namespace ergocast
