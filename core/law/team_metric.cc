// SPDX-License-Identifier: BSD-3-Clause
// Keeps the two vectors that φ² needs.
#include "core/law/team_metric.h"

namespace ergocast {

TeamMetric::TeamMetric(const Mission& mission)
    : target_(mission.target_coefficients),
      weights_(sobolev_weights(mission.basis, mission.domain)) {}

double TeamMetric::of(const Coefficients& coverage) const {
  return ergodic_metric(coverage, target_, weights_);
}

}  // namespace ergocast
