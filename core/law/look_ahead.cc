// SPDX-License-Identifier: BSD-3-Clause
// Derives the covariance of the target from its coefficients, and from it the horizon and the
// weight of each teammate.
#include "core/law/look_ahead.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/portable_math.h"

namespace ergocast {
namespace {

/// A teammate that has been silent for this many announced periods has no forecast any more.
constexpr Tick kPeriods = 8;

/// The share of mode m in the mean along an axis of length 1, and in the mean of the square.
double axis_share(int mode) { return 4 / portable::square(std::numbers::pi * mode); }

/// Coefficients along the axes of a basis.
struct AxisModes {
  AxisModes(const Coefficients& target, const Basis& basis)
      : mu(target),
        count{basis.modes_x, basis.modes_y, basis.modes_z},
        step{basis.modes_y, 1, basis.modes_x * basis.modes_y} {}

  /// The variance along an axis whose length is 1.
  double variance(int axis) const {
    double mean = 0.5, square = 1.0 / 3;
    for (int m = 1; m < count[axis]; ++m) {
      const double share = axis_share(m) * mu[m * step[axis]];
      if (m % 2 == 1) mean -= share;
      square += m % 2 == 1 ? -share : share;
    }
    return std::max(0.0, square - mean * mean);
  }

  double covariance(int a, int b) const {
    double sum = 0;
    for (int m = 1; m < count[a]; m += 2) {
      for (int n = 1; n < count[b]; n += 2) {
        const double apart = mu[m * step[a]] * mu[n * step[b]];
        sum += axis_share(m) * axis_share(n) * (mu[m * step[a] + n * step[b]] - apart);
      }
    }
    return sum;
  }

  const Coefficients& mu;
  int count[3], step[3];
};

}  // namespace

Eigen::Matrix3d target_covariance_m2(const Coefficients& target, const Basis& basis,
                                     const Box& domain) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  if (const FreeModes* const modes = basis.free_modes()) {
    covariance.topLeftCorner<2, 2>() = free_covariance_m2(*modes, target);
    return covariance;
  }
  const AxisModes along(target, basis);
  for (int a = 0; a < (basis.planar() ? 2 : 3); ++a) {
    covariance(a, a) = along.variance(a);
    for (int b = 0; b < a; ++b) covariance(a, b) = covariance(b, a) = along.covariance(a, b);
  }
  const auto sizes_m = domain.size_m.asDiagonal();
  return sizes_m * covariance * sizes_m;
}

double target_spread_m(const Eigen::Matrix3d& covariance_m2) {
  return std::sqrt(covariance_m2.trace());
}

double shared_dimensions(const Eigen::Matrix3d& covariance_m2) {
  // The division comes first, so that the square of a small domain's trace does not underflow.
  const double trace_m2 = covariance_m2.trace();
  return trace_m2 > 0 ? std::min(2.0, 1 / (covariance_m2 / trace_m2).squaredNorm()) : 2;
}

LookAhead::LookAhead(const Mission& mission)
    : LookAhead(mission,
                target_covariance_m2(mission.target_coefficients, mission.basis, mission.domain)) {}

LookAhead::LookAhead(const Mission& mission, const Eigen::Matrix3d& covariance_m2)
    : dt_s_(mission.timing.dt_s),
      alone_s_((looks_ahead(mission) ? mission.law.anticipation : 0) *
               target_spread_m(covariance_m2) * std::sqrt(shared_dimensions(covariance_m2) / 2) /
               mission.law.u_max_mps),
      cross_s_(target_spread_m(covariance_m2) / mission.law.u_max_mps),
      most_s_(std::numeric_limits<double>::infinity()),
      inverse_dimensions_(1 / shared_dimensions(covariance_m2)),
      ends_with_plan_(mission.law.ends_with_plan),
      end_tick_(std::numeric_limits<Tick>::max()),
      longest_period_(longest_period_ticks(mission.timing)) {
  set_end(mission.timing.tick_count);
}

void LookAhead::set_end(Tick tick_count) {
  if (!ends_with_plan_) return;
  end_tick_ = tick_count;
  const double duration_s = static_cast<double>(end_tick_) * dt_s_;
  most_s_ = std::max(0.0, duration_s - cross_s_);
}

double LookAhead::horizon_s(int n, Tick tick) const {
  const double left_s = static_cast<double>(std::max<Tick>(0, end_tick_ - tick)) * dt_s_;
  const double nats = inverse_dimensions_ * portable::log(static_cast<double>(n));
  const double share_s = alone_s_ * portable::exp(-nats);  // cheaper than a pow()
  return std::min({share_s, most_s_, left_s});
}

double LookAhead::cap_s(Tick period) const {
  // A message may announce anything, also a past tick.
  const Tick believed = std::clamp<Tick>(period, 0, longest_period_);
  return static_cast<double>(kPeriods * believed) * dt_s_;
}

double LookAhead::weight_s(double horizon_s, Tick span, Tick age, Tick period) const {
  const double lag_s = std::min(static_cast<double>(span) * dt_s_, cap_s(period));
  return weight_with_lag_s(horizon_s, lag_s, age, period);
}

double LookAhead::weight_with_lag_s(double horizon_s, double lag_s, Tick age, Tick period) const {
  const double age_s = static_cast<double>(age) * dt_s_;
  if (age_s > std::max(horizon_s, cap_s(period))) return 0;
  return horizon_s + lag_s + age_s;
}

}  // namespace ergocast
