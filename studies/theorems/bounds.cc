// SPDX-License-Identifier: BSD-3-Clause
// Evaluates the bounds of Theorem 2 and Corollary 1, and runs teams to measure the same quantities.
#include "studies/theorems/bounds.h"

#include <algorithm>
#include <cmath>

#include "core/base/noise.h"
#include "target/target.h"

namespace ergocast::studies {
namespace {

double start_distance_m(const Mission& mission, std::size_t agent) {
  return (mission.starts_m[agent] - mission.law.contraction_center_m).norm();
}

double reach_m(const ControlLaw& law) { return law.u_max_mps / law.contraction_gain_per_s; }

double contracted_m(const Mission& mission, double start_m, double kept) {
  return kept * start_m + reach_m(mission.law) * (1 - kept);
}

/// Draws numbers one after the other.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * uniform_pair(seed_, Purpose::kStart, 0, step_++).x();
  }
  double decades(double low, double high) {
    return std::pow(10, between(std::log10(low), std::log10(high)));
  }
  int whole(int low, int high) { return std::min(high, static_cast<int>(between(low, high + 1))); }
  Eigen::Vector3d in(const Box& domain) {
    const double x = between(0, domain.size_m.x()), y = between(0, domain.size_m.y());
    return domain.origin_m + Eigen::Vector3d(x, y, 0);
  }

 private:
  std::uint64_t seed_, step_ = 0;
};

TargetDensity random_target(Draw& draw, const Box& domain) {
  TargetDensity target;
  target.uniform_weight = draw.between(0, 1);
  for (int count = draw.whole(0, 4); count > 0; --count) {
    const double sigma_m = draw.between(0.03, 0.3) * domain.shortest_side_m();
    target.gaussians.push_back(
        {draw.between(0.1, 1), draw.in(domain), sigma_m * sigma_m * Eigen::Matrix3d::Identity()});
  }
  return target;
}

}  // namespace

double mean_square_bound_m2(const Mission& mission, std::size_t agent) {
  const ControlLaw& law = mission.law;
  return std::max(std::pow(start_distance_m(mission, agent), 2),
                  std::pow(reach_m(law), 2) + (mission.domain.planar() ? 2 : 3) *
                                                  law.noise_intensity * law.noise_intensity /
                                                  law.contraction_gain_per_s);
}

std::vector<std::vector<MeanSquare>> mean_squares(Mission mission, lab::Edges edges, int seeds,
                                                  int points) {
  const double end_s = static_cast<double>(mission.timing.tick_count) * mission.timing.dt_s;
  const std::size_t agents = mission.starts_m.size();
  std::vector<std::vector<MeanSquare>> result(agents, std::vector<MeanSquare>(points));
  for (int seed = 1; seed <= seeds; ++seed) {
    mission.seed = static_cast<std::uint64_t>(seed);
    lab::IdealTeam team(mission, edges);
    for (int p = 0; p < points; ++p) {
      team.run_until(end_s * (p + 1) / points);
      for (std::size_t i = 0; i < agents; ++i) {
        MeanSquare& at = result[i][p];
        const double square_m2 = (team.x_m(i) - mission.law.contraction_center_m).squaredNorm();
        const double off = square_m2 - at.mean_m2;
        at.t_s = team.t_s();
        at.mean_m2 += off / seed;
        at.standard_error_m2 += off * (square_m2 - at.mean_m2);  // the sum of squares until the end
      }
    }
  }
  for (auto& agent : result) {
    for (MeanSquare& at : agent)
      at.standard_error_m2 = std::sqrt(at.standard_error_m2 / seeds / (seeds - 1));
  }
  return result;
}

std::vector<double> shares_outside(Mission mission, int seeds) {
  const double end_s = static_cast<double>(mission.timing.tick_count) * mission.timing.dt_s;
  std::vector<double> shares(mission.starts_m.size(), 0);
  for (int seed = 1; seed <= seeds; ++seed) {
    mission.seed = static_cast<std::uint64_t>(seed);
    lab::IdealTeam team(mission, lab::Edges::kNone);
    team.run_until(end_s);
    for (std::size_t i = 0; i < team.size(); ++i) {
      if (!mission.domain.contains(team.x_m(i))) shares[i] += 1.0 / seeds;
    }
  }
  return shares;
}

