// SPDX-License-Identifier: BSD-3-Clause
// Which law finds more, told by numbers of the mission: docs/laws.md has what teams found.
#pragma once

#include "core/mission/mission.h"
#include "target/density_picture.h"

namespace ergocast {

/// The part of the domain over which a target is spread: exp(−∑ p ln p) cells of all cells, where p
/// is a cell's share of the mass. 1: it is uniform.
double spread_share(const DensityGrid& density);

/// How often the team can pass over that part of the domain in lanes as wide as its sensors see:
/// N u_max T 2r / (share · area).
double passes(const Mission& mission, double spread_share);

/// What a mission with LawKind::kSearch or kMow in a plane is better off with; else its own law.
LawKind advised_law(const Mission& mission, const DensityGrid& density);

}  // namespace ergocast
