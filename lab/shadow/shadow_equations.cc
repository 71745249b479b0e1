// SPDX-License-Identifier: BSD-3-Clause
// Evaluates each equation as it is written, without recurrences.
#include "lab/shadow/shadow_equations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace ergocast::lab {
namespace {

/// A teammate that has been silent for this many announced periods has no forecast any more.
constexpr Tick kPeriodsUntilDead = 8;

/// f(x) dt of every mode, straight from (2), or from the table.
Coefficients gain_at(const Mission& mission, const Eigen::Vector3d& x_m) {
  if (mission.basis.free_domain)
    return mission.timing.dt_s * basis_values(x_m, mission.domain, mission.basis);
  const auto cosines = [&](int axis, int modes) {
    const double inside_m = x_m[axis] - mission.domain.origin_m[axis];
    const double angle = std::numbers::pi * inside_m / mission.domain.size_m[axis];
    Eigen::VectorXd values = Eigen::VectorXd::Ones(modes);
    for (int m = 1; m < modes; ++m) values[m] = std::cos(m * angle);
    return values;
  };
  const Eigen::VectorXd along_x = cosines(0, mission.basis.modes_x);
  const Eigen::VectorXd along_y = cosines(1, mission.basis.modes_y);
  const Eigen::VectorXd along_z = cosines(2, mission.basis.modes_z);
  Coefficients gain(mission.basis.mode_count());
  Eigen::Index k = 0;
  for (const double z : along_z) {
    for (const double x : along_x) {
      for (const double y : along_y) gain[k++] = mission.timing.dt_s * x * y * z;
    }
  }
  return gain;
}

}  // namespace

double horizon_s(const Mission& mission, const Eigen::Matrix3d& covariance_m2, int n, Tick tick,
                 Tick tick_count) {
  const double variance_m2 = std::max(0.0, covariance_m2.trace());
  double dimensions = 2;
  if (variance_m2 > 0) {
    const Eigen::Matrix3d shares = covariance_m2 / variance_m2;
    dimensions = std::min(2.0, 1 / (shares * shares).trace());
  }
  const double h_s = mission.law.anticipation * std::sqrt(variance_m2 * dimensions / 2) /
                     mission.law.u_max_mps / std::pow(n, 1 / dimensions);
  if (!mission.law.ends_with_plan) return h_s;
  const Timing& timing = mission.timing;
  const double left_s = static_cast<double>(tick_count - tick) * timing.dt_s;
  const double beside_s = static_cast<double>(tick_count) * timing.dt_s -
                          std::sqrt(variance_m2) / mission.law.u_max_mps;
  return std::max(0.0, std::min({h_s, left_s, beside_s}));
}

double weight_s(const Mission& mission, double h_s, Tick span, Tick age, Tick period) {
  const Tick cap =
      kPeriodsUntilDead * std::min(period, Tick{mission.timing.broadcast_period_ticks} *
                                               mission.timing.high_mode_period_factor);
  const double dt_s = mission.timing.dt_s, cap_s = static_cast<double>(cap) * dt_s;
  const double age_s = static_cast<double>(age) * dt_s;
  if (age_s > h_s && age_s > cap_s) return 0;
  return h_s + std::min(static_cast<double>(span) * dt_s, cap_s) + age_s;
}

Coefficients seen_at(const Mission& mission, int kind, const Eigen::Vector3d& x_m) {
  Coefficients gain = gain_at(mission, x_m);
  const double width_m = mission.kinds.empty()
                             ? 0
                             : mission.kinds.at(static_cast<std::size_t>(kind)).footprint_sigma_m;
  if (width_m == 0) return gain;
  for (Eigen::Index k = 0; k < gain.size(); ++k) {
    const auto n = k % mission.basis.modes_y, m = k / mission.basis.modes_y % mission.basis.modes_x;
    const auto l = k / mission.basis.modes_y / mission.basis.modes_x;
    for (const auto& [mode, axis] : {std::pair(m, 0), std::pair(n, 1), std::pair(l, 2)}) {
      if (mode == 0) continue;
      const double angle = std::numbers::pi * static_cast<double>(mode) * width_m;
      gain[k] *= std::exp(-std::pow(angle / mission.domain.size_m[axis], 2) / 2);
    }
  }
  return gain;
}

bool is_charged(const Mission& mission, const Vehicle& vehicle) {
  int place = vehicle.id;
  for (const AgentKind& kind : mission.kinds) {
    if (place >= kind.count) {
      place -= kind.count;
      continue;
    }
    if (kind.battery.capacity_wh == 0) return false;
    const auto& stations_m = kind.stations_m;
    const Eigen::Vector3d station_m =
        stations_m.size() == 1 ? stations_m[0] : stations_m[static_cast<std::size_t>(place)];
    const VehicleLimits& limits = kind.vehicle.value_or(mission.vehicle);
    const double limit_mps =
        kind.speed_limit_mps > 0 ? kind.speed_limit_mps : mission.speed_limit_mps;
    const double v_mps = limit_mps > 0 ? std::min(kind.u_max_mps, limit_mps) : kind.u_max_mps;
    const double dt_s = mission.timing.dt_s;
    const double most_m = 2 * v_mps * dt_s + 12 * mission.disturbance_intensity * std::sqrt(dt_s) +
                          2 * mission.separation.position_error_m;
    Eigen::Vector3d at_m = vehicle.position_m;
    if (limits.kind == VehicleKind::kFixedWing) {
      // It circles to the left around a place that is a radius away.
      const Eigen::Vector3d& v = vehicle.velocity_mps;
      at_m += Eigen::Vector3d(-v.y(), v.x(), 0) / v.head<2>().norm() * limits.min_speed_mps /
              limits.max_turn_radps;
    } else if (vehicle.velocity_mps.norm() >= v_mps / 2) {
      return false;
    }
    return (at_m - station_m).norm() <= most_m;
  }
  return false;
}

}  // namespace ergocast::lab
