// SPDX-License-Identifier: BSD-3-Clause
// How far mass has to move: the sliced Wasserstein distance of two distributions over cells.
//
//   W² = mean over directions θ of ∫₀¹ (F⁻¹(q) − G⁻¹(q))² dq
//
// F and G are the distributions of θ·x. If one is the other moved by d, it is |d| / √2 in a plane
// and |d| / √3 in a box. The masses of a cell are in its middle.
#pragma once

#include <vector>

#include "core/measure/cells.h"

namespace ergocast {

/// W [m]; nan if the sum of either is not above 0.
/// @param one, other  a mass for each cell, not below 0; of any sum
double sliced_wasserstein_m(const Cells& cells, const std::vector<double>& one,
                            const std::vector<double>& other);

}  // namespace ergocast
