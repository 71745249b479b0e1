// SPDX-License-Identifier: BSD-3-Clause
// How low φ² could be if one planner knew the whole mission in advance, for docs/law.md.
//
//   minimise φ²(T) over all velocities ‖v_i(t)‖ ≤ u_max,   x_i(0) given
//
// by Adam with the exact gradient. The results are local optima, from a run of the default law and
// from random paths. They are no bound. They are no law either, because each velocity depends on
// the whole future. Outside the domain f continues evenly, so a path that leaves the domain covers
// the same as its reflection.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "core/base/noise.h"
#include "core/basis/basis.h"
#include "lab/ideal_team.h"
#include "report/statistics.h"
#include "scenario/scenario.h"

namespace ergocast::studies {
namespace {

/// Ten metres of path: a 25th of the shortest wave of 16 modes.
constexpr const char* kStep_s = "0.5";
constexpr int kIterations = 1000;

/// 2 × N for each tick: velocities, or derivatives by them.
using Paths = std::vector<Eigen::Matrix2Xd>;

Mission mission_of(const char* file, const char* duration_s, int seed) {
  Overrides overrides;
  overrides.seed = static_cast<std::uint64_t>(seed);
  overrides.duration_s = std::stod(duration_s);
  overrides.fields = {{"time.dt_s", kStep_s, "--step"}};
  auto loaded = Scenario::load(file, overrides);
  if (!loaded) throw std::runtime_error(to_string(loaded.error().front()));
  return loaded->mission();
}

/// φ²(T), and its derivative by every velocity.
class Whole {
 public:
  explicit Whole(const Mission& mission)
      : mission_(mission), weights_(sobolev_weights(mission.basis, mission.domain)) {}

  double operator()(const Paths& velocities, Paths& slope) const {
    const double dt_s = mission_.timing.dt_s;
    std::vector<BasisAt> places;
    Coefficients coverage = Coefficients::Zero(mission_.basis.mode_count());
    std::vector<Eigen::Vector3d> x_m = mission_.starts_m;
    const double share = 1.0 / static_cast<double>(velocities.size() * x_m.size());
    places.reserve(velocities.size() * x_m.size());
    for (const Eigen::Matrix2Xd& v_mps : velocities) {
      for (std::size_t i = 0; i < x_m.size(); ++i) {
        places.emplace_back(x_m[i], mission_.domain, mission_.basis);
        accumulate_basis(places.back(), mission_.basis, share, coverage.data());
        x_m[i].head<2>() += v_mps.col(static_cast<Eigen::Index>(i)) * dt_s;
      }
    }
    const Coefficients residual = weights_.cwiseProduct(coverage - mission_.target_coefficients);
    // A velocity moves all later places.
    Eigen::Matrix2Xd later = Eigen::Matrix2Xd::Zero(2, static_cast<Eigen::Index>(x_m.size()));
    for (std::size_t t = velocities.size(); t-- > 0;) {
      slope[t] = later;
      for (std::size_t i = 0; i < x_m.size(); ++i) {
        later.col(static_cast<Eigen::Index>(i)) +=
            2 * share * dt_s *
            weighted_gradient(places[t * x_m.size() + i], mission_.basis, residual.data())
                .head<2>();
      }
    }
    return ergodic_metric(coverage, mission_.target_coefficients, weights_);
  }

