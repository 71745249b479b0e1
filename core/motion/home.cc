// SPDX-License-Identifier: BSD-3-Clause
// Compares stations with vehicles, walls and each other.
#include "core/motion/home.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/geometry.h"
#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/starts.h"
#include "core/motion/vehicle.h"
#include "core/motion/walls.h"

namespace ergocast {
namespace {

/// As in core/motion/separation.h for what the world may add to a step.
constexpr double kPushDeviations = 6;

bool can_stay(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m) {
  return (x_m.z() == 0 || !mission.domain.planar()) &&
         room_to_begin(motion_of(mission, id)).contains(x_m) &&
         spare_at_home_m(mission, id, x_m) >= 0;
}

}  // namespace

double spare_at_home_m(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m) {
  if (mission.walls.empty()) return std::numeric_limits<double>::max();
  return clearance_m(mission.walls, x_m.head<2>()) -
         kept_from_walls_m(mission, motion_of(mission, id));
}

double home_speed_mps(const Mission& mission, AgentId id) {
  const double u_max_mps = law_of(mission, planned_kind(mission, id)).u_max_mps;
  const double limit_mps = motion_of(mission, id).speed_limit_mps;
  return limit_mps > 0 ? std::min(u_max_mps, limit_mps) : u_max_mps;
}

double home_m(const Mission& mission, AgentId id) {
  const Motion motion = motion_of(mission, id);
  const double dt_s = mission.timing.dt_s;
  return 2 * home_speed_mps(mission, id) * dt_s + 2 * loiter_radius_m(motion) +
         2 * kPushDeviations * mission.disturbance_intensity * std::sqrt(dt_s) +
         2 * mission.separation.position_error_m;
}

bool charges(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m,
             const Eigen::Vector3d& v_mps) {
  if (battery_of(mission, id) == nullptr) return false;
  const Motion motion = motion_of(mission, id);
  if (loiter_radius_m(motion) == 0 && length_of(v_mps) >= home_speed_mps(mission, id) / 2)
    return false;
  return length_of(anchor_m(motion, x_m, v_mps) - *station_of(mission, id)) <=
         home_m(mission, id) - 2 * loiter_radius_m(motion);
}

std::optional<std::pair<AgentId, AgentId>> too_near_at_home(const Mission& mission, AgentId team) {
  if (!keeps_distance(mission)) return std::nullopt;
  for (AgentId one = 0; one < team; ++one) {
    const auto home_m = station_of(mission, one);
    for (AgentId other = 0; home_m && other < one; ++other) {
      const auto their_m = station_of(mission, other);
      if (their_m && (*home_m - *their_m).norm() < start_distance_m(mission, one, other))
        return std::pair(one, other);
    }
  }
  return std::nullopt;
}

bool stations_fit(const Mission& mission) {
  if (!any_station(mission)) return true;
  for (const AgentKind& kind : mission.kinds) {
    const auto count = kind.stations_m.size();
    if (count > 1 && count != static_cast<std::size_t>(kind.count)) return false;
  }
  for (AgentId id = 0; id < std::ssize(mission.starts_m); ++id) {
    const auto home_m = station_of(mission, id);
    if (home_m && (rest_from(mission, id) < 1 || !can_stay(mission, id, *home_m))) return false;
  }
  return !too_near_at_home(mission, static_cast<AgentId>(mission.starts_m.size()));
}

}  // namespace ergocast
