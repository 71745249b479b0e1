// SPDX-License-Identifier: BSD-3-Clause
// What a body owes the walls, of whatever kind of vehicle.
//
// Q is what stays of the body under commands of 0, core/separation_pairs.cc, and E an edge of a
// wall. Both are convex. Let n be the unit vector from Q towards E between their nearest points,
// and g ≥ 0 what their distance has more than K, which the body keeps. It takes a step whose next
// Q' has
//
//   n·z ≤ max over Q of n·y + g  for each z of Q'.
//
// E lies beyond the plane through its nearest point, so Q' is K from it. A body that knows its
// place but for R, or holds its command while it moves by R, knows n but for asin(R/ρ), as of a
// neighbour.
#include <algorithm>
#include <cmath>

#include "core/geometry.h"
#include "core/kinds.h"
#include "core/separation.h"

namespace ergocast {
namespace {

/// The two points of a way [from, from + along] and an edge that are nearest to each other, if the
/// two do not cross, as a vector from the first to the second.
Eigen::Vector2d shortest_to_m(const Segment& way, const Segment& edge) {
  const Eigen::Vector2d candidates[] = {
      edge.nearest_m(way.from_m) - way.from_m, edge.nearest_m(way.to_m) - way.to_m,
      edge.from_m - way.nearest_m(edge.from_m), edge.to_m - way.nearest_m(edge.to_m)};
  return *std::ranges::min_element(candidates, {},
                                   [](const Eigen::Vector2d& one) { return one.squaredNorm(); });
}

}  // namespace

void SeparationFilter::keep_from_walls(const Mover& self, const HoldingSet& own) {
  for_segments(mission_.walls, [&](const Segment& edge) { keep_from_wall(self, own, edge); });
}

/// The edges that no step reaches need no set.
void SeparationFilter::keep_from_wall(const Mover& self, const HoldingSet& own,
                                      const Segment& edge) {
  const Separation& rule = mission_.separation;
  const auto kind = static_cast<std::size_t>(planned_kind(mission_, self.id));
  // V T and e more, if it follows late; of 2 e, one is in what is not known.
  const double late_m =
      rule.response_s > 0 ? late_edge_margin_m(mission_, self.id) - rule.position_error_m : 0;
  const double kept_m = kept_from_walls_m_[kind] + late_m;
  const double hold_ticks = rule.distance_m > 0 ? hold_ticks_ : 0;
  const double unsure_m =
      rule.position_error_m +
      hold_ticks * (self.max_speed_mps * mission_.timing.dt_s + rule.disturbance_m);
  const Segment way{own.from_m.head<2>(), (own.from_m + own.along_m).head<2>()};
  const Eigen::Vector2d y_m = shortest_to_m(way, edge);
  const double far_m = kept_m + unsure_m + rule.disturbance_m + constraints_.reach_m() / gain_;
  if (y_m.squaredNorm() >= far_m * far_m) return;
  const double rho_m = std::sqrt(y_m.squaredNorm());
  if (rho_m <= unsure_m) {  // it may be on either side
    for (const Eigen::Vector3d& u : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}) {
      take(kUnassigned, {u, 0, 0, 0});
      take(kUnassigned, {-u, 0, 0, 0});
    }
    return;
  }
  const Eigen::Vector3d n = on_ground(y_m) / rho_m;
  const double end_m = std::max(0.0, n.dot(own.along_m));
  const double gap_m = gain_ * (rho_m - unsure_m - kept_m), hard_m = end_m + std::max(0.0, gap_m);
  const double bound_m = rule.disturbance_m > 0 ? end_m + gap_m - rule.disturbance_m : hard_m;
  take(kUnassigned, {n, unsure_m / rho_m, bound_m, hard_m});
}

}  // namespace ergocast
