// SPDX-License-Identifier: BSD-3-Clause
// The law that mows: shares of equal mass, lanes that leave no gap, teams that change.
#include "core/law/mower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/measure/detection.h"
#include "core/measure/target_mass.h"
#include "core/measure/team_measures.h"

namespace ergocast {
namespace {

using Eigen::Vector3d;

/// A mission in 200 m × 100 m with a target that is three times as dense in the west as in the
/// east.
Mission field() {
  Mission mission;
  mission.domain = {{-20, 5, 0}, {200, 100, 0}};
  mission.basis.modes_x = mission.basis.modes_y = 8;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.target_coefficients[mission.basis.modes_y] = 0.25;
  mission.law.kind = LawKind::kMow;
  mission.law.u_max_mps = 5;
  mission.timing.dt_s = 0.1;
  mission.sensor.radius_m = 4;
  return mission;
}

std::vector<AgentId> team_of(int count) {
  std::vector<AgentId> team;
  for (AgentId id = 0; id < static_cast<AgentId>(count); ++id) team.push_back(id);
  return team;
}

/// Agents that obey their laws at once.
class Walk {
 public:
  Walk(const Mission& mission, std::vector<Vector3d> starts_m)
      : mission_(mission), measures_(mission), places_m_(std::move(starts_m)) {
    for (std::size_t i = 0; i < places_m_.size(); ++i) laws_.emplace_back(mission);
  }

  void go(Tick ticks, const std::vector<AgentId>& team) {
    for (const Tick end = tick_ + ticks; tick_ < end; ++tick_) {
      for (const AgentId id : team) {
        Vector3d& x_m = places_m_[static_cast<std::size_t>(id)];
        measures_.see(id, tick_, x_m, true);
        const BasisAt at(x_m, mission_.domain, mission_.basis);
        const Vector3d v_mps =
            laws_[static_cast<std::size_t>(id)].wanted_mps({id, tick_, x_m, at, team});
        ASSERT_LE(v_mps.norm(), mission_.law.u_max_mps * (1 + 1e-12));
        x_m += v_mps * mission_.timing.dt_s;
        ASSERT_TRUE(mission_.domain.contains(x_m));
      }
      measures_.pass(tick_);
    }
  }

  const TeamMeasures& measures() const { return measures_; }
  const Vector3d& x_m(std::size_t agent) const { return places_m_[agent]; }

