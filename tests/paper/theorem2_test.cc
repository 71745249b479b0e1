// SPDX-License-Identifier: BSD-3-Clause
// Theorem 2: under (10), E‖x − c‖² ≤ max{E‖x(0) − c‖², u_max²/k² + 2σ²/k} in two dimensions.
//
// It holds for the discrete recursion as long as k·dt ≤ 1. With q = 1 − k·dt,
//   x_{n+1} − c = q (x_n − c) + (1 − q) u_n/k + σ √dt ξ_n,
// and since ξ_n is independent of the past and ‖·‖² convex,
//   E‖x_{n+1} − c‖² ≤ q E‖x_n − c‖² + (1 − q) (u_max²/k² + 2σ²/k).
// Statements about means hold except with probability 1e-9 over the choice of seeds.
#include <gtest/gtest.h>

#include <cmath>

#include "studies/theorems/bounds.h"
#include "studies/theorems/confidence.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

using lab::Edges;
using studies::driven_outward;
using studies::mean_square_bound_m2;

ControlLaw law_of(double gain_per_s, double sigma) {
  ControlLaw law;
  law.u_max_mps = 10;
  law.contraction_gain_per_s = gain_per_s;
  law.noise_intensity = sigma;
  return law;
}

/// The paper's square with noise that is loud enough to meet its edges all the time.
Mission loud(double sigma) {
  Mission mission = shipped_mission("paper_fig2a");
  mission.law = law_of(0.05, sigma);
  mission.law.epsilon = 1e-3;
  mission.law.contraction_center_m = mission.domain.center_m();
  mission.starts_m = {mission.domain.center_m()};
  return mission;
}

/// ‖x − c‖² of the first agent at `t_s`, seed by seed.
std::vector<double> squares_m2(Mission mission, Edges edges, int seeds, double t_s) {
  std::vector<double> squares;
  for (int seed = 1; seed <= seeds; ++seed) {
    mission.seed = static_cast<std::uint64_t>(seed);
    PaperTeam team(mission, edges);
    team.run_until(t_s);
    squares.push_back((team.x_m(0) - mission.law.contraction_center_m).squaredNorm());
  }
  return squares;
}

/// An upper limit for E‖x − c‖² after a start at the centre, given draws of it.
///
/// The norm of a Gaussian vector grows, in distribution, with that of its mean. So by induction no
/// input and no reflection makes ‖x − c‖ larger, in distribution, than an input that always points
/// outward does without edges. That one is r + g at most: r = u_max/k, g the norm of a Gaussian
/// vector of variance s² each way. What lies beyond a limit therefore adds no more than a closed
/// form, and what lies below is bounded.
double upper_limit_m2(const std::vector<double>& squares, const ControlLaw& law, double dt_s) {
  const double reach_m = law.u_max_mps / law.contraction_gain_per_s;
  const double s_m = law.noise_intensity / std::sqrt(law.contraction_gain_per_s *
                                                     (2 - law.contraction_gain_per_s * dt_s));
  const double beyond_m = 7 * s_m, limit_m2 = std::pow(reach_m + beyond_m, 2);
  std::vector<double> cut = squares;
  for (double& square : cut) square = std::min(square, limit_m2);
  // (r + g)² ≤ 2r² + 2g²; g²/s² is a χ² of two degrees: P(g > b) = e^(−b²/2s²), E[g²; g > b] = (b²
  // + 2s²) P.
  const double tail_m2 =
      std::exp(-0.5 * 49) * (2 * reach_m * reach_m + 2 * (beyond_m * beyond_m + 2 * s_m * s_m));
  return studies::upper_mean(cut, limit_m2, kError) + tail_m2;
}

TEST(Theorem2, MeanSquareStaysUnderTheBoundWithAndWithoutEdges) {
  constexpr int kSeeds = 2000;
  const Mission mission = loud(200);
  for (const Edges edges : {Edges::kReflect, Edges::kNone}) {
    const auto squares = squares_m2(mission, edges, kSeeds, 30);
    EXPECT_LE(upper_limit_m2(squares, mission.law, mission.timing.dt_s),
              mean_square_bound_m2(mission, 0));
  }
}

