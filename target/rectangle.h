// SPDX-License-Identifier: BSD-3-Clause
// Places in a plane: a domain as its target sees it, and the extent of a map.
#pragma once

#include <Eigen/Core>

#include "core/base/geometry.h"

namespace ergocast {

/// Axis-parallel rectangle [origin, origin + size] in metres.
struct Rectangle {
  Eigen::Vector2d origin_m{0, 0};
  Eigen::Vector2d size_m{1, 1};
};

/// A domain seen from above.
inline Rectangle base_of(const Box& domain) {
  return {domain.origin_m.head<2>(), domain.size_m.head<2>()};
}

/// The same place from the domain's lower left corner.
inline Rectangle from_corner(const Rectangle& place, const Box& domain) {
  return {place.origin_m - domain.origin_m.head<2>(), place.size_m};
}

}  // namespace ergocast
