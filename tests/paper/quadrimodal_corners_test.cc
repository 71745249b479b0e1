// SPDX-License-Identifier: BSD-3-Clause
// Our recommended law, ε relative to the residual, from the starts that hold the classical law.
#include <gtest/gtest.h>

#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

std::vector<double> metrics_at(double t_s, const std::function<void(Mission&)>& change) {
  std::vector<double> metrics;
  for (std::uint64_t seed = 1; seed <= 11; ++seed) {
    Overrides overrides;
    overrides.seed = seed;
    overrides.duration_s = t_s;
    Mission mission = shipped_mission("quadrimodal_corners", overrides);
    change(mission);
    PaperTeam team(mission);
    team.run_until(t_s);
    metrics.push_back(team.metric());
  }
  return metrics;
}

TEST(QuadrimodalCorners, CoversTheTargetWithinTenMinutes) {
  const auto metrics = metrics_at(600, [](Mission&) {});
  EXPECT_LT(median(metrics), 2e-4);
  EXPECT_LT(*std::max_element(metrics.begin(), metrics.end()), 1e-3);
}

TEST(QuadrimodalCorners, GoesOnImprovingForHalfAnHour) {
  EXPECT_LT(median(metrics_at(2000, [](Mission&) {})), 2e-5);
}

// ε has the unit of B, and with these weights |B| is 1e-4 to 1e-3.
TEST(QuadrimodalCorners, ThePapersConstantsThrottleTheSameTeam) {
  const auto with_paper_constants = [](Mission& mission) {
    mission.law.regularization = Regularization::kAbsolute;
    mission.law.epsilon = 1e-3;
    mission.law.perturbation = Perturbation::kConstant;
    mission.law.noise_intensity = 1e-5;
  };
  EXPECT_GT(median(metrics_at(2000, with_paper_constants)),
            3 * median(metrics_at(2000, [](Mission&) {})));
}

}  // namespace
}  // namespace ergocast::test
