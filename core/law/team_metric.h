// SPDX-License-Identifier: BSD-3-Clause
// φ² of a coverage against a mission's target, over all modes, whichever law the team follows.
#pragma once

#include "core/basis/basis.h"
#include "core/mission/mission.h"

namespace ergocast {

class TeamMetric {
 public:
  explicit TeamMetric(const Mission& mission);

  /// φ². @param coverage  mode_count() entries
  double of(const Coefficients& coverage) const;

 private:
  Coefficients target_, weights_;
};

}  // namespace ergocast
