// SPDX-License-Identifier: BSD-3-Clause
// Vehicles that turn slowly keep their distance by what stays in its place at once.
//
// A unicycle is a point that may stand at any moment. It turns to where a point would go, and goes
// there as far as its arc leads through the allowed steps. These contain 0 and are convex, so that
// every step can be shortened until it is allowed.
//
// A fixed wing never stands, but its loiter centre does if it turns as tightly as it can. The
// centre keeps its distance like a point, and r more, since the vehicle is never farther from it.
#include <algorithm>

#include "core/separation.h"
#include "core/vehicle.h"

namespace ergocast {
namespace {

/// So many steps lead from the wanted velocity to the tightest turn.
constexpr int kTighterTurns = 8;
/// A unicycle whose way is blocked still turns: as the direction of its velocity, however small.
constexpr double kLeastShare = 1e-9;
/// What is shortened is shortened by so much more that rounding leaves it allowed.
constexpr double kShortenedShare = 1 - 1e-9;

}  // namespace

SafeVelocity SeparationFilter::safe_arc(const Mover& self, const Eigen::Vector3d& wanted_mps,
                                        std::span<const Neighbour> others) {
  SafeVelocity safe = safe_step(self, wanted_mps, others);
  if (safe.blind) return safe;
  const Motion& motion = motion_of(self.id);
  // What another filter has allowed stays as it is, also a turn on the spot that a point would not
  // have made.
  const bool filtered =
      executed(motion, self.velocity_mps, wanted_mps) == wanted_mps &&
      constraints_.allow(mean_velocity(motion, self.velocity_mps, wanted_mps) * motion.dt_s);
  if (filtered) return {wanted_mps};
  const Eigen::Vector3d turned_mps = executed(motion, self.velocity_mps, safe.velocity_mps);
  const Eigen::Vector3d step_m = mean_velocity(motion, self.velocity_mps, turned_mps) * motion.dt_s;
  const double share = std::max(kLeastShare, constraints_.allowed_share(step_m));
  safe.velocity_mps =
      share < 1 ? executed(motion, self.velocity_mps, kShortenedShare * share * turned_mps)
                : turned_mps;
  return safe;
}

/// How far the loiter centre moves, if the vehicle now goes over to `v_mps`.
Eigen::Vector3d SeparationFilter::center_step_m(const Mover& self,
                                                const Eigen::Vector3d& v_mps) const {
  const Motion& motion = motion_of(self.id);
  const Eigen::Vector3d step_m = mean_velocity(motion, self.velocity_mps, v_mps) * motion.dt_s;
  return anchor_m(motion, step_m, v_mps) - anchor_m(motion, {0, 0, 0}, self.velocity_mps);
}

SafeVelocity SeparationFilter::safe_circle(const Mover& self, const Eigen::Vector3d& wanted_mps,
                                           std::span<const Neighbour> others) {
  const Motion& motion = motion_of(self.id);
  Mover center = self;
  center.position_m = anchor_m(motion, self.position_m, self.velocity_mps);
  begin(center, reach_m(motion, self.max_speed_mps));
  if (const Neighbour* blind = keep_from_all(self, others)) return stopped(self, *blind);
  const Eigen::Vector3d direct_mps = executed(motion, self.velocity_mps, wanted_mps);
  const Eigen::Vector3d direct_m = center_step_m(self, direct_mps);
  if (constraints_.allow(direct_m)) return {direct_mps};

  SafeVelocity safe = blocked_by(direct_m);
  const Eigen::Vector3d tightest_mps = executed(motion, self.velocity_mps, {0, 0, 0});
  for (int i = 1; i < kTighterTurns; ++i) {
    const double share = static_cast<double>(i) / kTighterTurns;
    safe.velocity_mps =
        executed(motion, self.velocity_mps, direct_mps + share * (tightest_mps - direct_mps));
    safe.blocked = !constraints_.allow(center_step_m(self, safe.velocity_mps));
    if (!safe.blocked) return safe;
  }
  safe.velocity_mps = tightest_mps;
  return safe;
}

}  // namespace ergocast