 private:
  const Mission mission_;
  TeamMeasures measures_;
  std::vector<Mower> laws_;
  std::vector<Vector3d> places_m_;
  Tick tick_ = 0;
};

TEST(EqualShare, HasEqualMassesThatFillTheDomain) {
  const Mission mission = field();
  const Cells cells = measure_cells(mission);
  const auto mass = target_mass(mission, mission.target_coefficients, cells);
  const RangeSums sums(cells, mass);
  for (const int count : {1, 2, 3, 7, 16}) {
    std::vector<int> taken(cells.total(), 0);
    for (int rank = 0; rank < count; ++rank) {
      const CellRange share = equal_share(cells, sums, rank, count);
      EXPECT_NEAR(sums.of(share) * count, 1, 0.12) << rank << " of " << count;
      for (int i = share.first_i; i < share.last_i; ++i) {
        for (int j = share.first_j; j < share.last_j; ++j)
          ++taken[cells.column(i, 0) + static_cast<std::size_t>(j)];
      }
    }
    EXPECT_TRUE(std::ranges::all_of(taken, [](int times) { return times == 1; })) << count;
  }
}

TEST(EqualShare, IsSharedByAgentsBeyondTheCells) {
  const Cells cells({{0, 0, 0}, {2, 1, 0}}, 1);
  const RangeSums sums(cells, {0.5, 0.5});
  for (int rank = 0; rank < 5; ++rank) {
    const CellRange share = equal_share(cells, sums, rank, 5);
    EXPECT_EQ(share.last_i - share.first_i, 1);
    EXPECT_EQ(share.last_j - share.first_j, 1);
  }
}

TEST(Mower, SeesEachPlaceThatIsWorthIt) {
  const Mission mission = field();
  Walk walk(mission, {{-20, 5, 0}, {180, 105, 0}, {50, 50, 0}});
  // The largest share, in the east, has about 10⁴ m²: in lanes of 8 m at 5 m/s it takes 250 s.
  walk.go(3500, team_of(3));
  double unseen = 0;
  const Detection& detection = walk.measures().detection();
  for (std::size_t cell = 0; cell < detection.mass().size(); ++cell)
    unseen += detection.missed()[cell] == 1 ? detection.mass()[cell] : 0;
  EXPECT_LT(unseen, 0.005) << "corners between lanes";
  EXPECT_GT(walk.measures().figures().detection_probability, 0.5);
}

TEST(Mower, DividesTheDomainAnewWithoutAnAgentThatLeft) {
  const Mission mission = field();
  Walk walk(mission, {{-20, 5, 0}, {180, 105, 0}});
  walk.go(400, team_of(2));
  const Vector3d west_m = walk.x_m(0);
  EXPECT_LT(west_m.x(), 60) << "agent 0 stays in its share";
  walk.go(6500, {0});  // agent 1 is gone: 2 · 10⁴ m² in lanes of 8 m at 5 m/s take 500 s
  double unseen = 0;
  const Detection& detection = walk.measures().detection();
  for (std::size_t cell = 0; cell < detection.mass().size(); ++cell)
    unseen += detection.missed()[cell] == 1 ? detection.mass()[cell] : 0;
  EXPECT_LT(unseen, 0.005);
}

TEST(Mower, GoesWhereANewTargetIs) {
  Mission mission = field();
  mission.target_coefficients[mission.basis.modes_y] = 0;
  Mower law(mission);
  const Vector3d x_m(0, 50, 0);
  const BasisAt at(x_m, mission.domain, mission.basis);
  const std::vector<AgentId> alone{0};
  law.wanted_mps({0, 0, x_m, at, alone});
  const auto east_m = [&] {
    double east_m = -1e9;
    for (const Vector3d& corner_m : law.corners_m()) east_m = std::max(east_m, corner_m.x());
    return east_m;
  };
  EXPECT_NEAR(east_m(), 178, 1);
  Coefficients west = Coefficients::Zero(mission.basis.mode_count());
  west[0] = 1;
  west[mission.basis.modes_y] = 0.7;
  west[2 * mission.basis.modes_y] = 0.1;  // 1 + 1.4 cos + 0.2 cos 2: below 0 in the east
  law.set_target(west);
  law.wanted_mps({0, 1, x_m, at, alone});
  EXPECT_LT(east_m(), 140);
}

TEST(Mower, LeavesOutACornerThatItDoesNotReach) {
  const Mission mission = field();
  Mower law(mission);
  const Vector3d x_m(100, 50, 0);  // it never moves
  const BasisAt at(x_m, mission.domain, mission.basis);
  const std::vector<AgentId> alone{0};
  const Vector3d first_mps = law.wanted_mps({0, 0, x_m, at, alone});
  bool turned = false;
  for (Tick tick = 1; tick < 5000 && !turned; ++tick)
    turned = (law.wanted_mps({0, tick, x_m, at, alone}) - first_mps).norm() > 1e-9;
  EXPECT_TRUE(turned);
}

TEST(Mower, StaysWhereNothingIsWorthMowing) {
  const Mission mission = field();
  Mower law(mission);
  law.set_target(Coefficients::Zero(mission.basis.mode_count()));
  const Vector3d x_m(100, 50, 0);
  const BasisAt at(x_m, mission.domain, mission.basis);
  const std::vector<AgentId> alone{0};
  EXPECT_EQ(law.wanted_mps({0, 0, x_m, at, alone}), Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace ergocast
