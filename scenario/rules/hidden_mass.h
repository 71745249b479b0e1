// SPDX-License-Identifier: BSD-3-Clause
// How much of a target lies behind walls, as seen from the rest of it.
#pragma once

#include "core/mission/mission.h"
#include "target/density_picture.h"

namespace ergocast {

/// A way of more than this many times the straight line leads around walls.
inline constexpr double kDetour = 1.25;

/// The share of pairs of places, drawn from the target, between which the shortest way that keeps
/// the clearance is a detour. A law whose modes do not depend on walls pulls along the straight
/// line, and slides along walls where that helps. A detour leads away from that line.
/// @param density  of the target
double hidden_share(const Mission& mission, const DensityGrid& density);

}  // namespace ergocast
