// SPDX-License-Identifier: BSD-3-Clause
// Moves teammates along a path that never closes, and prepares the blocks that they would send.
#include "tests/bench/step_team.h"

#include <cmath>

#include "core/base/require.h"
#include "modes/provide.h"

namespace ergocast::bench {
namespace {

/// The default law of scenarios: relative ε, contraction and adaptive noise.
Mission full_mission(int modes_per_axis, Sight sight, bool free_domain) {
  Mission mission;
  mission.seed = 7;
  mission.domain.size_m = {2000, 2000, 0};
  mission.basis.modes_x = mission.basis.modes_y = modes_per_axis;
  if (free_domain) {
    mission.basis.free_domain = true;
    mission.basis.table = table_of(mission).value();
    mission.basis.table_hash = mission.basis.table->hash;
  }
  mission.target_coefficients = basis_values({500, 700, 0}, mission.domain, mission.basis);
  mission.law.u_max_mps = 20;
  mission.law.regularization = Regularization::kRelative;
  mission.law.epsilon = 0.05;
  mission.law.perturbation = Perturbation::kAdaptive;
  mission.law.noise_intensity = 1;
  mission.law.noise_ceiling = 20;
  mission.law.contraction_gain_per_s = 1e-4;
  mission.law.contraction_center_m = {1000, 1000, 0};
  mission.law.anticipation = sight == Sight::kKnown ? 0 : 2;
  mission.dead_reckoning = sight == Sight::kReckoned;
  const bool told_each_tick = sight == Sight::kKnown || sight == Sight::kToldEachTick;
  mission.timing.broadcast_period_ticks = told_each_tick ? 1 : 10;
  return mission;
}

Author author_of(AgentId id) { return {id, 1000 + static_cast<Incarnation>(id)}; }

/// Along a path through most of the domain that never closes.
Eigen::Vector3d place(AgentId id, Tick tick) {
  const double angle = 0.01 * static_cast<double>(tick) + id;
  return {1000 + 900 * std::cos(angle), 1000 + 900 * std::sin(1.618 * angle), 0};
}

}  // namespace

StepTeam::StepTeam(int modes_per_axis, int agents, Sight sight, bool free_domain)
    : mission_(full_mission(modes_per_axis, sight, free_domain)),
      own_(mission_.basis, mission_.timing.dt_s),
      controller_(mission_),
      forecast_(mission_, author_of(0)),
      coverage_(Coefficients::Zero(modes_per_axis * modes_per_axis)),
      teammates_(static_cast<std::size_t>(agents - 1),
                 CoverageTable(mission_.basis, mission_.timing.dt_s)),
      places_m_(static_cast<std::size_t>(agents)) {
  if (sight == Sight::kKnown) own_.forgo_gains();
  for (AgentId id = 0; id < agents; ++id) roster_.push_back({author_of(id)});
}

void StepTeam::teammates_step() {
  places_m_[0] = place(0, ++tick_);
  news_.clear();
  const Tick period = mission_.timing.broadcast_period_ticks;
  AgentId id = 0;
  for (CoverageTable& theirs : teammates_) {
    const Author author = author_of(++id);
    const Eigen::Vector3d& x_m = places_m_[static_cast<std::size_t>(id)] = place(id, tick_);
    theirs.add_sample(author, BasisAt(x_m, mission_.domain, mission_.basis));
    if ((tick_ + id) % period != 0 && tick_ > 0) continue;
    for (int b = 0; b < theirs.block_count(); ++b) {
      Contribution& block = news_.emplace_back(theirs.block(author, b));
      block.header.tick = tick_;
      block.next_broadcast_tick = tick_ + period;
    }
  }
}

void StepTeam::merge_news() {
  for (const Contribution& block : news_) {
    ERGOCAST_REQUIRE(own_.merge(block, tick_ + 1) == Merge::kNewer);
  }
  for (AgentId id = 0; id < static_cast<AgentId>(places_m_.size()); ++id) {
    forecast_.see(id, tick_, places_m_[static_cast<std::size_t>(id)]);
  }
}

Eigen::Vector3d StepTeam::step() {
  const BasisAt at(places_m_[0], mission_.domain, mission_.basis);
  own_.add_sample(author_of(0), at);
  if (mission_.law.anticipation > 0) {
    forecast_.look_ahead(own_, roster_, tick_, coverage_);
  } else {
    own_.average(coverage_);
  }
  controller_.set_coverage(coverage_);
  return controller_.command(0, tick_, places_m_[0], at);
}

}  // namespace ergocast::bench
