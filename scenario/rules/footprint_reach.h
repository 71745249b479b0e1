// SPDX-License-Identifier: BSD-3-Clause
// Computes how near to the target a team with footprints can come.
#pragma once

#include "core/mission/mission.h"

namespace ergocast {

/// Bounds of the least φ² of what the team sees, min Σ λ_k (Σ_j a_j g_jk p̂_jk − μ_k)², over one
/// density p_j ≥ 0 for each kind. a_j is the kind's share of time and quality.
struct FootprintReach {
  double low, high;
  double even;  ///< φ² of a coverage that is the same everywhere
};

/// Densities are masses in the middles of cells, two along each axis for each mode; a plane has one
/// along z. `low` is certain for all of these, `high` is reached by one of them. A bounded number
/// of steps: at most a second or so for the largest basis. Stops early once `high` ≤ `enough`.
/// @pre the mission has kinds
FootprintReach footprint_reach(const Mission& mission, double enough);

}  // namespace ergocast
