// SPDX-License-Identifier: BSD-3-Clause
// The linearised recursion against the method itself, noise for noise.
#include "studies/theorems/linearised.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lab/ideal_team.h"
#include "lab/manifolds.h"
#include "studies/theorems/escape.h"
#include "tests/support/simulated_team.h"

namespace ergocast::studies {
namespace {

constexpr double kSigma = 1e-5;
constexpr Tick kSteps = 1000;

Mission noisy(const Start& start, std::uint64_t seed) {
  Overrides overrides;
  overrides.seed = seed;
  Mission mission = from(start, test::shipped_mission("paper_fig2a", overrides));
  mission.law.noise_intensity = kSigma;
  return mission;
}

double off_set(const Mission& mission, const Eigen::Vector3d& x_m) {
  return (x_m - mission.starts_m.front()).head<2>().dot(normal_of(mission).direction);
}

class FromEverySet : public ::testing::TestWithParam<int> {
 protected:
  const Start& start() const { return starts()[static_cast<std::size_t>(GetParam())]; }
};

TEST_P(FromEverySet, FollowsTheMethodAsLongAsTheDeviationIsSmall) {
  constexpr double kSmall_m = 0.05;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Mission mission = noisy(start(), seed);
    const auto set = lab::manifold_at(start().x_m, mission.domain);
    const auto steps = linearised(mission, kSteps);
    const bool edge = steps.front().slopes.isZero(0);
    const std::vector<double> predicted = deviation(steps, mission);
    // An edge mirrors an agent that crosses it; without one f and B continue as even and odd
    // functions.
    lab::IdealTeam team(mission, edge ? lab::Edges::kNone : lab::Edges::kReflect);
    double largest_m = 0;
    while (team.tick() < kSteps && largest_m < kSmall_m) {
      team.step();
      const double off_m = off_set(mission, team.x_m(0));
      largest_m = std::max(largest_m, set->distance_m(team.x_m(0)));
      // The noise moves the agent along the set as well, by 1e-4 m in 100 s, and the rates with it.
      ASSERT_NEAR(off_m, predicted[static_cast<std::size_t>(team.tick())], 3e-3 * largest_m)
          << start().name << ", seed " << seed << ", tick " << team.tick();
    }
    EXPECT_GT(largest_m, 10 * kSigma);
  }
}

TEST_P(FromEverySet, SpreadIsTheStandardDeviationOfTheRecursion) {
  constexpr std::uint64_t kSeeds = 1000;
  constexpr Tick kFew = 200;
  Mission mission = noisy(start(), 1);
  const auto steps = linearised(mission, kFew);
  const double predicted_m = kSigma * spread(steps, mission, Past::kCounted).back();
  double sum_m2 = 0;
  for (mission.seed = 1; mission.seed <= kSeeds; ++mission.seed) {
    sum_m2 += std::pow(deviation(steps, mission).back(), 2);
  }
  // Five standard deviations of a variance over 1000 draws.
  EXPECT_NEAR(sum_m2 / kSeeds / (predicted_m * predicted_m), 1, 5 * std::sqrt(2.0 / kSeeds));
}

INSTANTIATE_TEST_SUITE_P(Linearised, FromEverySet, ::testing::Range(0, 7), [](const auto& set) {
  std::string name = starts()[static_cast<std::size_t>(set.param)].name;
  std::erase(name, '-');
  return name;
});

TEST(Linearised, ThePastCountsOnMidlinesAndDiagonalsAndNotOnEdges) {
  for (const Start& start : starts()) {
    const Mission mission = noisy(start, 1);
    const auto steps = linearised(mission, kSteps);
    const double counted = spread(steps, mission, Past::kCounted).back();
    const double neglected = spread(steps, mission, Past::kNeglected).back();
    if (steps.front().slopes.isZero(0)) {
      EXPECT_EQ(counted, neglected) << start.name;
    } else {
      EXPECT_LT(counted, 0.05 * neglected) << start.name;
    }
  }
}

}  // namespace
}  // namespace ergocast::studies
