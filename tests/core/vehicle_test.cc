// SPDX-License-Identifier: BSD-3-Clause
// Vehicles with inertia: what they execute, how they brake, and crowds of them that keep a
// distance.
#include "core/vehicle.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <vector>

#include "core/geometry.h"
#include "core/ideal_team.h"
#include "core/separation.h"
#include "tests/support/team.h"

namespace ergocast {
namespace {

Mission mission_of(double max_acceleration_mps2, double side_m = 2000) {
  Mission mission = test::small_mission(4);
  mission.domain.size_m = {side_m, side_m, 0};
  mission.speed_limit_mps = 20;
  mission.vehicle = {VehicleKind::kAcceleration, max_acceleration_mps2};
  for (Eigen::Vector3d& start_m : mission.starts_m) start_m *= side_m / 2000;
  return mission;
}

class Drawn {
 public:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(draw_);
  }
  Eigen::Vector3d vector(double longest) {
    return {between(-longest, longest), between(-longest, longest), 0};
  }

 private:
  std::mt19937 draw_{1};
};

TEST(Vehicle, OfNoKindTakesEveryVelocityAtOnce) {
  Mission mission = mission_of(5);
  mission.vehicle = {};
  EXPECT_EQ(executed(mission, {-20, 0, 0}, {3, 4, 0}), Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(mean_velocity(mission, {-20, 0, 0}, {3, 4, 0}), Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(longest_braking_path_m(mission), 0);
  EXPECT_EQ(bulge_m(mission), 0);
}

TEST(Vehicle, ChangesItsVelocityByNoMoreThanItsAccelerationAndNeverExceedsItsLimit) {
  const Mission mission = mission_of(5);
  Drawn draw;
  Eigen::Vector3d v_mps(0, 0, 0);
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3d wanted_mps = draw.vector(draw.between(0, 1) < 0.5 ? 1 : 60);
    const Eigen::Vector3d next_mps = executed(mission, v_mps, wanted_mps);
    ASSERT_LE((next_mps - v_mps).norm(), 0.5 * (1 + 1e-9));
    ASSERT_LE(next_mps.norm(), 20 * (1 + 1e-12));
    ASSERT_EQ(executed(mission, v_mps, next_mps), next_mps) << "it can reach what it has reached";
    v_mps = next_mps;
  }
  EXPECT_EQ(executed(mission, {3, 4, 0}, {3.3, 4.4, 7}), Eigen::Vector3d(3.3, 4.4, 0));
  EXPECT_LT((executed(mission, {10, 0, 0}, {-20, 0, 0}) - Eigen::Vector3d(9.5, 0, 0)).norm(),
            1e-12);
}

TEST(Vehicle, BrakesWithinItsBrakingPath) {
  const Mission mission = mission_of(5);
  Drawn draw;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d start_mps = draw.vector(14);
    const Eigen::Vector3d path_m = braking_path_m(mission, start_mps);
    Eigen::Vector3d v_mps = start_mps, x_m(0, 0, 0);
    for (int tick = 0; tick < 41; ++tick) {
      const Eigen::Vector3d next_mps = executed(mission, v_mps, {0, 0, 0});
      x_m += mean_velocity(mission, v_mps, next_mps) * 0.1;
      v_mps = next_mps;
    }
    ASSERT_TRUE(v_mps.isZero(0));
    ASSERT_LE(x_m.norm(), path_m.norm() + 1e-9);
    ASSERT_GE(x_m.norm(), path_m.norm() - 0.5 * 0.1 * start_mps.norm()) << "one tick longer";
    ASSERT_NEAR(x_m.cross(path_m).norm(), 0, 1e-9);
  }
  EXPECT_NEAR(longest_braking_path_m(mission), 20 * 20 / (2 * 5.0), 1e-9);
}

// ---- teams

/// Neither at a tick nor between two.
double least_distance_within_m(const Mission& mission, const std::vector<Mover>& before,
                               const std::vector<Eigen::Vector3d>& next_mps) {
  double least_m = 1e300;
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    const double t_s = share * mission.timing.dt_s;
    std::vector<Eigen::Vector3d> places_m;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Eigen::Vector3d a_mps2 = (next_mps[i] - before[i].velocity_mps) / mission.timing.dt_s;
      places_m.push_back(before[i].position_m + before[i].velocity_mps * t_s +
                         0.5 * t_s * t_s * a_mps2);
    }
    least_m = std::min(least_m, least_distance_m(places_m));
  }
  return least_m;
}

