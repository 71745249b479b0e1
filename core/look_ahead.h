// SPDX-License-Identifier: BSD-3-Clause
// How far ahead an agent looks: the weights of core/forecast.h.
#pragma once

#include "core/basis.h"
#include "core/ids.h"
#include "core/mission.h"

namespace ergocast {

/// The RMS distance of the target's mass from its mean, s = √(Var x + Var y + Var z) [m], from μ
/// alone, with L the domain's size along an axis and μ_m the coefficients along it:
///   E[x]/L = ½ − Σ_{m odd} 4 μ_m / (π² m²),   E[x²]/L² = ⅓ + Σ_{m ≥ 1} (−1)^m 4 μ_m / (π² m²)
/// The sums end with the last mode; the rest of each is at most 4 / (π² (modes − ½)). In a free
/// domain free_spread_m().
double target_spread_m(const Coefficients& target, const Basis& basis, const Box& domain);

/// h and the weights of a teammate's gains, for one mission.
class LookAhead {
 public:
  explicit LookAhead(const Mission& mission);

  /// Whether the mission's law looks ahead at all.
  bool any() const { return alone_s_ > 0; }

  /// h = a s / (u_max √n) [s] for a team of `n`; with ends_with_plan at most the time left at
  /// `tick`, which is 0 after the end.
  double horizon_s(int n, Tick tick) const;

  /// For how long [s] a teammate's rate over `span` ticks, last known `age` ticks ago, is assumed
  /// to hold, past and future together:
  ///   w = h + min(span dt, cap) + age dt,   0 if age dt > max(h, cap),   cap = 8 periods
  /// @param period  announced by the teammate, any number; it is limited to what the plan allows
  double weight_s(double horizon_s, Tick span, Tick age, Tick period) const;

  /// The longest time between two broadcasts that the plan allows.
  Tick longest_period() const { return longest_period_; }

 private:
  double dt_s_;
  double alone_s_;  // h of a team of one
  Tick end_tick_;   // where h ends at the latest
  Tick longest_period_;
};

}  // namespace ergocast
