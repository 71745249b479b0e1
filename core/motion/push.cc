// SPDX-License-Identifier: BSD-3-Clause
// Draws the disturbance of a step from the mission's seed.
#include "core/motion/push.h"

#include <cmath>

#include "core/base/geometry.h"
#include "core/base/noise.h"
#include "core/motion/filter_rules.h"
#include "core/motion/vehicle.h"
#include "core/motion/walls.h"
#include "core/motion/zones.h"

namespace ergocast {

Eigen::Vector3d moved(const Mission& mission, AgentId id, Tick tick, const Eigen::Vector3d& x_m,
                      const Eigen::Vector3d& v_mps, const AmongZones& among) {
  const double dt_s = mission.timing.dt_s;
  const Separation& separation = mission.separation;
  Eigen::Vector3d next_m = x_m + v_mps * dt_s;
  if (mission.disturbance_intensity > 0) {
    const Eigen::Vector3d pushed_m =
        mission.disturbance_intensity * std::sqrt(dt_s) *
        normal_in(mission.domain, mission.seed, Purpose::kDisturbance,
                  static_cast<std::uint32_t>(id), static_cast<std::uint64_t>(tick));
    const Eigen::Vector3d push_m = stopped_by_walls(
        mission, id, next_m,
        keeps_distance(mission) ? within_speed(pushed_m, separation.disturbance_m) : pushed_m);
    if (among.zones.empty()) return next_m + push_m;
    const Motion motion = motion_of(mission, id);
    next_m += stopped_by_zones(among.zones, tick + 1, mission, motion,
                               holding_way(motion, next_m, among.end_mps), push_m);
  }
  return next_m;
}

}  // namespace ergocast
