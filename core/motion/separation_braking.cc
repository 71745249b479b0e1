// SPDX-License-Identifier: BSD-3-Clause
// Vehicles with inertia keep their distance by their braking paths: both ends of the next path are
// among the allowed steps. Braking is always allowed, because it leads along the present path.
#include <array>

#include "core/base/geometry.h"
#include "core/motion/separation.h"
#include "core/motion/vehicle.h"

namespace ergocast {
namespace {

/// A turn in the plane x, y: cosine and sine of its angle.
struct Turn {
  double cosine, sine;
};
constexpr double kRootThreeHalves = 0.86602540378443865;
/// Alternatives, each at full and at half speed: 0°, 30° … 180° off the wanted velocity.
constexpr std::array<Turn, 7> kTurns = {{{1, 0},
                                         {kRootThreeHalves, 0.5},
                                         {0.5, kRootThreeHalves},
                                         {0, 1},
                                         {-0.5, kRootThreeHalves},
                                         {-kRootThreeHalves, 0.5},
                                         {-1, 0}}};

Eigen::Vector3d turned(const Eigen::Vector3d& v, const Turn& turn, double hand) {
  const double sine = hand * turn.sine;
  return {turn.cosine * v.x() - sine * v.y(), sine * v.x() + turn.cosine * v.y(), v.z()};
}

}  // namespace

/// Whether both ends of the next braking path are allowed if the vehicle now changes to `v_mps`.
bool SeparationFilter::allows(const Mover& self, const Eigen::Vector3d& v_mps) const {
  const Motion& motion = motion_of(self.id);
  const Eigen::Vector3d step_m = mean_velocity(motion, self.velocity_mps, v_mps) * motion.dt_s;
  return constraints_.allow(step_m) && constraints_.allow(step_m + braking_path_m(motion, v_mps));
}

SafeVelocity SeparationFilter::safe_change(const Mover& self, const Eigen::Vector3d& wanted_mps,
                                           std::span<const Neighbour> others) {
  const Motion& motion = motion_of(self.id);
  begin(self, reach_m(motion, self.max_speed_mps));
  if (const Neighbour* blind = keep_from_all(self, others)) return stopped(self, *blind);
  const Eigen::Vector3d direct_mps = executed(motion, self.velocity_mps, wanted_mps);
  if (allows(self, direct_mps)) return {direct_mps};

  SafeVelocity safe =
      blocked_by(mean_velocity(motion, self.velocity_mps, direct_mps) * motion.dt_s +
                 braking_path_m(motion, direct_mps));
  const Eigen::Vector3d aim_mps = within_speed_limit(motion, wanted_mps);
  for (const double share : {1.0, 0.5}) {
    for (const Turn& turn : kTurns) {
      for (const double hand : {side(self), -side(self)}) {
        safe.velocity_mps =
            executed(motion, self.velocity_mps, share * turned(aim_mps, turn, hand));
        safe.blocked = !allows(self, safe.velocity_mps);
        if (!safe.blocked) return safe;
      }
    }
  }
  safe.velocity_mps = executed(motion, self.velocity_mps, {0, 0, 0});
  return safe;
}

}  // namespace ergocast
