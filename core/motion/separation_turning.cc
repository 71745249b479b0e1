// SPDX-License-Identifier: BSD-3-Clause
// Vehicles that turn slowly keep a distance between the points of them that can stop at once.
//
// A unicycle is a point that may stop at any moment. It turns to where a point would go, and moves
// as far as its arc stays within the allowed steps. These contain 0 and are convex, so that every
// step can be shortened until it is allowed.
//
// A fixed wing never stops, but its loiter centre does while it turns as tightly as it can. The
// centre keeps a distance as a point does, and r more, because the vehicle is never farther from
// it.
#include <algorithm>

#include "core/motion/separation.h"
#include "core/motion/vehicle.h"

namespace ergocast {
namespace {

/// The number of steps from the wanted velocity to the tightest turn.
constexpr int kTighterTurns = 8;
/// A blocked unicycle still turns: its velocity keeps this share, which only shows the direction.
constexpr double kLeastShare = 1e-9;
/// A shortened step is shortened by this factor more, so that it is allowed after rounding.
constexpr double kShortenedShare = 1 - 1e-9;

}  // namespace

SafeVelocity SeparationFilter::safe_arc(const Mover& self, const Eigen::Vector3d& wanted_mps,
                                        std::span<const Neighbour> others) {
  SafeVelocity safe = safe_step(self, wanted_mps, others);
  if (safe.blind) return safe;
  const Motion& motion = motion_of(self.id);
  // A command that another filter has allowed is not changed, not even a turn on the spot that a
  // point would not have made.
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

/// How far the loiter centre moves if the vehicle now changes to `v_mps`.
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
