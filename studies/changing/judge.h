// SPDX-License-Identifier: BSD-3-Clause
// φ² of a stretch of time: what all vehicles have covered in it, against the target that held.
#pragma once

#include "core/basis/basis.h"
#include "core/mission/mission.h"

namespace ergocast::studies {

class Judge {
 public:
  explicit Judge(const Mission& mission)
      : domain_(mission.domain),
        basis_(mission.basis),
        weights_(sobolev_weights(mission.basis, mission.domain)) {
    begin();
  }

  /// A new stretch of time begins.
  void begin() {
    covered_.setZero(basis_.mode_count());
    wanted_.setZero(basis_.mode_count());
    places_ = 0;
  }
  /// A vehicle is at `x_m` for a tick while `target` holds.
  void see(const Eigen::Vector3d& x_m, const Coefficients& target) {
    accumulate_basis(CosinesAt(x_m, domain_, basis_), basis_, 1, covered_.data());
    wanted_ += target;
    ++places_;
  }
  /// Against the mean of the targets. @pre any place was seen
  double metric() const { return ergodic_metric(covered_ / places_, wanted_ / places_, weights_); }

 private:
  Box domain_;
  Basis basis_;
  Coefficients weights_, covered_, wanted_;
  double places_ = 0;
};

}  // namespace ergocast::studies
