#include "bench/step_team.h"

#include <cmath>

#include "core/require.h"

namespace ergocast::bench {
namespace {

/// The law that scenarios get by default: relative ε, contraction and adaptive noise.
Mission full_mission(int modes_per_axis) {
  Mission mission;
  mission.seed = 7;
  mission.domain.size_m = {2000, 2000};
  mission.basis.modes_x = mission.basis.modes_y = modes_per_axis;
  mission.target_coefficients = basis_values({500, 700}, mission.domain, mission.basis);
  mission.law.u_max_mps = 20;
  mission.law.regularization = Regularization::kRelative;
  mission.law.epsilon = 0.2;
  mission.law.perturbation = Perturbation::kAdaptive;
  mission.law.noise_intensity = 1;
  mission.law.noise_ceiling = 20;
  mission.law.contraction_gain_per_s = 1e-4;
  mission.law.contraction_center_m = {1000, 1000};
  return mission;
}

Author author_of(AgentId id) { return {id, 1000 + static_cast<Incarnation>(id)}; }

/// Along a path through most of the domain that never closes.
Eigen::Vector2d place(AgentId id, Tick tick) {
  const double angle = 0.01 * static_cast<double>(tick) + id;
  return {1000 + 900 * std::cos(angle), 1000 + 900 * std::sin(1.618 * angle)};
}

}  // namespace

StepTeam::StepTeam(int modes_per_axis, int agents)
    : mission_(full_mission(modes_per_axis)),
      own_(mission_.basis, mission_.timing.dt_s),
      controller_(mission_),
      coverage_(Coefficients::Zero(modes_per_axis, modes_per_axis)),
      teammates_(static_cast<std::size_t>(agents - 1),
                 CoverageTable(mission_.basis, mission_.timing.dt_s)) {}

void StepTeam::teammates_step() {
  x_m_ = place(0, ++tick_);
  news_.clear();
  AgentId id = 0;
  for (CoverageTable& theirs : teammates_) {
    const Author author = author_of(++id);
    theirs.add_sample(author, BasisAt(place(id, tick_), mission_.domain, mission_.basis));
    for (int b = 0; b < theirs.block_count(); ++b) news_.push_back(theirs.block(author, b));
  }
}

void StepTeam::merge_news() {
  for (const Contribution& block : news_) {
    ERGOCAST_REQUIRE(own_.merge(block, tick_ + 1) == Merge::kNewer);
  }
}

Eigen::Vector2d StepTeam::step() {
  const BasisAt at(x_m_, mission_.domain, mission_.basis);
  own_.add_sample(author_of(0), at);
  own_.average(coverage_);
  controller_.see(coverage_);
  return controller_.command(0, tick_, x_m_, at);
}

}  // namespace ergocast::bench