 private:
  Mission mission_;
  Coefficients weights_;
};

void limit(Paths& velocities, double u_max_mps) {
  for (Eigen::Matrix2Xd& v_mps : velocities) {
    for (auto v : v_mps.colwise()) v *= std::min(1.0, u_max_mps / std::max(v.norm(), 1e-300));
  }
}

/// The least φ²(T) of a descent from `velocities`; the steps shrink to 0.
double descend(const Mission& mission, Paths velocities) {
  const Whole whole(mission);
  limit(velocities, mission.law.u_max_mps);
  Paths slope = velocities;
  for (auto& s : slope) s.setZero();
  Paths mean = slope, square = slope;
  double least = whole(velocities, slope);
  double forgotten_mean = 1, forgotten_square = 1;
  for (int i = 0; i < kIterations; ++i) {
    const double rate_mps =
        0.02 * mission.law.u_max_mps * (1 - i / static_cast<double>(kIterations));
    forgotten_mean *= 0.9;
    forgotten_square *= 0.99;
    for (std::size_t t = 0; t < velocities.size(); ++t) {
      mean[t] = 0.9 * mean[t] + 0.1 * slope[t];
      square[t] = 0.99 * square[t] + 0.01 * slope[t].cwiseAbs2();
      velocities[t].array() -= rate_mps * (mean[t].array() / (1 - forgotten_mean)) /
                               ((square[t].array() / (1 - forgotten_square)).sqrt() + 1e-300);
    }
    limit(velocities, mission.law.u_max_mps);
    least = std::min(least, whole(velocities, slope));
  }
  return least;
}

/// The velocities of the law, and its φ²(T).
std::pair<Paths, double> velocities_of_the_law(const Mission& mission) {
  lab::IdealTeam team(mission);
  Paths velocities;
  const auto record = [&] {
    Eigen::Matrix2Xd& v_mps = velocities.emplace_back(2, static_cast<Eigen::Index>(team.size()));
    for (std::size_t i = 0; i < team.size(); ++i)
      v_mps.col(static_cast<Eigen::Index>(i)) = team.v_mps(i).head<2>();
  };
  team.run_until(static_cast<double>(mission.timing.tick_count) * mission.timing.dt_s, record);
  return {velocities, team.metric()};
}

/// Another velocity for each agent every L / u_max / 10.
Paths random_velocities(const Mission& mission) {
  const double held_s = mission.domain.shortest_side_m() / mission.law.u_max_mps / 10;
  const auto held = std::max<Tick>(1, std::llround(held_s / mission.timing.dt_s));
  const auto agents = static_cast<Eigen::Index>(mission.starts_m.size());
  Paths velocities;
  for (Tick t = 0; t < mission.timing.tick_count; ++t) {
    Eigen::Matrix2Xd& v_mps = velocities.emplace_back(2, agents);
    for (Eigen::Index i = 0; i < agents; ++i) {
      v_mps.col(i) = mission.law.u_max_mps * normal_pair(mission.seed, Purpose::kPush,
                                                         static_cast<std::uint32_t>(i),
                                                         static_cast<std::uint64_t>(t / held));
    }
  }
  limit(velocities, mission.law.u_max_mps);
  return velocities;
}

std::string spread(const std::vector<double>& values) {
  const Estimate mean = ratio_of(values, std::vector<double>(values.size(), 1.0));
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  char line[96];
  std::snprintf(line, sizeof line, "%.2e (%.2e to %.2e), %.1e to %.1e", mean.value, mean.low,
                mean.high, *low, *high);
  return line;
}

void run(const char* file, const char* duration_s, int starts) {
  std::vector<double> law, from_law, from_random;
  for (int seed = 1; seed <= starts; ++seed) {
    const Mission mission = mission_of(file, duration_s, seed);
    const auto [velocities, metric] = velocities_of_the_law(mission);
    law.push_back(metric);
    from_law.push_back(descend(mission, velocities));
    from_random.push_back(descend(mission, random_velocities(mission)));
    std::fprintf(stderr, "optimum %s s, seed %d: %.2e %.2e %.2e\n", duration_s, seed, law.back(),
                 from_law.back(), from_random.back());
  }
  std::printf("| %s | %d | %s | %s | %s |\n", duration_s, starts, spread(law).c_str(),
              spread(from_law).c_str(), spread(from_random).c_str());
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: studies-law-optimum SCENARIO SECONDS STARTS\n");
    return 2;
  }
  try {
    std::printf(
        "| T [s] | starts | the default: φ²(T), mean (95 %%), range | local optima from its flight "
        "| local optima from random "
        "flights |\n|---|---|---|---|---|\n");
    ergocast::studies::run(argv[1], argv[2], std::stoi(argv[3]));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-law-optimum: %s\n", error.what());
    return 2;
  }
}
