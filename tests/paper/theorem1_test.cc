// Theorem 1: with noise, an agent leaves every set that holds the classical law, almost surely.
//
// What single runs can show: no seed stays, and after one step nobody is on the set any more.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/paper_team.h"

namespace ergocast::test {
namespace {

constexpr std::uint64_t kSeeds = 200;
/// Left for good: farther than 1 % of the side.
constexpr double kEscaped_m = 20;

Mission noisy(std::uint64_t seed, std::vector<Eigen::Vector2d> starts_m) {
  Overrides overrides;
  overrides.seed = seed;
  Mission mission = shipped_mission("quadrimodal_corners", overrides);
  mission.starts_m = std::move(starts_m);
  return mission;
}

TEST(Theorem1, OneStepLeavesCornersMidlinesAndDiagonals) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    PaperTeam team(noisy(seed, {{0, 0}, {1000, 300}, {600, 600}}));
    team.step();
    EXPECT_GT(team.x_m(0).minCoeff(), 0) << "seed " << seed;
    EXPECT_NE(team.x_m(1).x(), 1000) << "seed " << seed;
    EXPECT_NE(team.x_m(2).x(), team.x_m(2).y()) << "seed " << seed;
  }
}

TEST(Theorem1, EveryAgentEscapesFromEveryCorner) {
  for (std::uint64_t seed = 1; seed <= kSeeds / 4; ++seed) {
    PaperTeam team(noisy(seed, {{0, 0}, {2000, 0}, {0, 2000}, {2000, 2000}}));
    std::vector<bool> escaped(team.size(), false);
    team.run_until(120, [&] {
      for (std::size_t i = 0; i < team.size(); ++i) {
        const Eigen::Vector2d from_edge_m =
            team.x_m(i).cwiseMin(team.mission().domain.size_m - team.x_m(i));
        if (from_edge_m.minCoeff() > kEscaped_m) escaped[i] = true;
      }
    });
    EXPECT_EQ(std::count(escaped.begin(), escaped.end(), true), 4) << "seed " << seed;
  }
}

TEST(Theorem1, WithoutNoiseTheSameTeamStaysAtTheOrigin) {
  Mission mission = noisy(1, {{0, 0}});
  mission.law.perturbation = Perturbation::kConstant;
  mission.law.noise_intensity = 0;
  mission.law.contraction_gain_per_s = 0;
  PaperTeam team(mission);
  team.run_until(120);
  EXPECT_EQ(team.x_m(0), Eigen::Vector2d(0, 0));
}

}  // namespace
}  // namespace ergocast::test
