// SPDX-License-Identifier: BSD-3-Clause
// A small mission whose sensors have false alarms.
#pragma once

#include "core/mission/mission.h"

namespace ergocast {

/// 200 m × 100 m, 20 × 10 cells, with a uniform target.
inline Mission searched_field() {
  Mission mission;
  mission.domain = {{-20, 5, 0}, {200, 100, 0}};
  mission.basis.modes_x = mission.basis.modes_y = 8;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.law.kind = LawKind::kSearch;
  mission.law.u_max_mps = 5;
  mission.timing.dt_s = 0.1;
  mission.sensor = {
      .radius_m = 10, .detections_per_s = 0.5, .false_alarms_per_s = 0.02, .position_error_m = 2};
  return mission;
}

}  // namespace ergocast
