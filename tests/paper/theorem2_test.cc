// Theorem 2: under (10), E‖x − c‖² ≤ max{E‖x(0) − c‖², u_max²/k² + 2σ²/k} in two dimensions,
// and it holds for the discrete recursion as well as long as k·dt ≤ 1.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/paper_team.h"

namespace ergocast::test {
namespace {

constexpr std::uint64_t kSeeds = 200;

/// A contraction and a noise strong enough that the bound is near: a plane so wide that the edges,
/// which only help, are far away.
Mission wide(std::uint64_t seed) {
  Overrides overrides;
  overrides.seed = seed;
  Mission mission = shipped_mission("paper_fig2a", overrides);
  mission.domain.size_m = {20000, 20000};
  mission.law.u_max_mps = 10;
  mission.law.noise_intensity = 30;
  mission.law.contraction_gain_per_s = 0.05;
  mission.law.contraction_center_m = {10000, 10000};
  mission.starts_m = {{10000, 10000}, {10100, 10000}};
  return mission;
}

TEST(Theorem2, MeanSquareDistanceStaysUnderTheBound) {
  const Mission mission = wide(1);
  const ControlLaw& law = mission.law;
  const double k = law.contraction_gain_per_s;
  const double bound_m2 = std::pow(law.u_max_mps / k, 2) +
                          2 * law.noise_intensity * law.noise_intensity / k;
  std::vector<double> mean_square_m2(150, 0);
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    PaperTeam team(wide(seed));
    for (double& mean : mean_square_m2) {
      team.run_until(team.t_s() + 1);
      for (std::size_t i = 0; i < team.size(); ++i) {
        mean += (team.x_m(i) - law.contraction_center_m).squaredNorm() /
                static_cast<double>(kSeeds * team.size());
      }
    }
  }
  for (const double mean_m2 : mean_square_m2) EXPECT_LE(mean_m2, bound_m2);
  // Not a bound that anything would meet: the noise alone takes up dσ²/(2k) of it.
  const double noise_alone_m2 = law.noise_intensity * law.noise_intensity / k;
  EXPECT_GT(mean_square_m2.back(), 0.8 * noise_alone_m2);
}

TEST(Theorem2, WithoutContractionTheSameTeamLeavesIt) {
  const double bound_m2 = std::pow(10 / 0.05, 2) + 2 * 30 * 30 / 0.05;
  double mean_square_m2 = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Mission mission = wide(seed);
    mission.law.contraction_gain_per_s = 0;
    PaperTeam team(mission);
    team.run_until(150);
    mean_square_m2 += (team.x_m(0) - mission.law.contraction_center_m).squaredNorm() / 20;
  }
  EXPECT_GT(mean_square_m2, bound_m2);
}

}  // namespace
}  // namespace ergocast::test
