// SPDX-License-Identifier: BSD-3-Clause
// The classical law on a uniform unit square, in the conventions of Mathew & Mezić, against numbers
// published for another implementation: φ² at 200 s of 2.6e-5, 5.0e-6 and 1.3e-6 for 1, 4 and 16
// agents, falling like t^−1.97, t^−1.92 and t^−2.07 over 10…200 s, one seed of random starts each.
#include <gtest/gtest.h>

#include <cmath>

#include "logger/slope.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

struct Outcome {
  double metric, slope;
};

Outcome outcome(int agents, std::uint64_t seed) {
  Overrides overrides;
  overrides.agents = agents;
  overrides.seed = seed;
  PaperTeam team(shipped_mission("uniform_square", overrides));
  std::vector<double> t_s, metric;
  while (team.t_s() < 200 - 1e-9) {
    team.run_until(team.t_s() + 1);
    t_s.push_back(team.t_s());
    metric.push_back(team.metric());
  }
  return {metric.back(), log_log_slope(t_s, metric).value()};
}

/// One run meanders by a factor of two about its own trend, so medians are compared.
void expect_like(int agents, std::uint64_t seeds, double published_metric) {
  std::vector<double> metrics, slopes;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Outcome one = outcome(agents, seed);
    metrics.push_back(one.metric);
    slopes.push_back(one.slope);
  }
  EXPECT_LT(std::abs(std::log(median(metrics) / published_metric)), std::log(2.5))
      << "median " << median(metrics);
  EXPECT_NEAR(median(slopes), -2, 0.3);
}

TEST(UniformSquare, OneAgentFallsAsPublished) { expect_like(1, 7, 2.6e-5); }
TEST(UniformSquare, FourAgentsFallAsPublished) { expect_like(4, 5, 5.0e-6); }
TEST(UniformSquare, SixteenAgentsFallAsPublished) { expect_like(16, 3, 1.3e-6); }

}  // namespace
}  // namespace ergocast::test
