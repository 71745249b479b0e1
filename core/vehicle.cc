// SPDX-License-Identifier: BSD-3-Clause
// Points take every velocity up to their limit at once; others change it by A dt a tick.
#include "core/vehicle.h"

#include <cmath>

#include "core/geometry.h"

namespace ergocast {
namespace {

/// What is cut is cut to this share of the limit, so that rounding does not cut it again.
constexpr double kCutShare = 1 - 5e-13;
/// Changes of velocity, and whole ticks of braking, count as what they are but for rounding.
constexpr double kRounding = 1e-9;

/// The greatest change of velocity in a tick [m/s].
double most_change_mps(const Mission& mission) {
  return mission.vehicle.max_acceleration_mps2 * mission.timing.dt_s;
}

Eigen::Vector3d within_limit(const Mission& mission, const Eigen::Vector3d& v_mps) {
  Eigen::Vector3d possible_mps = v_mps;
  if (mission.domain.planar()) possible_mps.z() = 0;
  if (length_of(possible_mps) <= mission.speed_limit_mps) return possible_mps;
  return within_speed(possible_mps, kCutShare * mission.speed_limit_mps);
}

}  // namespace

Eigen::Vector3d executed(const Mission& mission, const Eigen::Vector3d& now_mps,
                         const Eigen::Vector3d& wanted_mps) {
  if (mission.vehicle.kind == VehicleKind::kPoint) return within_speed_limit(mission, wanted_mps);
  const Eigen::Vector3d aim_mps = within_limit(mission, wanted_mps), change = aim_mps - now_mps;
  const double most_mps = most_change_mps(mission);
  if (length_of(change) <= most_mps * (1 + kRounding)) return aim_mps;
  return now_mps + within_speed(change, most_mps);
}

Eigen::Vector3d mean_velocity(const Mission& mission, const Eigen::Vector3d& now_mps,
                              const Eigen::Vector3d& then_mps) {
  if (mission.vehicle.kind == VehicleKind::kPoint) return then_mps;
  return 0.5 * (now_mps + then_mps);
}

Eigen::Vector3d braking_path_m(const Mission& mission, const Eigen::Vector3d& v_mps) {
  if (mission.vehicle.kind == VehicleKind::kPoint) return {0, 0, 0};
  const double ticks = length_of(v_mps) / most_change_mps(mission);
  return 0.5 * mission.timing.dt_s * std::ceil(ticks * (1 - kRounding)) * v_mps;
}

double longest_braking_path_m(const Mission& mission) {
  return length_of(braking_path_m(mission, {mission.speed_limit_mps, 0, 0}));
}

double bulge_m(const Mission& mission) {
  if (mission.vehicle.kind == VehicleKind::kPoint) return 0;
  return mission.vehicle.max_acceleration_mps2 * mission.timing.dt_s * mission.timing.dt_s / 8;
}

}  // namespace ergocast
