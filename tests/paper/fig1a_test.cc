// SPDX-License-Identifier: BSD-3-Clause
// Fig. 1(a): the classical law (5) from the four corners is caught by the target's symmetry.
//
// In exact arithmetic no agent would move. Three of the four do, because sin(mπ) is not zero in
// floating point; their motion is what the figure shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

class Fig1a : public ::testing::Test {
 protected:
  PaperTeam team_{shipped_mission("paper_fig1a")};
};

TEST_F(Fig1a, AgentAtTheOriginNeverMovesAtAll) {
  team_.run_until(150, [this] {
    ASSERT_EQ(team_.x_m(0), Eigen::Vector3d(0, 0, 0));
    ASSERT_EQ(team_.v_mps(0), Eigen::Vector3d(0, 0, 0));
  });
}

TEST_F(Fig1a, AgentsOnTheEdgesStayOnThemAndEndNearTheFirstPeak) {
  team_.run_until(150, [this] {
    ASSERT_EQ(team_.x_m(1).y(), 0);
    ASSERT_EQ(team_.x_m(2).x(), 0);
  });
  for (const double end_m : {team_.x_m(1).x(), team_.x_m(2).y()}) {
    EXPECT_GT(end_m, 600);
    EXPECT_LT(end_m, 850);
  }
}

TEST_F(Fig1a, AgentAtTheFarCornerRunsDownTheDiagonalToItsPeak) {
  double farthest_off_m = 0;
  team_.run_until(70, [this, &farthest_off_m] {
    const Eigen::Vector3d x_m = team_.x_m(3);
    farthest_off_m = std::max(farthest_off_m, std::abs(x_m.x() - x_m.y()));
  });
  EXPECT_LT(farthest_off_m, 1e-6);
  team_.run_until(150);
  EXPECT_LT((team_.x_m(3) - Eigen::Vector3d(1450, 1450, 0)).norm(), 200);
}

// Remark 1 says that such agents end in "only minute oscillations". They keep to their edge for
// ever, but on it they come to rest only now and then.
TEST_F(Fig1a, AgentsOnTheEdgesAlternateBetweenChatteringAndRunsOfHundredMetres) {
  constexpr Tick kWindowTicks = 100;  // 10 s
  int chattering = 0, running = 0;
  double low_m = 2000, high_m = 0;
  team_.run_until(150);
  team_.run_until(1500, [&] {
    ASSERT_EQ(team_.x_m(1).y(), 0);
    low_m = std::min(low_m, team_.x_m(1).x());
    high_m = std::max(high_m, team_.x_m(1).x());
    if (team_.tick() % kWindowTicks != 0) return;
    if (high_m - low_m < 5) ++chattering;
    if (high_m - low_m > 50) ++running;
    low_m = 2000, high_m = 0;
  });
  // 135 windows; which of them are quiet follows from rounding.
  EXPECT_GT(chattering, 10);
  EXPECT_GT(running, 10);
}

TEST_F(Fig1a, CoverageStaysPoor) {
  team_.run_until(150);
  EXPECT_NEAR(team_.metric(), 0.61, 0.02);
}

}  // namespace
}  // namespace ergocast::test
