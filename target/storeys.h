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

/// A part of the domain's height. A plane is one storey.
struct Storey {
  Heights heights;
  std::vector<Polygon> keep_outs;  ///< those that stand in it

  /// The domain without them.
  std::vector<Trapezoid> free(const Rectangle& base) const { return free_area(base, keep_outs); }
};

/// The storeys of `domain`, ascending: one more than its keep-outs' heights cut it in.
std::vector<Storey> storeys_of(const Box& domain, std::span<const KeepOut> keep_outs);

}  // namespace ergocast
