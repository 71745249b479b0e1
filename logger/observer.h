// SPDX-License-Identifier: BSD-3-Clause
// φ² of the team for an outside observer, computed from the true positions of the vehicles. If
// kinds have footprints or qualities, it is of what the team has seen (core/mission/kinds.h). If
// the target changes, each moment counts against the target of its own time
// (core/law/target_shift.h), or with law.history KEEP against the present one. With a half-life it
// is of what the team remembers (core/mission/half_life.h).
#pragma once

#include <cstdint>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/mission/half_life.h"
#include "core/mission/kinds.h"
#include "core/mission/mission.h"

namespace ergocast {

class Observer {
 public:
  /// Begins with no coverage.
  void begin(const Mission& mission) {
    weights_ = sobolev_weights(mission.basis, mission.domain);
    sums_ = {Coefficients::Zero(mission.basis.mode_count()), 0};
    before_ = sums_;
    sensors_ = Sensors(mission);
    half_life_ = HalfLife(mission);
    keeps_ = mission.law.history == TargetHistory::kKeep;
  }
  bool begun() const { return weights_.size() > 0; }

  /// A member of `kind` was at `x_m` for a tick, `counted` among those that count; they ascend.
  /// Places outside of the domain cover nothing.
  void see(const Mission& mission, Tick counted, int kind, const Eigen::Vector3d& x_m) {
    if (!mission.domain.contains(x_m)) return;
    fade(half_life_.halvings(counted));
    const double worth_s =
        sensors_.of(kind).sample(CosinesAt(x_m, mission.domain, mission.basis), mission.basis,
                                 mission.timing.dt_s, sums_.f_s.data());
    if (shift_.size() > 0 && !keeps_) sums_.f_s -= worth_s * shift_;
    sums_.covered_s += worth_s;
  }
  /// From now on the team covers `target`, in the place of the plan's or the last one.
  void begin_target(const Mission& mission, const Coefficients& target) {
    shift_ = target - mission.target_coefficients;
    before_ = sums_;
  }
  /// A time that is no number counts, so that it shows in the metric.
  bool has_seen_any() const { return sums_.covered_s != 0; }
  /// Whether it has seen anything since the newest begin_target(), or since begin().
  bool has_seen_any_of_target() const { return sums_.covered_s != before_.covered_s; }

  /// c_k of (4) so far, shifted: c − μ₀ is the average of f − μ(t), where μ₀ is the plan's target.
  /// With law.history KEEP it is that of f − μ of now. @pre has_seen_any()
  Coefficients coverage() const { return average(sums_); }
  /// φ² of the coverage so far. @pre has_seen_any()
  double metric(const Mission& mission) const {
    return ergodic_metric(coverage(), mission.target_coefficients, weights_);
  }
  /// φ² of the coverage since the newest begin_target() against its target; before any, metric().
  /// @pre has_seen_any_of_target()
  double metric_of_target(const Mission& mission) const {
    // All samples of this time have the same shift.
    return ergodic_metric(average({sums_.f_s - before_.f_s, sums_.covered_s - before_.covered_s}),
                          mission.target_coefficients, weights_);
  }

 private:
  struct Sums {
    Coefficients f_s;
    double covered_s = 0;
  };

  Coefficients average(const Sums& sums) const {
    Coefficients c = sums.f_s / sums.covered_s;
    if (keeps_ && shift_.size() > 0) c -= shift_;
    return c;
  }

  void fade(std::int64_t halvings) {
    if (halvings <= halvings_) return;
    const double factor = HalfLife::factor(halvings_, halvings);
    halvings_ = halvings;
    for (Sums* const sums : {&sums_, &before_}) {
      sums->f_s *= factor;
      sums->covered_s *= factor;
    }
  }

  Sums sums_;
  Sums before_;         // at the newest change of the target, halved since as `sums_`
  Coefficients shift_;  // μ − μ₀; empty: 0
  Coefficients weights_;
  Sensors sensors_;
  HalfLife half_life_;
  bool keeps_ = false;  // law.history KEEP
  std::int64_t halvings_ = 0;
};

}  // namespace ergocast
