// SPDX-License-Identifier: BSD-3-Clause
// Proposition 1: under the classical law (5) corners, axes, midlines and diagonals are invariant.
//
// Its premises are more than the target's symmetry: on midlines and diagonals the team has to be
// symmetric as well, because c_k is the whole team's; diagonals need a square, and a target with
// ρ(x, y) = ρ(y, x), which symmetry about the midlines does not give. On the edges
// x = 0 and y = 0 every sine is exactly 0, so nothing is needed at all. Everywhere else B·n is what
// rounding leaves of 0, and (5) divides by ‖B‖: in the end rounding drives agents off.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/manifolds.h"
#include "studies/theorems/escape.h"
#include "studies/theorems/invariance.h"
#include "target/target.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

using studies::InvariantSet;
using studies::normal_residual;

constexpr std::uint64_t kPlaces = 300;

/// The quadrimodal square of Fig. 1 under the classical law, with other starts.
Mission classical(std::vector<Eigen::Vector3d> starts_m) {
  Mission mission = shipped_mission("paper_fig1a");
  mission.starts_m = std::move(starts_m);
  return mission;
}

const InvariantSet& set_named(const std::string& name) {
  const auto sets = studies::invariant_sets();
  return *std::find_if(sets.begin(), sets.end(),
                       [&name](const InvariantSet& set) { return set.name == name; });
}

std::vector<std::string> names(bool symmetric_team) {
  std::vector<std::string> names;
  for (const InvariantSet& set : studies::invariant_sets()) {
    if (set.symmetric_team == symmetric_team) names.push_back(set.name);
  }
  return names;
}

class OnASet : public ::testing::TestWithParam<std::string> {
 protected:
  Mission mission(std::uint64_t seed) const {
    return studies::classical(set_named(GetParam()), shipped_mission("paper_fig1a"), seed);
  }
};
std::string letters(const ::testing::TestParamInfo<std::string>& set) {
  std::string name = set.param;
  std::erase(name, '-');
  return name;
}

class Premises : public OnASet {};
TEST_P(Premises, LeaveOfTheNormalPartOfBNoMoreThanRounding) {
  // sin(mπ) is m times that of π's rounding, 1.1 units: 16 for the 14th mode, and less in the mean
  // of all.
  constexpr double kUnits = 16;
  for (std::uint64_t seed = 1; seed <= kPlaces; ++seed) {
    EXPECT_LE(normal_residual(mission(seed)).units, kUnits) << "place " << seed;
  }
}
INSTANTIATE_TEST_SUITE_P(Proposition1, Premises, ::testing::ValuesIn(names(true)), letters);

class WithoutPremises : public OnASet {};
TEST_P(WithoutPremises, TheNormalPartOfBIsAnything) {
  std::vector<double> shares;
  for (std::uint64_t seed = 1; seed <= kPlaces; ++seed)
    shares.push_back(normal_residual(mission(seed)).share_of_b);
  EXPECT_GT(median(shares), 0.01);
}
INSTANTIATE_TEST_SUITE_P(Proposition1, WithoutPremises, ::testing::ValuesIn(names(false)), letters);

class ExactSet : public OnASet {};
TEST_P(ExactSet, HoldsAnAgentForTenMinutes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Mission there = mission(seed);
    const auto set = lab::manifold_at(there.starts_m.front(), there.domain);
    PaperTeam team(there);
    team.run_until(600, [&] { ASSERT_EQ(set->distance_m(team.x_m(0)), 0) << "place " << seed; });
  }
}
INSTANTIATE_TEST_SUITE_P(Proposition1, ExactSet, ::testing::Values("origin", "axis-x", "axis-y"),
                         letters);

class InexactSet : public OnASet {};
TEST_P(InexactSet, LosesEveryAgentToRoundingWithinTenMinutes) {
  const double far_m = lab::escape_distance_m(mission(1).domain);
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto left_s = studies::escape_time_s(mission(seed), far_m, 600);
    ASSERT_TRUE(left_s.has_value()) << "place " << seed;
    // At the far corner all of B is rounding, and (5) makes it as long as u_max at once.
    if (GetParam() == "far-corner") {
      EXPECT_LT(*left_s, 3);
    } else {
      EXPECT_GT(*left_s, 30) << "place " << seed;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Proposition1, InexactSet,
                         ::testing::Values("far-corner", "far-edge-x", "midline-x", "diagonal"),
                         letters);

TEST(Proposition1, SinesOfMultiplesOfPiAreWhatMovesTheFarCorners) {
  const Mission mission = classical({{2000, 2000, 0}});
  const BasisAt far(mission.starts_m[0], mission.domain, mission.basis);
  const BasisAt origin({0, 0, 0}, mission.domain, mission.basis);
  for (int m = 1; m < mission.basis.modes_x; ++m) {
    const double wave = m * std::numbers::pi / 2000;
    EXPECT_EQ(origin.slope_x[m], 0);
    EXPECT_NE(far.slope_x[m], 0);
    EXPECT_LT(std::abs(far.slope_x[m]), wave * 2e-16 * m);
  }
}

TEST(Proposition1, LowerAndLeftEdgeHoldAnyTeamExactly) {
  PaperTeam team(classical({{700, 0, 0}, {0, 1234.5, 0}, {321, 1777, 0}}));
  team.run_until(30, [&team] {
    ASSERT_EQ(team.b(0).y(), 0);
    ASSERT_EQ(team.x_m(0).y(), 0);
    ASSERT_EQ(team.b(1).x(), 0);
    ASSERT_EQ(team.x_m(1).x(), 0);
  });
}

TEST(Proposition1, OriginIsAnEquilibriumOfAnyTeam) {
  PaperTeam team(classical({{0, 0, 0}, {321, 1777, 0}}));
  team.run_until(30, [&team] {
    ASSERT_EQ(team.b(0), Eigen::Vector3d(0, 0, 0));
    ASSERT_EQ(team.x_m(0), Eigen::Vector3d(0, 0, 0));
  });
}

TEST(Proposition1, DiagonalsNeedATargetThatIsTheSameWithXAndYExchanged) {
  // Two peaks on the midline y = 1000: symmetric about both midlines, but not about a diagonal.
  Mission mission = classical({{300, 300, 0}});
  TargetDensity two_peaks;
  const Eigen::Matrix3d covariance_m2 = 1e4 * Eigen::Matrix3d::Identity();
  two_peaks.gaussians = {{1, {500, 1000, 0}, covariance_m2}, {1, {1500, 1000, 0}, covariance_m2}};
  mission.target_coefficients =
      target_coefficients(two_peaks, mission.domain, mission.basis).values;
  PaperTeam team(mission);
  team.step();
  const Eigen::Vector3d normal = Eigen::Vector3d(1, -1, 0).normalized();
  EXPECT_GT(std::abs(team.b(0).dot(normal)), 0.01 * team.b(0).norm());
  team.run_until(60);
  EXPECT_GT(std::abs((team.x_m(0) - Eigen::Vector3d(300, 300, 0)).dot(normal)), 100);
}

TEST(Proposition1, DiagonalsNeedASquare) {
  Mission mission = classical({{200, 100, 0}});
  mission.domain.size_m = {2000, 1000, 0};
  PaperTeam team(mission);
  team.step();
  // On the diagonal of a rectangle B does not point along it.
  const Eigen::Vector3d normal = Eigen::Vector3d(1, -2, 0).normalized();
  EXPECT_GT(std::abs(team.b(0).dot(normal)), 1e-3 * team.b(0).norm());
}

}  // namespace
}  // namespace ergocast::test
