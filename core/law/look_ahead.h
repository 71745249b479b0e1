// SPDX-License-Identifier: BSD-3-Clause
// How far ahead an agent looks: the weights of core/law/forecast.h.
#pragma once

#include <Eigen/Core>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Whether agents of a mission forecast the team's coverage.
inline bool looks_ahead(const Mission& mission) {
  return mission.law.kind == LawKind::kCover && mission.law.anticipation > 0;
}

/// The covariance of the target's mass [m²], from μ alone. With L the domain's size along an axis,
/// μ_m the coefficients along it, and a_m = 4 / (π² m²):
///   E[x]/L = ½ − Σ_{m odd} a_m μ_m,   E[x²]/L² = ⅓ + Σ_{m ≥ 1} (−1)^m a_m μ_m
///   Cov[x, y] / (Lx Ly) = Σ_{m, n odd} a_m a_n (μ_mn − μ_m μ_n)
/// The sums end with the last mode; the rest of each of the first two is at most 4 / (π² (modes −
/// ½)). In a free domain free_covariance_m2(). Along z it is 0 in a plane.
Eigen::Matrix3d target_covariance_m2(const Coefficients& target, const Basis& basis,
                                     const Box& domain);

/// The RMS distance of the target's mass from its mean, s = √tr C [m].
double target_spread_m(const Eigen::Matrix3d& covariance_m2);

/// In how many dimensions a team shares out a target with the covariance C:
///   d = (tr C)² / tr C²,   2 at most
/// It is 1 for a strip and 2 for a square. Cubes count as squares: a longer horizon was found to be
/// worse there. @return 2 if C is 0
double shared_dimensions(const Eigen::Matrix3d& covariance_m2);

/// h and the weights of a teammate's gains, for one mission.
class LookAhead {
 public:
  explicit LookAhead(const Mission& mission);

  /// Takes in the number of ticks by the end that holds.
  void set_end(Tick tick_count);

  /// Whether the mission's law looks ahead at all.
  bool any() const { return alone_s_ > 0; }

  /// h = a s √(d/2) / (u_max n^(1/d)) [s] for a team of `n`, with d = shared_dimensions(): about
  /// the time to cross an agent's share. With ends_with_plan it is at most the time left at `tick`,
  /// which is 0 after the end. It is then also at most T − s / u_max, with T the plan's duration: a
  /// mission in which no agent can cross the target leaves no time to share it out.
  double horizon_s(int n, Tick tick) const;

  /// For how long [s] a teammate's rate over `span` ticks, last known `age` ticks ago, is assumed
  /// to hold, past and future together:
  ///   w = h + min(span dt, cap) + age dt,   0 if age dt > max(h, cap),   cap = 8 periods
  /// @param period  as announced by the teammate; any number is limited to what the plan allows
  double weight_s(double horizon_s, Tick span, Tick age, Tick period) const;
  /// The same with what stands in the place of min(span dt, cap), such as a mean over members:
  ///   w = h + lag + age dt,   0 if age dt > max(h, cap)
  double weight_with_lag_s(double horizon_s, double lag_s, Tick age, Tick period) const;

  /// The longest time between two broadcasts that the plan allows.
  Tick longest_period() const { return longest_period_; }

 private:
  LookAhead(const Mission& mission, const Eigen::Matrix3d& covariance_m2);

  double cap_s(Tick period) const;

  double dt_s_;
  double alone_s_;             // h of a team of one
  double cross_s_;             // the time to cross the target
  double most_s_;              // of h, in a short mission
  double inverse_dimensions_;  // 1 / d
  bool ends_with_plan_;
  Tick end_tick_;  // the latest end of the horizon
  Tick longest_period_;
};

}  // namespace ergocast
