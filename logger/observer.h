// SPDX-License-Identifier: BSD-3-Clause
// φ² of the team for an outside observer, computed from the true positions of the vehicles.
#pragma once

#include "core/basis.h"
#include "core/mission.h"

namespace ergocast {

class Observer {
 public:
  /// Begins with no coverage.
  void begin(const Mission& mission) {
    weights_ = sobolev_weights(mission.basis, mission.domain);
    sums_s_ = Coefficients::Zero(mission.basis.mode_count());
  }
  bool begun() const { return weights_.size() > 0; }

  /// A member was at `x_m` for a tick. Places outside of the domain cover nothing.
  void see(const Mission& mission, const Eigen::Vector3d& x_m) {
    if (!mission.domain.contains(x_m)) return;
    accumulate_basis(BasisAt(x_m, mission.domain, mission.basis), mission.basis,
                     mission.timing.dt_s, sums_s_.data());
    covered_s_ += mission.timing.dt_s;
  }
  bool has_seen_any() const { return covered_s_ > 0; }

  /// c_k of (4) so far. @pre has_seen_any()
  Coefficients coverage() const { return sums_s_ / covered_s_; }
  /// φ² of the coverage so far. @pre has_seen_any()
  double metric(const Mission& mission) const {
    return ergodic_metric(coverage(), mission.target_coefficients, weights_);
  }

 private:
  Coefficients sums_s_, weights_;
  double covered_s_ = 0;
};

}  // namespace ergocast
