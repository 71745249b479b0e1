// SPDX-License-Identifier: BSD-3-Clause
// The target as masses of cells: how likely an object that is drawn from it is in each of them.
//
//   p(x) = Σ_k μ_k f_k(x) / (V mean(f_k²)),   m_i ∝ max(0, p(x_i)),   Σ m_i = 1
//
// x_i is the middle of cell i. The sum over the mission's modes is the target as the team knows it:
// a target with finer details is smoother here. Cells in walls have no mass.
#pragma once

#include <vector>

#include "core/base/rings.h"
#include "core/basis/basis.h"
#include "core/measure/cells.h"

namespace ergocast {

/// One mass a cell; all 0 if p is nowhere above 0.
/// @param target  μ in `basis`, which is (2); mode_count() entries
std::vector<double> target_mass(const Basis& basis, const Rings& walls, const Coefficients& target,
                                const Cells& cells);

}  // namespace ergocast
