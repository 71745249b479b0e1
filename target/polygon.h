// SPDX-License-Identifier: BSD-3-Clause
// Polygons with holes, as plain values.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/rings.h"

namespace ergocast {

/// The area inside the outline and outside all holes.
struct Polygon {
  Ring outline;
  std::vector<Ring> holes;
};

/// The same place from `corner_m`.
Polygon from_corner(const Polygon& polygon, const Eigen::Vector2d& corner_m);

/// Area without that of the holes [m²].
/// @pre the holes lie inside the outline and apart from each other
double area_m2(const Polygon& polygon);

/// Its outline, and then its holes.
inline Rings rings_of(const Polygon& polygon) {
  Rings rings = {polygon.outline};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  return rings;
}

/// Whether `x_m` is inside. On the edge the result may be either.
bool contains(const Polygon& polygon, const Eigen::Vector2d& x_m);

}  // namespace ergocast
