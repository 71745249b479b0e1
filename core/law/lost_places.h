// SPDX-License-Identifier: BSD-3-Clause
// Where a vehicle was at ticks whose positions were lost: on the line between the places around.
//
//   x(t) = x_a + (t − a) / (b − a) · (x_b − x_a),   a < t < b,   b − a − 1 ≤ kMostLostPlaces
//
// A network that loses positions would otherwise take away as many samples: of the own row, whose
// vehicle went on meanwhile, and of teammates' rows in a forecast.
#pragma once

#include "core/base/geometry.h"
#include "core/base/ids.h"

namespace ergocast {

/// Limit (Team): lost positions of a vehicle, one after the other, that an agent puts onto the line
/// between the places around them [ticks]. Beyond it: nothing counts as covered meanwhile.
inline constexpr Tick kMostLostPlaces = 8;

struct PlaceAtTick {
  Tick tick = -1;
  Eigen::Vector3d x_m{0, 0, 0};
};

/// Calls `visit` with each place that is lost between two known ones, in the order of their ticks;
/// with none if they are too many.
template <class Visit>
void for_each_lost_place(const PlaceAtTick& before, const PlaceAtTick& after, Visit visit) {
  const Tick gap = after.tick - before.tick;
  if (gap > kMostLostPlaces + 1) return;
  for (Tick tick = before.tick + 1; tick < after.tick; ++tick) {
    const double share = static_cast<double>(tick - before.tick) / static_cast<double>(gap);
    visit(PlaceAtTick{tick, before.x_m + share * (after.x_m - before.x_m)});
  }
}

}  // namespace ergocast
