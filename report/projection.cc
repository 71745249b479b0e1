// SPDX-License-Identifier: BSD-3-Clause
// Puts the two axes that are seen in the places of x and y.
#include "report/projection.h"

namespace ergocast {
namespace {

std::array<int, 3> modes_of(const Basis& basis) {
  return {basis.modes_x, basis.modes_y, basis.modes_z};
}

Eigen::Vector3d projected(const Eigen::Vector3d& vector, const View& view) {
  return {vector[view.across], vector[view.up], 0};
}

}  // namespace

std::vector<View> views_of(const Box& domain) {
  if (domain.planar()) return {{0, 1}};
  return {{0, 1}, {0, 2}, {1, 2}};
}

Mission projected(const Mission& mission, const View& view) {
  Mission seen = mission;
  const auto modes = modes_of(mission.basis);
  seen.domain = {projected(mission.domain.origin_m, view), projected(mission.domain.size_m, view)};
  seen.basis.modes_x = modes[static_cast<std::size_t>(view.across)];
  seen.basis.modes_y = modes[static_cast<std::size_t>(view.up)];
  seen.basis.modes_z = 1;
  seen.target_coefficients = projected(mission.target_coefficients, mission.basis, view);
  for (Eigen::Vector3d& start_m : seen.starts_m) start_m = projected(start_m, view);
  return seen;
}

Coefficients projected(const Coefficients& coefficients, const Basis& basis, const View& view) {
  // From a mode along each axis to the next, in the order of the basis.
  const std::array<int, 3> step{basis.modes_y, 1, basis.modes_x * basis.modes_y};
  const auto modes = modes_of(basis);
  const auto across = static_cast<std::size_t>(view.across), up = static_cast<std::size_t>(view.up);
  Coefficients seen(modes[across] * modes[up]);
  for (int i = 0; i < modes[across]; ++i) {
    for (int j = 0; j < modes[up]; ++j)
      seen[i * modes[up] + j] = coefficients[i * step[across] + j * step[up]];
  }
  return seen;
}

RunData projected(const RunData& run, const View& view) {
  RunData seen{run.tracks, {}, run.holds};
  for (auto& [agent, track] : seen.tracks) {
    for (TrackPoint& point : track) {
      point.x_m = projected(point.x_m, view);
      point.v_mps = projected(point.v_mps, view);
    }
  }
  return seen;
}

}  // namespace ergocast
