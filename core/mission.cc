// SPDX-License-Identifier: BSD-3-Clause
// Moves a vehicle by one step, and computes when an agent broadcasts and where it starts.
#include "core/mission.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/noise.h"
#include "core/separation.h"
#include "core/station.h"
#include "core/walls.h"

namespace ergocast {

Mission in_cosines(Mission mission) {
  if (!mission.basis.free_domain) return mission;
  mission.basis.free_domain = false;
  mission.basis.table_hash = 0;
  mission.basis.table = nullptr;
  mission.target_coefficients = std::move(mission.cosine_target);
  mission.cosine_target = {};
  return mission;
}

Eigen::Vector3d within_speed(const Eigen::Vector3d& v_mps, double limit_mps) {
  // The division comes first, so that no length overflows.
  const double greatest_mps = v_mps.cwiseAbs().maxCoeff();
  if (greatest_mps == 0) return v_mps;
  const Eigen::Vector3d share = v_mps / greatest_mps;
  const double length = std::hypot(std::hypot(share.x(), share.y()), share.z());
  if (length * greatest_mps <= limit_mps) return v_mps;
  return share / length * limit_mps;
}

Eigen::Vector3d moved(const Mission& mission, AgentId id, Tick tick, const Eigen::Vector3d& x_m,
                      const Eigen::Vector3d& v_mps) {
  const double dt_s = mission.timing.dt_s;
  const Separation& separation = mission.separation;
  Eigen::Vector3d next_m = x_m + v_mps * dt_s;
  if (mission.disturbance_intensity > 0) {
    const Eigen::Vector3d pushed_m =
        mission.disturbance_intensity * std::sqrt(dt_s) *
        normal_in(mission.domain, mission.seed, Purpose::kDisturbance,
                  static_cast<std::uint32_t>(id), static_cast<std::uint64_t>(tick));
    next_m += stopped_by_walls(
        mission, id, next_m,
        separation.distance_m > 0 ? within_speed(pushed_m, separation.disturbance_m) : pushed_m);
  }
  return next_m;
}

Tick next_broadcast(const Mission& mission, AgentId id, Tick tick, int block) {
  const Tick period = mission.timing.broadcast_period_ticks;
  const Tick factor = block == 0 ? 1 : mission.timing.high_mode_period_factor;
  const Tick team = std::max<Tick>(1, static_cast<Tick>(mission.starts_m.size()));
  // High modes are sent together with low ones.
  const Tick turn = id * period / team % period + id * factor / team % factor * period;
  const Tick between = period * factor;
  const Tick next = tick + between - (tick - turn + between) % between;
  if (mission.kinds.empty()) return next;
  const Tick last = rest_from(mission, id) - 1;
  return tick < last ? std::min(next, last) : std::max(tick + 1, mission.timing.tick_count);
}

Eigen::Vector3d start_of(const Mission& mission, AgentId id) {
  const auto at = static_cast<std::size_t>(id);
  return at < mission.starts_m.size() ? mission.starts_m[at]
                                      : start_beside(mission, id, {}, start_distance_m);
}

Eigen::Vector3d random_start(const Box& domain, std::uint64_t seed, AgentId id, int attempt) {
  return uniform_in(domain, seed, Purpose::kStart, static_cast<std::uint32_t>(id),
                    static_cast<std::uint64_t>(attempt));
}

}  // namespace ergocast
