// SPDX-License-Identifier: BSD-3-Clause
// Holds a mission against its limits, field by field.
#include "core/mission_limits.h"

#include <algorithm>
#include <cmath>

namespace ergocast {
namespace {

/// ASCII only: std::isalnum depends on the locale.
bool may_lead(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}
bool may_follow(char c) { return may_lead(c) || c == '-' || c == '.'; }

bool is_place(const Eigen::Vector3d& x_m) {
  return limits::kCoordinate_m.contain(x_m.x()) && limits::kCoordinate_m.contain(x_m.y()) &&
         x_m.z() == 0;
}

/// Whether a limit that 0 takes away is none or a possible one.
bool is_none_or(const Limits& limits, double value) { return value == 0 || limits.contain(value); }

/// No scenario and no plan can say a height yet.
bool fits(const Box& domain) {
  if (!domain.planar() || domain.origin_m.z() != 0) return false;
  for (int axis = 0; axis < 2; ++axis) {
    if (!limits::kSize_m.contain(domain.size_m[axis])) return false;
    if (!(std::abs(domain.origin_m[axis]) <= limits::kMaxOriginPerSize * domain.size_m[axis]))
      return false;
  }
  return true;
}

/// A single mode tells no two places apart.
bool fits(const Basis& basis) {
  return limits::kModes.contain(basis.modes_x) && limits::kModes.contain(basis.modes_y) &&
         basis.planar() && basis.mode_count() >= 2 &&
         limits::kSobolevExponent.contain(basis.sobolev_exponent);
}

/// |∫ f ρ| ≤ 1, but for the rounding of the quadrature.
bool is_coefficient(double value) { return std::abs(value) <= 1 + 1e-9; }

bool is_target(const Coefficients& target, const Basis& basis) {
  if (target.size() != basis.mode_count()) return false;
  return target[0] == 1 && std::all_of(target.begin(), target.end(), is_coefficient);
}

bool fits(const ControlLaw& law) {
  const bool adaptive = law.perturbation == Perturbation::kAdaptive;
  return limits::kSpeed_mps.contain(law.u_max_mps) && limits::kEpsilon.contain(law.epsilon) &&
         limits::kIntensity.contain(law.noise_intensity) &&
         limits::kIntensity.contain(law.noise_ceiling) &&
         (adaptive ? law.noise_ceiling >= law.noise_intensity : law.noise_ceiling == 0) &&
         limits::kContractionGain_per_s.contain(law.contraction_gain_per_s) &&
         is_place(law.contraction_center_m) && limits::kAnticipation.contain(law.anticipation);
}

bool fits(const Timing& timing) {
  const auto ticks = static_cast<double>(timing.tick_count);
  if (!limits::kStep_s.contain(timing.dt_s) || !(ticks >= 1 && ticks <= limits::kMaxTicks))
    return false;
  const bool lasts = std::round(duration_s(timing) / timing.dt_s) == ticks;
  const bool realtime = timing.pace == Pace::kRealtime;
  return lasts && limits::kBroadcastPeriod_ticks.contain(timing.broadcast_period_ticks) &&
         limits::kRealtimeFactor.contain(timing.realtime_factor) &&
         (!realtime || timing.dt_s / timing.realtime_factor >= limits::kMinWallStep_s) &&
         limits::kTimeout_s.contain(timing.lockstep_timeout_s) &&
         limits::kTimeout_s.contain(timing.admission_timeout_s) &&
         limits::kCommandHold_s.contain(timing.command_hold_s) &&
         limits::kCatchUp_ticks.contain(timing.catch_up_limit_ticks);
}

/// No step of input, noise or contraction is longer than the domain, and the input holds its own
/// against the contraction everywhere.
/// @pre each of them is within its own limits
bool fit_together(const ControlLaw& law, double disturbance_intensity, const Box& domain,
                  double dt_s) {
  const double side_m = domain.shortest_side_m();
  const double reach_m = domain.farthest_distance_m(law.contraction_center_m);
  const auto noise_fits = [&](double intensity) { return intensity * std::sqrt(dt_s) <= side_m; };
  return law.u_max_mps * dt_s <= side_m && noise_fits(law.noise_intensity) &&
         noise_fits(law.noise_ceiling) && noise_fits(disturbance_intensity) &&
         law.contraction_gain_per_s * dt_s <= 1 &&
         law.u_max_mps >= law.contraction_gain_per_s * reach_m;
}

bool is_team(const Mission& mission) {
  const auto size = static_cast<double>(mission.starts_m.size());
  const auto& starts_m = mission.starts_m;
  const auto inside = [&](const Eigen::Vector3d& x_m) {
    return x_m.z() == 0 && mission.domain.contains(x_m);
  };
  return limits::kTeam.contain(size) && limits::kTeam.contain(mission.quorum) &&
         mission.quorum <= size && std::all_of(starts_m.begin(), starts_m.end(), inside);
}

}  // namespace

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxNameLength && may_lead(name.front()) &&
         std::all_of(name.begin(), name.end(), may_follow);
}

double duration_s(const Timing& timing) {
  return std::min(static_cast<double>(timing.tick_count) * timing.dt_s, limits::kDuration_s.high);
}

bool within_limits(const Mission& mission) {
  return is_name(mission.name) && fits(mission.domain) && fits(mission.basis) &&
         is_target(mission.target_coefficients, mission.basis) && fits(mission.law) &&
         fits(mission.timing) && limits::kIntensity.contain(mission.disturbance_intensity) &&
         fit_together(mission.law, mission.disturbance_intensity, mission.domain,
                      mission.timing.dt_s) &&
         is_team(mission) && limits::kForgetting_s.contain(mission.forget_silent_after_s) &&
         limits::kRadioRange_m.contain(mission.radio_range_m) &&
         is_none_or(limits::kGoal, mission.goal_ergodic_metric) &&
         is_none_or(limits::kSpeedLimit_mps, mission.speed_limit_mps);
}

}  // namespace ergocast
