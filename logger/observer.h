// SPDX-License-Identifier: BSD-3-Clause
// φ² of the team for an outside observer, computed from the true positions of the vehicles. If
// kinds have footprints or qualities, it is of what the team has seen (core/mission/kinds.h). With a
// half-life it is of what the team remembers (core/law/half_life.h).
#pragma once

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/law/half_life.h"
#include "core/mission/kinds.h"
#include "core/mission/mission.h"

namespace ergocast {

class Observer {
 public:
  /// Begins with no coverage.
  void begin(const Mission& mission) {
    weights_ = sobolev_weights(mission.basis, mission.domain);
    sums_s_ = Coefficients::Zero(mission.basis.mode_count());
    sensors_ = Sensors(mission);
    half_life_ = HalfLife(mission);
  }
  bool begun() const { return weights_.size() > 0; }

  /// A member of `kind` was at `x_m` for a tick, `counted` among those that count; they ascend.
  /// Places outside of the domain cover nothing.
  void see(const Mission& mission, Tick counted, int kind, const Eigen::Vector3d& x_m) {
    if (!mission.domain.contains(x_m)) return;
    fade(half_life_.halvings(counted));
    covered_s_ += sensors_.of(kind).sample(CosinesAt(x_m, mission.domain, mission.basis),
                                           mission.basis, mission.timing.dt_s, sums_s_.data());
  }
  bool has_seen_any() const { return covered_s_ > 0; }

  /// c_k of (4) so far. @pre has_seen_any()
  Coefficients coverage() const { return sums_s_ / covered_s_; }
  /// φ² of the coverage so far. @pre has_seen_any()
  double metric(const Mission& mission) const {
    return ergodic_metric(coverage(), mission.target_coefficients, weights_);
  }

 private:
  void fade(std::int64_t halvings) {
    if (halvings <= halvings_) return;
    const double factor = HalfLife::factor(halvings_, halvings);
    halvings_ = halvings;
    sums_s_ *= factor;
    covered_s_ *= factor;
  }

  Coefficients sums_s_, weights_;
  Sensors sensors_;
  double covered_s_ = 0;
  HalfLife half_life_;
  std::int64_t halvings_ = 0;
};

}  // namespace ergocast
