// SPDX-License-Identifier: BSD-3-Clause
// The constraints that walls put on a body of any kind of vehicle.
//
// Q is the set that the body keeps under commands of 0, core/motion/separation_pairs.cc, and E an
// edge of a wall. Both are convex. The body keeps the distance K. Let n be the unit vector from Q
// towards E between their nearest points, and g ≥ 0 their distance less K. The body takes a step
// whose next Q' has
//
//   n·z ≤ max over Q of n·y + g  for each z of Q'.
//
// E lies beyond the plane through its nearest point, so Q' is at least K away from it. If a body
// knows its place only up to R, or moves by R while it holds its command, it knows n up to
// asin(R/ρ), as for a neighbour.
#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"
#include "core/mission/kinds.h"
#include "core/motion/filter_rules.h"
#include "core/motion/separation.h"
#include "core/motion/zones.h"

namespace ergocast {

void SeparationFilter::keep_from_walls(const Mover& self, const StraightWay& own) {
  const auto kind = static_cast<std::size_t>(planned_kind(mission_, self.id));
  const double kept_m = kept_from_walls_m_[kind];
  mission_.walls.for_near(own.seen_from_above(), reached_m(self, kept_m), near_,
                          [&](const Segment& edge) { keep_from_wall(self, own, edge, kept_m); });
  if (!zones_.empty()) keep_from_zones(self, own);
}

/// A zone that binds counts as a wall around it, or in a box as a floor below or a ceiling above,
/// if that is farther away.
void SeparationFilter::keep_from_zones(const Mover& self, const StraightWay& own) {
  const auto kind = static_cast<std::size_t>(planned_kind(mission_, self.id));
  for (const Zone& zone : zones_) {
    if (!zone.closed_at(self.tick)) continue;
    const double beside = beside_m(zone, own), above = above_or_below_m(zone, own);
    if (std::max(beside, above) < bound_from_zones_m_[kind]) continue;
    const double kept_m = kept_from_zones_m_[kind];
    if (above >= beside) {
      const double up = own.from_m.z() > zone.low_m ? 1 : -1;
      keep_from_plane(self, own, {0, 0, -up * above}, above * above, kept_m);
      continue;
    }
    for (std::size_t i = 0; i < zone.corners_m.size(); ++i) {
      const std::size_t next = i + 1 < zone.corners_m.size() ? i + 1 : 0;
      keep_from_wall(self, own, {zone.corners_m[i], zone.corners_m[next]}, kept_m);
    }
  }
}

void SeparationFilter::keep_from_wall(const Mover& self, const StraightWay& own,
                                      const Segment& edge, double kept_m) {
  const Eigen::Vector2d y_m = shortest_to_m(own.seen_from_above(), edge);
  keep_from_plane(self, own, on_ground(y_m), y_m.squaredNorm(), kept_m);
}

/// V T + e more if the body follows late. late_edge_margin_m() has 2 e, and one of them is already
/// in the uncertainty.
double SeparationFilter::kept_late_m(const Mover& self, double clearance_m) const {
  const Separation& rule = mission_.separation;
  const double late_m =
      rule.response_s > 0 ? late_edge_margin_m(mission_, self.id) - rule.position_error_m : 0;
  return clearance_m + late_m;
}

double SeparationFilter::unsure_of_place_m(const Mover& self) const {
  const Separation& rule = mission_.separation;
  const double hold_ticks = rule.distance_m > 0 ? hold_ticks_ : 0;
  return rule.position_error_m +
         hold_ticks * (self.max_speed_mps * mission_.timing.dt_s + rule.disturbance_m);
}

/// No step reaches what is farther away than this.
double SeparationFilter::reached_m(const Mover& self, double clearance_m) const {
  return kept_late_m(self, clearance_m) + unsure_of_place_m(self) +
         mission_.separation.disturbance_m + constraints_.reach_m() / gain_;
}

/// Keeps from what lies beyond the plane through the end of `y_m`, which is perpendicular to it. A
/// plane that no step reaches needs no set.
void SeparationFilter::keep_from_plane(const Mover& self, const StraightWay& own,
                                       const Eigen::Vector3d& y_m, double square_m2,
                                       double clearance_m) {
  const Separation& rule = mission_.separation;
  const double kept_m = kept_late_m(self, clearance_m), unsure_m = unsure_of_place_m(self);
  const double far_m = reached_m(self, clearance_m);
  if (square_m2 >= far_m * far_m) return;
  const double rho_m = std::sqrt(square_m2);
  if (rho_m <= unsure_m) {  // it may be on either side
    if (y_m.z() != 0) {
      take(kUnassigned, {{0, 0, 1}, 0, 0, 0});
      take(kUnassigned, {{0, 0, -1}, 0, 0, 0});
      return;
    }
    for (const Eigen::Vector3d& u : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}) {
      take(kUnassigned, {u, 0, 0, 0});
      take(kUnassigned, {-u, 0, 0, 0});
    }
    return;
  }
  const Eigen::Vector3d n = y_m / rho_m;
  const double end_m = std::max(0.0, n.dot(own.along_m));
  const double gap_m = gain_ * (rho_m - unsure_m - kept_m), hard_m = end_m + std::max(0.0, gap_m);
  const double bound_m = rule.disturbance_m > 0 ? end_m + gap_m - rule.disturbance_m : hard_m;
  take(kUnassigned, {n, unsure_m / rho_m, bound_m, hard_m});
}

}  // namespace ergocast
