// SPDX-License-Identifier: BSD-3-Clause
// ∫ cos(mπx/Lx) cos(nπy/Ly) in closed form: over intervals, and over polygons by Green's theorem.
//
// Differences of sines lose digits over short lengths, so they are computed as products with
// sinc(z) = sin(z)/z. Lengths are measured from the domain's lower left corner [m].
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/basis/basis.h"

namespace ergocast {

/// ∫ cos(mπx/length) dx from `low` to `high`, m = 0 … modes − 1 [m].
Eigen::VectorXd cosine_integrals(double low, double high, double length, int modes);

/// sums(m,n) += density · ∫∫ f_mn over the polygon with these corners.
///
/// With a = mπ/Lx, b = nπ/Ly it is ∮ sin(ax)/a cos(by) dy for m > 0 and −∮ sin(by)/b dx for m = 0,
/// and along a straight edge both are sums of sin · sinc.
///
/// @param corners  counter-clockwise; at least three, of a polygon that does not cross itself
/// @param size_m   of the domain
/// @return         the maximum rounding error of any sum, in the unit of `sums`
double add_polygon(std::span<const Eigen::Vector2d> corners, double density,
                   const Eigen::Vector2d& size_m, PlaneCoefficients& sums);

}  // namespace ergocast
