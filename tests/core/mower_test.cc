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
#include "core/motion/walls.h"

namespace ergocast {
namespace {

using Eigen::Vector3d;

/// A mission in 200 m × 100 m with a target that is three times as dense in the west as in the
/// east.
Mission mown_field() {
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

/// The same with a target that is as dense everywhere, and walls: one with a door of 15 m in the
/// north, and a room without a door in the south-west, which takes 10 m × 8 m.
Mission rooms() {
  Mission mission = mown_field();
  mission.target_coefficients[mission.basis.modes_y] = 0;
  mission.speed_limit_mps = 5;
  mission.wall_clearance_m = 1;
  mission.walls = {{{70, -5}, {73, -5}, {73, 90}, {70, 90}},
                   {{10, 20}, {26, 20}, {26, 34}, {10, 34}},
                   {{13, 23}, {23, 23}, {23, 31}, {13, 31}}};
  return mission;
}

/// A mission in a box of 60 m × 40 m × 20 m.
Mission box() {
  Mission mission = mown_field();
  mission.domain = {{-20, 5, -30}, {60, 40, 20}};
  mission.basis.modes_z = 4;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  return mission;
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
        ASSERT_GE(clearance_m(mission_.walls, x_m.head<2>()), 0.9 * mission_.wall_clearance_m)
            << "at " << x_m.transpose();
      }
      measures_.pass(tick_);
    }
  }