TEST(Theorem2, ReflectionMovesNoAgentAwayFromACentreInside) {
  Mission mission = loud(200);
  for (mission.seed = 1; mission.seed <= 20; ++mission.seed) {
    PaperTeam team(mission, Edges::kNone);
    team.run_until(20, [&] {
      const Eigen::Vector3d center_m = mission.law.contraction_center_m;
      EXPECT_LE((reflect(team.x_m(0), mission.domain) - center_m).norm(),
                (team.x_m(0) - center_m).norm() + 1e-9);
    });
  }
}

// k·dt = 1 forgets the past at each step: x_{n+1} − c = u_n/k + σ√dt ξ. With ‖u‖ = u_max the square
// in units of σ²dt is a noncentral χ², whose mean is the bound.
TEST(Theorem2, BoundIsMetExactlyWhereAStepForgetsThePast) {
  constexpr int kSeeds = 20000;
  const Mission mission = driven_outward(law_of(10, 3), 0.1, 10);
  const double unit_m2 = 9 * mission.timing.dt_s;
  double sum = 0;
  for (const double square_m2 : squares_m2(mission, Edges::kNone, kSeeds, 0.3))
    sum += square_m2 / unit_m2;
  const auto limits = studies::chi_square_limits(2.0 * kSeeds, kSeeds / unit_m2, kError);
  EXPECT_GE(sum, limits.low);
  EXPECT_LE(sum, limits.high);
  EXPECT_NEAR((2 + 1 / unit_m2) * unit_m2, mean_square_bound_m2(mission, 0), 1e-12);
  EXPECT_GT(limits.low / (kSeeds * (2 + 1 / unit_m2)), 0.92)
      << "the limits are too wide to mean anything";
}

// An input in one direction uses up the first summand, and in small steps noise uses only half of
// the second: around c + u/k the square is that of u/k and a Gaussian's of variance σ²/(k(2 −
// k·dt)) each way.
TEST(Theorem2, InputInOneDirectionLeavesNoiseHalfOfItsPartInSmallSteps) {
  constexpr int kSeeds = 4000;
  const Mission mission = driven_outward(law_of(0.5, 30), 0.1, 40);
  const double unit_m2 = 900 / (0.5 * (2 - 0.5 * 0.1)), shift = 400 / unit_m2;  // ‖u/k‖² = 400 m²
  double sum = 0;
  for (const double square_m2 : squares_m2(mission, Edges::kNone, kSeeds, 40))
    sum += square_m2 / unit_m2;
  const auto limits = studies::chi_square_limits(2.0 * kSeeds, kSeeds * shift, kError);
  EXPECT_GE(sum, limits.low);
  EXPECT_LE(sum, limits.high);
  EXPECT_LT(limits.high * unit_m2 / kSeeds, 0.7 * mean_square_bound_m2(mission, 0));
}

// The basis continues as an even function beyond an edge. So without reflection an agent that noise
// frees from a corner goes into any of the four quadrants around it, and only one is the domain.
// The theorem's bound, a radius of 10 km here, does not exclude that.
TEST(Theorem2, DoesNotKeepFig2InItsDomainWithoutReflection) {
  constexpr int kSeeds = 300;
  const auto shares = studies::shares_outside(shipped_mission("paper_fig2a"), kSeeds);
  const double margin = studies::dkw_distance(kSeeds, kError);
  EXPECT_NEAR(shares[0], 0.75, margin);
  EXPECT_NEAR(shares[1], 0.5, margin);
  EXPECT_NEAR(shares[2], 0.5, margin);
  EXPECT_EQ(shares[3], 0) << "the contraction pulls it in, whatever the noise";
}

TEST(Theorem2, WithoutContractionTheSameNoiseLeavesTheBound) {
  const Mission mission = loud(200);
  Mission free = mission;
  free.law.contraction_gain_per_s = 0;
  int beyond = 0;
  for (const double square_m2 : squares_m2(free, Edges::kNone, 200, 150)) {
    if (square_m2 > mean_square_bound_m2(mission, 0)) ++beyond;
  }
  EXPECT_GT(beyond, 150);
}

}  // namespace
}  // namespace ergocast::test