Mission driven_outward(const ControlLaw& law, double dt_s, double duration_s) {
  Mission mission;
  mission.law = law;
  mission.law.epsilon = 0;
  // u points along x for as long as c_1 > −1 = μ_1 and 0 < x < Lx: the domain is wide enough for
  // both.
  const double reach =
      reach_m(law) + 20 * law.noise_intensity / std::sqrt(law.contraction_gain_per_s);
  mission.domain.size_m = {8 * reach, 8 * reach, 0};
  mission.law.contraction_center_m = {3 * reach, 4 * reach, 0};
  mission.starts_m = {mission.law.contraction_center_m};
  mission.basis.modes_x = 2;
  mission.target_coefficients = Coefficients{{1, -1}};
  mission.timing.dt_s = dt_s;
  mission.timing.tick_count = std::lround(duration_s / dt_s);
  return mission;
}

double discrete_bound_m(const Mission& mission, double start_m, Tick n) {
  const double q = 1 - mission.law.contraction_gain_per_s * mission.timing.dt_s;
  return contracted_m(mission, start_m, std::pow(q, static_cast<double>(n)));
}

double continuous_bound_m(const Mission& mission, double start_m, Tick n) {
  const double t_s = static_cast<double>(n) * mission.timing.dt_s;
  return contracted_m(mission, start_m, std::exp(-mission.law.contraction_gain_per_s * t_s));
}

Contraction contraction_of(const Mission& mission, lab::Edges edges) {
  constexpr double kUnitsPerStep = 8;
  const Eigen::Vector3d center_m = mission.law.contraction_center_m;
  lab::IdealTeam team(mission, edges);
  Contraction result;
  double largest_m = std::max(center_m.cwiseAbs().maxCoeff(), 1.0);
  while (team.tick() < mission.timing.tick_count) {
    team.step();
    for (std::size_t i = 0; i < team.size(); ++i) {
      largest_m = std::max(largest_m, team.x_m(i).cwiseAbs().maxCoeff());
      result.allowance_m = kUnitsPerStep * 0x1p-53 * largest_m * static_cast<double>(team.tick());
      const double distance_m = (team.x_m(i) - center_m).norm();
      const double bound_m = discrete_bound_m(mission, start_distance_m(mission, i), team.tick());
      const double continuous_m =
          continuous_bound_m(mission, start_distance_m(mission, i), team.tick());
      ++result.checked;
      if (distance_m > bound_m + result.allowance_m) ++result.violations;
      result.largest_share = std::max(result.largest_share, distance_m / bound_m);
      result.largest_continuous_share =
          std::max(result.largest_continuous_share, distance_m / continuous_m);
    }
  }
  return result;
}

Mission random_mission(std::uint64_t seed) {
  Draw draw(seed);
  Mission mission;
  mission.seed = seed;
  mission.domain.size_m = {draw.decades(10, 5000), draw.decades(10, 5000), 0};
  mission.domain.origin_m = {draw.between(-1000, 1000), draw.between(-1000, 1000), 0};
  mission.basis.modes_x = draw.whole(1, 12);
  mission.basis.modes_y = draw.whole(1, 12);
  mission.basis.sobolev_exponent = draw.between(0.5, 2);
  const TargetDensity target = random_target(draw, mission.domain);
  mission.target_coefficients = target_coefficients(target, mission.domain, mission.basis).values;
  mission.timing.dt_s = draw.decades(0.01, 1);
  mission.timing.tick_count = 500;
  ControlLaw& law = mission.law;
  law.u_max_mps = draw.decades(0.1, 50);
  law.regularization =
      draw.between(0, 1) < 0.5 ? Regularization::kAbsolute : Regularization::kRelative;
  law.epsilon = draw.between(0, 1) < 0.2 ? 0 : draw.decades(1e-6, 1);
  law.contraction_gain_per_s = draw.decades(1e-4, 1 / mission.timing.dt_s);
  law.contraction_center_m = draw.in(mission.domain);
  for (int agents = draw.whole(1, 6); agents > 0; --agents)
    mission.starts_m.push_back(draw.in(mission.domain));
  return mission;
}

}  // namespace ergocast::studies
