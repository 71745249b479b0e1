// SPDX-License-Identifier: BSD-3-Clause
// Fig. 1(b): the classical law (5) from the horizontal midline, y = 1000.
//
// Rounding errors decide the side on which an agent leaves the midline; both are accepted.
#include <gtest/gtest.h>

#include <optional>

#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

constexpr double kMidline_m = 1000;

/// Where each agent was when it was first `distance_m` off the midline.
std::vector<std::optional<Eigen::Vector3d>> departures(PaperTeam& team, double distance_m) {
  std::vector<std::optional<Eigen::Vector3d>> found(team.size());
  team.run_until(150, [&] {
    for (std::size_t i = 0; i < team.size(); ++i) {
      const bool off = std::abs(team.x_m(i).y() - kMidline_m) > distance_m;
      if (off && !found[i]) found[i] = team.x_m(i);
    }
  });
  return found;
}

TEST(Fig1b, RightMostAgentRunsAlongTheMidlineToTheEdgeAndTurnsBack) {
  PaperTeam team(shipped_mission("paper_fig1b"));
  double farthest_m = 0, reached_at_s = 0;
  team.run_until(75, [&] {
    if (team.x_m(2).x() <= farthest_m) return;
    farthest_m = team.x_m(2).x();
    reached_at_s = team.t_s();
    ASSERT_NEAR(team.x_m(2).y(), kMidline_m, 1e-3) << "at " << reached_at_s << " s";
  });
  EXPECT_NEAR(farthest_m, 1988, 5);
  EXPECT_NEAR(reached_at_s, 69, 1);
}

TEST(Fig1b, RightMostAgentThenLeavesVertically) {
  PaperTeam team(shipped_mission("paper_fig1b"));
  team.run_until(80);
  EXPECT_GT(std::abs(team.v_mps(2).y()), 2 * std::abs(team.v_mps(2).x()));
  team.run_until(150);
  EXPECT_GT(std::abs(team.x_m(2).y() - kMidline_m), 300);
}

TEST(Fig1b, TheOthersLeaveHalfWayTowardsAPeak) {
  PaperTeam team(shipped_mission("paper_fig1b"));
  const auto left = departures(team, 20);
  for (const std::size_t agent : {0U, 1U}) {
    ASSERT_TRUE(left[agent]) << "agent " << agent;
    EXPECT_GT(left[agent]->x(), 850) << "agent " << agent;
    EXPECT_LT(left[agent]->x(), 1250) << "agent " << agent;
  }
}

TEST(Fig1b, NoAgentLeavesInTheFirstMinute) {
  PaperTeam team(shipped_mission("paper_fig1b"));
  team.run_until(60, [&team] {
    for (std::size_t i = 0; i < team.size(); ++i) {
      ASSERT_NEAR(team.x_m(i).y(), kMidline_m, 0.01) << "agent " << i << " at " << team.t_s();
    }
  });
}

TEST(Fig1b, CoverageStaysPoor) {
  PaperTeam team(shipped_mission("paper_fig1b"));
  team.run_until(150);
  EXPECT_NEAR(team.metric(), 0.33, 0.03);
}

}  // namespace
}  // namespace ergocast::test
