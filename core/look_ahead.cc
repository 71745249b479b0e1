// SPDX-License-Identifier: BSD-3-Clause
// Derives the spread of the target from its coefficients, and from it the horizon and each
// teammate's weight.
#include "core/look_ahead.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ergocast {
namespace {

/// A teammate that is silent for so many announced periods has no forecast any more.
constexpr Tick kPeriods = 8;

/// Variance along one axis of length 1; `mu(m)` is the coefficient of cos(mπx).
template <class Mu>
double unit_variance(int modes, const Mu& mu) {
  double mean = 0.5, square = 1.0 / 3;
  for (int m = 1; m < modes; ++m) {
    const double share = 4 * mu(m) / std::pow(std::numbers::pi * m, 2);
    if (m % 2 == 1) mean -= share;
    square += m % 2 == 1 ? -share : share;
  }
  return std::max(0.0, square - mean * mean);
}

}  // namespace

double target_spread_m(const Coefficients& target, const Basis& basis, const Box& domain) {
  if (const FreeModes* const modes = basis.free_modes()) return free_spread_m(*modes, target);
  // From a mode along one axis to the next, in the order of the basis.
  const int step_x = basis.modes_y, step_z = basis.modes_x * basis.modes_y;
  const auto deviation_m = [&](int axis, int modes, int step) {
    return domain.size_m[axis] *
           std::sqrt(unit_variance(modes, [&](int mode) { return target[mode * step]; }));
  };
  const double in_plane_m =
      std::hypot(deviation_m(0, basis.modes_x, step_x), deviation_m(1, basis.modes_y, 1));
  return std::hypot(in_plane_m, deviation_m(2, basis.modes_z, step_z));
}

LookAhead::LookAhead(const Mission& mission)
    : dt_s_(mission.timing.dt_s),
      alone_s_(mission.law.anticipation *
               target_spread_m(mission.target_coefficients, mission.basis, mission.domain) /
               mission.law.u_max_mps),
      end_tick_(mission.law.ends_with_plan ? mission.timing.tick_count
                                           : std::numeric_limits<Tick>::max()),
      longest_period_(longest_period_ticks(mission.timing)) {}

double LookAhead::horizon_s(int n, Tick tick) const {
  const double left_s = static_cast<double>(std::max<Tick>(0, end_tick_ - tick)) * dt_s_;
  return std::min(alone_s_ / std::sqrt(static_cast<double>(n)), left_s);
}

double LookAhead::weight_s(double horizon_s, Tick span, Tick age, Tick period) const {
  // What is announced may be anything, also the past.
  const Tick believed = std::clamp<Tick>(period, 0, longest_period_);
  const double cap_s = static_cast<double>(kPeriods * believed) * dt_s_;
  const double age_s = static_cast<double>(age) * dt_s_;
  if (age_s > std::max(horizon_s, cap_s)) return 0;
  return horizon_s + std::min(static_cast<double>(span) * dt_s_, cap_s) + age_s;
}

}  // namespace ergocast
