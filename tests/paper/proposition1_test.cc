// Proposition 1: under the classical law (5) corners, axes, midlines and diagonals are invariant.
//
// Its premises are more than the target's symmetry: on midlines and diagonals the team has to be
// symmetric as well, because c_k is the whole team's, and diagonals need a square. On the edges
// x = 0 and y = 0 every sine is exactly 0, so nothing is needed at all.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/paper_team.h"

namespace ergocast::test {
namespace {

/// The quadrimodal square of Fig. 1 under the classical law, with other starts.
Mission classical(std::vector<Eigen::Vector2d> starts_m) {
  Mission mission = shipped_mission("paper_fig1a");
  mission.starts_m = std::move(starts_m);
  mission.timing.tick_count = 300;
  return mission;
}

/// The largest share of |B| that points along `normal` in the team's first `steps` steps.
double worst_normal_share(PaperTeam team, const Eigen::Vector2d& normal, int steps) {
  double worst = 0;
  for (int n = 0; n < steps; ++n) {
    team.step();
    for (std::size_t i = 0; i < team.size(); ++i) {
      if (team.b(i).norm() == 0) continue;
      worst = std::max(worst, std::abs(team.b(i).dot(normal)) / team.b(i).norm());
    }
  }
  return worst;
}

TEST(Proposition1, LowerAndLeftEdgeHoldAnyTeamExactly) {
  PaperTeam team(classical({{700, 0}, {0, 1234.5}, {321, 1777}}));
  for (int n = 0; n < 300; ++n) {
    team.step();
    ASSERT_EQ(team.b(0).y(), 0);
    ASSERT_EQ(team.x_m(0).y(), 0);
    ASSERT_EQ(team.b(1).x(), 0);
    ASSERT_EQ(team.x_m(1).x(), 0);
  }
}

TEST(Proposition1, OriginIsAnEquilibriumOfAnyTeam) {
  PaperTeam team(classical({{0, 0}, {321, 1777}}));
  for (int n = 0; n < 300; ++n) {
    team.step();
    ASSERT_EQ(team.b(0), Eigen::Vector2d(0, 0));
    ASSERT_EQ(team.x_m(0), Eigen::Vector2d(0, 0));
  }
}

TEST(Proposition1, FarCornersAreEquilibriaUpToRounding) {
  // Compared with |B| in the middle of nowhere, B at a corner is rounding alone.
  PaperTeam team(classical({{2000, 2000}}));
  PaperTeam elsewhere(classical({{1700, 1800}}));
  team.step();
  elsewhere.step();
  EXPECT_LT(team.b(0).norm(), 1e-11 * elsewhere.b(0).norm());
}

TEST(Proposition1, MidlinesHoldATeamThatIsOnThem) {
  EXPECT_LT(worst_normal_share(PaperTeam(classical({{1000, 200}, {1000, 700}})), {1, 0}, 50), 1e-9);
  EXPECT_LT(worst_normal_share(PaperTeam(classical({{200, 1000}, {700, 1000}})), {0, 1}, 50), 1e-9);
}

TEST(Proposition1, MidlineHoldsAnAgentWhoseTeammatesMirrorEachOther) {
  const Mission mission = classical({{1000, 200}, {700, 1300}, {1300, 1300}});
  PaperTeam team(mission);
  team.step();
  EXPECT_LT(std::abs(team.b(0).x()), 1e-9 * team.b(0).norm());
}

TEST(Proposition1, MidlineDoesNotHoldAnAgentWithAnAsymmetricTeam) {
  PaperTeam team(classical({{1000, 200}, {321, 1777}}));
  team.step();
  EXPECT_GT(std::abs(team.b(0).x()), 1e-3 * team.b(0).norm());
}

TEST(Proposition1, DiagonalsHoldATeamThatIsOnThem) {
  const double r = std::sqrt(0.5);
  EXPECT_LT(worst_normal_share(PaperTeam(classical({{200, 200}, {900, 900}})), {r, -r}, 50), 1e-9);
  EXPECT_LT(worst_normal_share(PaperTeam(classical({{200, 1800}, {900, 1100}})), {r, r}, 50), 1e-9);
}

TEST(Proposition1, DiagonalsNeedASymmetricTeam) {
  PaperTeam team(classical({{200, 200}, {1777, 321}}));
  team.step();
  EXPECT_GT(std::abs(team.b(0).x() - team.b(0).y()), 1e-3 * team.b(0).norm());
}

TEST(Proposition1, DiagonalsNeedASquare) {
  Mission mission = classical({{200, 100}});
  mission.domain.size_m = {2000, 1000};
  PaperTeam team(mission);
  team.step();
  // On the diagonal of a rectangle B does not point along it.
  const Eigen::Vector2d normal = Eigen::Vector2d(1, -2).normalized();
  EXPECT_GT(std::abs(team.b(0).dot(normal)), 1e-3 * team.b(0).norm());
}

}  // namespace
}  // namespace ergocast::test
