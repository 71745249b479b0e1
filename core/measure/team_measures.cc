// SPDX-License-Identifier: BSD-3-Clause
// Passes each place on to what is measured.
#include "core/measure/team_measures.h"

#include <algorithm>

#include "core/measure/target_mass.h"
#include "core/measure/transport.h"

namespace ergocast {

TeamMeasures::TeamMeasures(const Mission& mission)
    : domain_(mission.domain), detection_(mission), time_(detection_.cells().total(), 0) {
  begin_target(mission, mission.target_coefficients, 0);
}

void TeamMeasures::begin_target(const Mission& mission, const Coefficients& target, Tick counted) {
  detection_.begin_target(target_mass(mission.basis, mission.walls, target, detection_.cells()),
                          counted);
  std::ranges::fill(time_, 0.0);
}

void TeamMeasures::see(AgentId id, Tick counted, const Eigen::Vector3d& x_m, bool covers) {
  const auto [last, first_time] = places_m_.try_emplace(id, x_m);
  if (!first_time) path_m_ += (x_m - last->second).norm();
  last->second = x_m;
  if (!covers || !domain_.contains(x_m)) return;
  detection_.see(counted, x_m);
  time_[detection_.cells().cell_of(x_m)] += 1;
}

void TeamMeasures::pass(Tick counted) {
  detection_.pass(counted);
  ticks_ = counted + 1;
}

TeamFigures TeamMeasures::figures() const {
  return {.detection_probability = detection_.probability(),
          .half_time_s = detection_.half_time_s(),
          .four_fifths_time_s = detection_.four_fifths_time_s(),
          .greatest_age_s = detection_.greatest_age_s(ticks_, kWatchedShare),
          .wasserstein_m = sliced_wasserstein_m(detection_.cells(), detection_.mass(), time_),
          .path_m = path_m_};
}

}  // namespace ergocast
