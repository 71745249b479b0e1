// SPDX-License-Identifier: BSD-3-Clause
// Keep-outs, and the heights between which the same of them stand.
#pragma once

#include <span>
#include <vector>

#include "target/heights.h"
#include "target/polygon.h"
#include "target/trapezoids.h"

namespace ergocast {

/// A prism in which the density is zero.
struct KeepOut {
  Polygon polygon;
  Heights heights{};
};

/// A part of the domain's height. A plane is one storey. Lengths are from the domain's lowest
/// corner.
struct Storey {
  Heights heights;
  std::vector<Polygon> keep_outs;  ///< those that stand in it

  /// The domain without them.
  std::vector<Trapezoid> free(const Eigen::Vector2d& base_m) const {
    return free_area(base_m, keep_outs);
  }
};

/// The storeys of a domain of this height, ascending: the keep-outs' heights separate them. A
/// height of 0 is a plane.
std::vector<Storey> storeys_of(double height_m, std::span<const KeepOut> keep_outs);

}  // namespace ergocast