enum class Flaw { kNone, kWholeGap, kNoBrakingPath };

/// Vehicles that want to be where others are; some commands are lost, and their vehicles brake.
/// @return the shortest distance of two less D [m]
double spare_m(double max_acceleration_mps2, Flaw flaw = Flaw::kNone) {
  Mission mission = mission_of(max_acceleration_mps2, 400);
  mission.separation.distance_m = 30;
  SeparationFilter filter(mission, 0);
  Drawn draw;
  std::vector<Mover> team;
  std::vector<Eigen::Vector3d> goals_m, places_m;
  for (AgentId id = 0; id < 12; ++id) {
    places_m.push_back(start_beside(mission, id, places_m, start_distance_m(mission)));
    team.push_back({id, 0, places_m.back(), 20, {0, 0, 0}});
    goals_m.push_back(mission.domain.center_m() + draw.vector(220));
  }
  double least_m = 1e300;
  for (Tick tick = 0; tick < 1500; ++tick) {
    std::vector<Neighbour> others;
    for (const Mover& one : team) {
      others.push_back({one.id, one.position_m, 20, 0, true, one.velocity_mps});
      if (flaw == Flaw::kWholeGap) others.back().max_speed_mps = 1e-9;
      if (flaw == Flaw::kNoBrakingPath) others.back().velocity_mps.setZero();
    }
    std::vector<Eigen::Vector3d> next_mps;
    for (std::size_t i = 0; i < team.size(); ++i) {
      Mover& self = team[i];
      self.tick = tick;
      if ((goals_m[i] - self.position_m).norm() < 20)
        goals_m[i] = mission.domain.center_m() + draw.vector(220);
      const bool lost = draw.between(0, 1) < 0.1;
      const Eigen::Vector3d wanted_mps = (goals_m[i] - self.position_m).normalized() * 25;
      next_mps.push_back(executed(
          mission, self.velocity_mps,
          lost ? Eigen::Vector3d(0, 0, 0) : filter.safe(self, wanted_mps, others).velocity_mps));
    }
    least_m = std::min(least_m, least_distance_within_m(mission, team, next_mps));
    for (std::size_t i = 0; i < team.size(); ++i) {
      team[i].position_m += mean_velocity(mission, team[i].velocity_mps, next_mps[i]) * 0.1;
      team[i].velocity_mps = next_mps[i];
      EXPECT_LT((mission.domain.nearest(team[i].position_m) - team[i].position_m).norm(), 1e-9);
    }
  }
  return least_m - 30;
}

TEST(Vehicles, WithInertiaKeepTheirDistanceAlsoBetweenTicks) {
  for (const double max_acceleration_mps2 : {2.0, 5.0, 40.0}) {
    EXPECT_GE(spare_m(max_acceleration_mps2), 0) << max_acceleration_mps2;
    EXPECT_LT(spare_m(max_acceleration_mps2), 3) << "they meet";
  }
  EXPECT_LT(spare_m(2, Flaw::kNoBrakingPath), -1);
  EXPECT_LT(spare_m(40, Flaw::kWholeGap), -0.1);
}

TEST(Vehicles, WithInertiaStayInTheDomainAndMoveAsTheyCan) {
  const Mission mission = mission_of(2, 300);
  lab::IdealTeam team(mission);
  std::vector<Eigen::Vector3d> before_m(team.size()), before_mps(team.size());
  double fastest_mps = 0;
  for (int tick = 0; tick < 600; ++tick) {
    for (std::size_t i = 0; i < team.size(); ++i) {
      before_m[i] = team.x_m(i);
      before_mps[i] = team.v_mps(i);
    }
    team.step();
    for (std::size_t i = 0; i < team.size(); ++i) {
      ASSERT_LE((team.v_mps(i) - before_mps[i]).norm(), 0.2 * (1 + 1e-9));
      const Eigen::Vector3d step_m = 0.05 * (team.v_mps(i) + before_mps[i]);
      ASSERT_LT((team.x_m(i) - before_m[i] - step_m).norm(), 1e-9) << "no edge folds it back";
      fastest_mps = std::max(fastest_mps, team.v_mps(i).norm());
    }
  }
  EXPECT_GT(fastest_mps, 5);
}

}  // namespace
}  // namespace ergocast
