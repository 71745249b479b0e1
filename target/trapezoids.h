// SPDX-License-Identifier: BSD-3-Clause
// The part of the domain that is inside one polygon and outside others, cut into trapezoids.
//
// All lengths are from the domain's lower left corner: the domain is [0, size].
//
// Horizontals through every corner and every crossing of edges cut the domain into slabs in which
// no two edges cross. There the edges have one order from left to right. A sweep in this order
// counts which polygons it is inside of, and so finds every piece: unions, differences and holes
// alike. A rounding error of a corner moves a piece's side by the same distance and breaks nothing.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "target/polygon.h"

namespace ergocast {

/// An area between two horizontals and two straight sides [m].
struct Trapezoid {
  double low, high;              ///< y of the horizontals
  double left_low, left_high;    ///< x of the left side at low and at high
  double right_low, right_high;  ///< x of the right side

  /// The part between y = `from` and y = `to`, both within [low, high].
  Trapezoid between(double from, double to) const;
  /// Counter-clockwise from the lower left.
  std::array<Eigen::Vector2d, 4> corners() const;
};

/// The domain without `keep_outs`, which may overlap, as disjoint trapezoids; ascending by `low`.
std::vector<Trapezoid> free_area(const Eigen::Vector2d& size_m, std::span<const Polygon> keep_outs);

/// The part of the free area inside `region`.
std::vector<Trapezoid> free_area_within(const Polygon& region, const Eigen::Vector2d& size_m,
                                        std::span<const Polygon> keep_outs);

}  // namespace ergocast
