// SPDX-License-Identifier: BSD-3-Clause
// A mission in which every field has an effect.
#pragma once

#include "core/mission.h"

namespace ergocast::test {

/// No field at its default, no number twice.
inline Mission rich_mission() {
  Mission mission;
  mission.name = "rich";
  mission.seed = ~std::uint64_t{0};
  mission.domain = {{-3, 4, 0}, {101, 52, 0}};
  mission.basis = {.modes_x = 3,
                   .modes_y = 2,
                   .sobolev_form = SobolevForm::kNorm,
                   .sobolev_exponent = 1.75,
                   .normalized = true};
  mission.target_coefficients = Coefficients(6);
  mission.target_coefficients << 1, 0.1, -0.2, 0.3, -0.4, 0.55;
  mission.law = {.u_max_mps = 5.5,
                 .regularization = Regularization::kRelative,
                 .epsilon = 0.25,
                 .perturbation = Perturbation::kAdaptive,
                 .noise_intensity = 0.75,
                 .noise_ceiling = 1.5,
                 .contraction_gain_per_s = 0.0002,
                 .contraction_center_m = {33, 34, 0},
                 .anticipation = 3.5,
                 .ends_with_plan = true,
                 .paired_pushes = true};
  mission.timing = {.dt_s = 0.125,
                    .tick_count = 480,
                    .broadcast_period_ticks = 7,
                    .pace = Pace::kRealtime,
                    .realtime_factor = 2.5,
                    .lockstep_timeout_s = 11,
                    .command_hold_s = 0.8,
                    .admission_timeout_s = 31,
                    .catch_up_limit_ticks = 6,
                    .on_timeout = OnTimeout::kEvict};
  mission.starts_m = {{17, 20, 0}, {18, 21, 0}};
  mission.quorum = 2;
  mission.forget_silent_after_s = 12;
  mission.goal_ergodic_metric = 0.03;
  mission.disturbance_intensity = 0.6;
  mission.radio_range_m = 60;
  mission.speed_limit_mps = 8;
  mission.dead_reckoning = true;
  mission.wait_for_logger = false;
  return mission;
}

}  // namespace ergocast::test
