// SPDX-License-Identifier: BSD-3-Clause
// Polygons with holes, as plain values.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace ergocast {

/// The corners in order [m]; the last is joined to the first.
using Ring = std::vector<Eigen::Vector2d>;

/// The area inside the outline and outside all holes.
struct Polygon {
  Ring outline;
  std::vector<Ring> holes;
};

/// Area of a ring that does not cross itself [m²], positive in either orientation.
double area_m2(const Ring& ring);

/// Area without that of the holes [m²].
/// @pre the holes lie inside the outline and apart from each other
double area_m2(const Polygon& polygon);

/// Whether `x_m` is inside. On the edge the result may be either.
bool contains(const Ring& ring, const Eigen::Vector2d& x_m);
bool contains(const Polygon& polygon, const Eigen::Vector2d& x_m);

}  // namespace ergocast
