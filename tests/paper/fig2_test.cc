// SPDX-License-Identifier: BSD-3-Clause
// Fig. 2: the law (8) with the dynamics (10), ε = 1e-3, σ = 1e-5, k = 1e-3 about the origin, leaves
// what holds the classical law. Medians over seeds, since the noise decides how soon.
#include <gtest/gtest.h>

#include "tests/support/paper_team.h"

namespace ergocast::test {
namespace {

constexpr std::uint64_t kSeeds = 100;

/// The teams at 150 s, one per seed.
std::vector<PaperTeam> teams_at_the_end(const std::string& scenario) {
  std::vector<PaperTeam> teams;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Overrides overrides;
    overrides.seed = seed;
    teams.emplace_back(shipped_mission(scenario, overrides));
    teams.back().run_until(150);
  }
  return teams;
}

double median_of(const std::vector<PaperTeam>& teams, double (*value)(const PaperTeam&)) {
  std::vector<double> values;
  for (const PaperTeam& team : teams) values.push_back(value(team));
  return median(std::move(values));
}

TEST(Fig2a, AgentsLeaveTheCornersAndCoverTheTargetBetter) {
  const auto teams = teams_at_the_end("paper_fig2a");
  const double from_origin_m =
      median_of(teams, [](const PaperTeam& team) { return team.x_m(0).norm(); });
  EXPECT_GT(from_origin_m, 740);
  EXPECT_LT(from_origin_m, 797);
  const double off_lower_edge_m =
      median_of(teams, [](const PaperTeam& team) { return team.x_m(1).y(); });
  const double off_left_edge_m =
      median_of(teams, [](const PaperTeam& team) { return team.x_m(2).x(); });
  EXPECT_NEAR(off_lower_edge_m, 115, 40);
  EXPECT_NEAR(off_left_edge_m, 115, 40);
  const double metric = median_of(teams, [](const PaperTeam& team) { return team.metric(); });
  EXPECT_GT(metric, 0.257);
  EXPECT_LT(metric, 0.310);
}

TEST(Fig2a, NoAgentIsStillOnItsEdge) {
  for (const PaperTeam& team : teams_at_the_end("paper_fig2a")) {
    EXPECT_GT(team.x_m(0).head<2>().minCoeff(), 1);
    EXPECT_GT(team.x_m(1).y(), 0.01);
    EXPECT_GT(team.x_m(2).x(), 0.01);
  }
}

TEST(Fig2b, ContractionToTheOriginBreaksTheMidlineWhateverTheNoise) {
  const auto teams = teams_at_the_end("paper_fig2b");
  for (const PaperTeam& team : teams) {
    for (std::size_t i = 0; i < team.size(); ++i) {
      const double off_m = std::abs(team.x_m(i).y() - 1000);
      EXPECT_GT(off_m, 590) << "agent " << i;
      EXPECT_LT(off_m, 690) << "agent " << i;
      EXPECT_NEAR(team.x_m(i).y(), teams.front().x_m(i).y(), 0.02) << "agent " << i;
    }
    EXPECT_NEAR(team.metric(), 0.2976, 5e-4);
  }
}

}  // namespace
}  // namespace ergocast::test
