// SPDX-License-Identifier: BSD-3-Clause
// The law that scenarios get by default, from the starts that hold the classical one
// (studies/law/*.textproto). Statements about probabilities hold except with probability 1e-9
// over the choice of seeds; docs/law.md has the figures of many more.
#include <gtest/gtest.h>

#include <cmath>

#include "core/law/perturbation.h"
#include "lab/manifolds.h"
#include "studies/theorems/confidence.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

Mission mission_from(const std::string& start, std::uint64_t seed = 1) {
  const auto file =
      std::filesystem::path(ERGOCAST_SOURCE_DIR) / "studies/law" / (start + ".textproto");
  Overrides overrides;
  overrides.seed = seed;
  return Scenario::load(file, overrides).value().mission();
}

/// When the last of a team has left the set it starts on; infinite if that is not before `limit_s`.
double last_escape_s(const Mission& mission, double limit_s) {
  PaperTeam team(mission);
  std::vector<lab::Manifold> held_by;
  for (std::size_t i = 0; i < team.size(); ++i) {
    held_by.push_back(lab::manifold_at(team.x_m(i), mission.domain).value());
  }
  std::vector<bool> free(team.size(), false);
  while (team.t_s() < limit_s) {
    team.step();
    for (std::size_t i = 0; i < team.size(); ++i) {
      if (held_by[i].distance_m(team.x_m(i)) > lab::escape_distance_m(mission.domain))
        free[i] = true;
    }
    if (std::count(free.begin(), free.end(), true) == static_cast<std::ptrdiff_t>(team.size())) {
      return team.t_s();
    }
  }
  return std::numeric_limits<double>::infinity();
}

class DefaultLaw : public ::testing::TestWithParam<const char*> {};

TEST_P(DefaultLaw, FreesEveryAgentWithinAMinute) {
  constexpr std::size_t kSeeds = 600;
  std::size_t within_15_s = 0;
  Mission mission = mission_from(GetParam());
  for (mission.seed = 1; mission.seed <= kSeeds; ++mission.seed) {
    const double time_s = last_escape_s(mission, 60);
    ASSERT_LE(time_s, 60) << "seed " << mission.seed;
    if (time_s <= 15) ++within_15_s;
  }
  EXPECT_GT(studies::least_probability(kSeeds, kError), 0.96)
      << "of a team that all leave within 60 s";
  EXPECT_GT(static_cast<double>(within_15_s) / kSeeds - studies::dkw_distance(kSeeds, kError), 0.8)
      << "of a team that all leave within 15 s";
}

TEST_P(DefaultLaw, CoversBetterThanTheClassicalLawFromRandomStarts) {
  constexpr std::uint64_t kSeeds = 9;
  std::vector<double> ours, classical;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    PaperTeam team(mission_from(GetParam(), seed));
    team.run_until(1000);
    ours.push_back(team.metric());
    Mission mission = mission_from("random", seed);
    mission.law = {.u_max_mps = mission.law.u_max_mps};
    PaperTeam other(mission);
    other.run_until(1000);
    classical.push_back(other.metric());
  }
  EXPECT_LT(median(ours), median(classical));
}

INSTANTIATE_TEST_SUITE_P(From, DefaultLaw,
                         ::testing::Values("corners", "midline", "diagonal", "axis", "center"),
                         [](const auto& test) { return std::string(test.param); });

TEST(DefaultLawBound, HoldsTheMeanSquareWithAStrongContraction) {
  // E‖x − c‖² ≤ w²/k² + 2σ²/k with w = u_max + √2 · push, for a start at the centre.
  Mission mission = mission_from("center");
  ControlLaw& law = mission.law;
  law.contraction_gain_per_s = 0.2;
  constexpr int kSeeds = 400;
  const double push_mps = greatest_push_mps(law, mission.timing.dt_s);
  const double w_mps = law.u_max_mps + std::sqrt(2) * push_mps, k = law.contraction_gain_per_s;
  const double bound_m2 =
      w_mps * w_mps / (k * k) + 2 * law.noise_intensity * law.noise_intensity / k;
  double mean_m2 = 0;
  for (mission.seed = 1; mission.seed <= kSeeds; ++mission.seed) {
    PaperTeam team(mission, lab::Edges::kNone);
    team.run_until(40);
    mean_m2 += (team.x_m(0) - law.contraction_center_m).squaredNorm() / kSeeds;
  }
  EXPECT_LT(mean_m2, bound_m2);
  // The bound is also close: less than ten times the value reached.
  EXPECT_GT(mean_m2, 0.1 * bound_m2);
}

}  // namespace
}  // namespace ergocast::test