  /// The share of the target's mass that no sensor has been near.
  double unseen() const {
    const Detection& detection = measures_.detection();
    double unseen = 0;
    for (std::size_t cell = 0; cell < detection.mass().size(); ++cell)
      unseen += detection.missed()[cell] == 1 ? detection.mass()[cell] : 0;
    return unseen;
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
  const Mission mission = mown_field();
  const Cells cells = measure_cells(mission);
  const auto mass = target_mass(mission.basis, mission.walls, mission.target_coefficients, cells);
  const RangeSums sums(cells, mass);
  for (const int count : {1, 2, 3, 7, 16}) {
    std::vector<int> taken(cells.total(), 0);
    for (int rank = 0; rank < count; ++rank) {
      const CellRange share = equal_share(cells, sums, rank, count);
      EXPECT_NEAR(sums.of(share) * count, 1, 0.12) << rank << " of " << count;
      for (int i = share.first.x(); i < share.last.x(); ++i) {
        for (int j = share.first.y(); j < share.last.y(); ++j)
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
    EXPECT_TRUE((share.counts() == 1).all()) << rank;
  }
}

TEST(Mower, SeesEachPlaceThatIsWorthIt) {
  const Mission mission = mown_field();
  Walk walk(mission, {{-20, 5, 0}, {180, 105, 0}, {50, 50, 0}});
  // The largest share, in the east, has about 10⁴ m²: in lanes of 8 m at 5 m/s it takes 250 s.
  walk.go(3500, team_of(3));
  EXPECT_LT(walk.unseen(), 0.005) << "corners between lanes";
  EXPECT_GT(walk.measures().figures().detection_probability, 0.5);
}

TEST(Mower, DividesTheDomainAnewWithoutAnAgentThatLeft) {
  const Mission mission = mown_field();
  Walk walk(mission, {{-20, 5, 0}, {180, 105, 0}});
  walk.go(400, team_of(2));
  const Vector3d west_m = walk.x_m(0);
  EXPECT_LT(west_m.x(), 60) << "agent 0 stays in its share";
  walk.go(6500, {0});  // agent 1 is gone: 2 · 10⁴ m² in lanes of 8 m at 5 m/s take 500 s
  EXPECT_LT(walk.unseen(), 0.005);
}

TEST(Mower, GoesWhereANewTargetIs) {
  Mission mission = mown_field();
  mission.target_coefficients[mission.basis.modes_y] = 0;
  Mower law(mission);
  const Vector3d x_m(0, 50, 0);
  const BasisAt at(x_m, mission.domain, mission.basis);
  const std::vector<AgentId> alone{0};
  law.wanted_mps({0, 0, x_m, at, alone});
  const auto east_m = [&] {
    double most_m = -1e9;
    for (const Vector3d& corner_m : law.corners_m()) most_m = std::max(most_m, corner_m.x());
    return most_m;
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

/// The law of agent 0, alone at a place.
Vector3d wanted_mps(Mower& law, const Mission& mission, Tick tick, const Vector3d& x_m) {
  const BasisAt at(x_m, mission.domain, mission.basis);
  const std::vector<AgentId> alone{0};
  return law.wanted_mps({0, tick, x_m, at, alone});
}

/// After how many ticks an agent that never moves leaves its first corner out.
Tick patience(Mower& law, const Mission& mission, Tick at_most) {
  const Vector3d x_m(100, 50, 0);
  const Vector3d first = wanted_mps(law, mission, 0, x_m).normalized();
  for (Tick tick = 1; tick < at_most; ++tick)
    if ((wanted_mps(law, mission, tick, x_m).normalized() - first).norm() > 1e-9) return tick;
  return at_most;
}

TEST(Mower, GoesAroundWallsToEachPlaceThatItCanReach) {
  const Mission mission = rooms();
  Walk walk(mission, {{-15, 8, 0}});
  walk.go(7000, {0});  // 2 · 10⁴ m² in lanes of 8 m at 5 m/s take 500 s
  EXPECT_LT(walk.unseen(), 0.005) << "the closed room has 0.4 % of the mass";
}

TEST(Mower, SharesOfATeamAmongWallsLeaveNoGap) {
  const Mission mission = rooms();
  Walk walk(mission, {{-15, 8, 0}, {170, 8, 0}, {60, 100, 0}});
  walk.go(4000, team_of(3));
  EXPECT_LT(walk.unseen(), 0.005);
}

TEST(Mower, SeesEachPlaceOfABox) {
  const Mission mission = box();
  Walk walk(mission, {{-20, 5, -30}, {40, 45, -10}});
  // 4.8 · 10⁴ m³ in lanes of 5.66 m × 5.66 m at 5 m/s take two agents 150 s.
  walk.go(2200, team_of(2));
  EXPECT_LT(walk.unseen(), 0.005);
}

TEST(Mower, HasThePatienceOfItsRealSpeed) {
  const Mission mission = mown_field();
  Mission slow = mission;
  slow.speed_limit_mps = 0.5;
  Mower law(mission), slow_law(slow), slowed_law(mission);
  const Tick fast_ticks = patience(law, mission, 5000);
  EXPECT_LT(fast_ticks, 1000);
  EXPECT_NEAR(static_cast<double>(patience(slow_law, slow, 20000) - 100),
              10 * static_cast<double>(fast_ticks - 100), 10);
  EXPECT_LE(wanted_mps(slow_law, slow, 20000, {100, 50, 0}).norm(), 0.5 * (1 + 1e-12));
  wanted_mps(slowed_law, mission, 0, {100, 50, 0});
  slowed_law.set_law({.u_max_mps = 0.5});
  EXPECT_NEAR(static_cast<double>(patience(slowed_law, mission, 20000) - 100),
              10 * static_cast<double>(fast_ticks - 100), 10);
}

TEST(Mower, LeavesOutCornersToWhichNoWayLeads) {
  const Mission mission = rooms();
  Mower law(mission);
  wanted_mps(law, mission, 0, {100, 50, 0});
  for (Tick tick = 1; tick < 1000; ++tick) wanted_mps(law, mission, tick, {18, 27, 0});
  const Vector3d first = wanted_mps(law, mission, 1000, {100, 50, 0}).normalized();
  bool left_out = false;
  for (Tick tick = 1001; tick < 1101; ++tick) {
    const Vector3d next = wanted_mps(law, mission, tick, {100, 50, 0}).normalized();
    left_out = left_out || (next - first).norm() > 1e-9;
  }
  EXPECT_TRUE(left_out);
}

TEST(Mower, HasTheMostPatienceAtNextToNoSpeed) {
  Mission mission = mown_field();
  mission.law.u_max_mps = 1e-30;
  Mower law(mission);
  EXPECT_EQ(patience(law, mission, 300), 300);
}

TEST(Mower, HasReachedACornerFromWhichADisturbanceMayKeepIt) {
  Mission mission = mown_field();
  mission.disturbance_intensity = 10;  // 3.2 m in a tick
  Mower law(mission);
  wanted_mps(law, mission, 0, {100, 50, 0});
  const Vector3d corner_m = law.corners_m()[0], beside_m = corner_m + Vector3d(0, 5, 0);
  const Vector3d next_m = law.corners_m()[1];
  const Vector3d v_mps = wanted_mps(law, mission, 1, beside_m);
  EXPECT_LT((v_mps.normalized() - (next_m - beside_m).normalized()).norm(), 1e-9);
}

TEST(Mower, StaysWhereNothingIsWorthMowing) {
  const Mission mission = mown_field();
  Mower law(mission);
  law.set_target(Coefficients::Zero(mission.basis.mode_count()));
  const Vector3d x_m(100, 50, 0);
  const BasisAt at(x_m, mission.domain, mission.basis);
  const std::vector<AgentId> alone{0};
  EXPECT_EQ(law.wanted_mps({0, 0, x_m, at, alone}), Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace ergocast
