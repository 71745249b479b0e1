// SPDX-License-Identifier: BSD-3-Clause
// A mission without any symmetry for tests of the control step, with places, coverage and commands.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/noise.h"
#include "core/law/control.h"
#include "tests/support/team.h"

namespace ergocast {

inline constexpr double kRounding = 0x1p-53;
inline constexpr double kTiniest = std::numeric_limits<double>::denorm_min();

/// A mission on a domain with its own origin and unequal sides; μ without any pattern.
inline Mission uneven_mission() {
  Mission mission = test::small_mission(1);
  mission.domain = {{-300, 50, 0}, {2000, 1200, 0}};
  mission.basis.modes_x = 9;
  mission.basis.modes_y = 7;
  mission.target_coefficients = Coefficients::Zero(63);
  for (int m = 0; m < 9; ++m) {
    for (int n = 0; n < 7; ++n) {
      mission.target_coefficients[7 * m + n] = std::cos(1.0 + 2.3 * m + 0.7 * n * n) / (1 + m + n);
    }
  }
  mission.target_coefficients[0] = 1;
  mission.law.u_max_mps = 12;
  mission.timing.dt_s = 0.125;
  return mission;
}

inline Eigen::Vector3d place_in(const Box& domain, std::uint64_t i) {
  return uniform_in(domain, 5, Purpose::kStart, 0, i);
}

/// c_k of a path of `steps` places.
inline Coefficients coverage_of(const Mission& mission, int steps) {
  Coefficients sum = Coefficients::Zero(mission.basis.mode_count());
  for (int i = 0; i < steps; ++i) {
    sum += basis_values(place_in(mission.domain, static_cast<std::uint64_t>(i)), mission.domain,
                        mission.basis);
  }
  return sum / steps;
}

inline Eigen::Vector3d command_at(Controller& controller, const Mission& mission,
                                  const Eigen::Vector3d& x_m, const Coefficients& coverage,
                                  AgentId agent = 0, Tick tick = 0) {
  controller.set_coverage(coverage);
  return controller.command(agent, tick, x_m, BasisAt(x_m, mission.domain, mission.basis));
}

}  // namespace ergocast
