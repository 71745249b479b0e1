// SPDX-License-Identifier: BSD-3-Clause
// Vehicles that are no points: what they execute, how they brake and loiter, and crowds of them
// that keep a distance.
#include "core/vehicle.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/geometry.h"
#include "core/ideal_team.h"
#include "core/separation.h"
#include "tests/support/team.h"

namespace ergocast {
namespace {

VehicleLimits inertia(double max_acceleration_mps2) {
  return {VehicleKind::kAcceleration, max_acceleration_mps2};
}
VehicleLimits unicycle(double max_turn_radps) {
  return {VehicleKind::kUnicycle, 0, max_turn_radps};
}
VehicleLimits wings(double max_turn_radps, double min_speed_mps = 8) {
  return {VehicleKind::kFixedWing, 0, max_turn_radps, min_speed_mps};
}

Mission mission_of(const VehicleLimits& vehicle, double side_m = 2000) {
  Mission mission = test::small_mission(4);
  mission.domain.size_m = {side_m, side_m, 0};
  mission.speed_limit_mps = 20;
  mission.vehicle = vehicle;
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
  Mission mission = mission_of(inertia(5));
  mission.vehicle = {};
  EXPECT_EQ(executed(mission, {-20, 0, 0}, {3, 4, 0}), Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(mean_velocity(mission, {-20, 0, 0}, {3, 4, 0}), Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(longest_braking_path_m(mission), 0);
  EXPECT_EQ(bulge_m(mission), 0);
}

TEST(Vehicle, ChangesItsVelocityByNoMoreThanItsAccelerationAndNeverExceedsItsLimit) {
  const Mission mission = mission_of(inertia(5));
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
  const Mission mission = mission_of(inertia(5));
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

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

TEST(Vehicle, TurnsByNoMoreThanItsRateAndFliesNoSlowerThanItMust) {
  for (const VehicleLimits& kind : {unicycle(1), unicycle(40), wings(0.35), wings(4)}) {
    const Mission mission = mission_of(kind);
    Drawn draw;
    Eigen::Vector3d v_mps = first_velocity(mission, {100, 100, 0});
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d wanted_mps = draw.vector(draw.between(0, 1) < 0.5 ? 1 : 60);
      const Eigen::Vector3d next_mps = executed(mission, v_mps, wanted_mps);
      ASSERT_LE(std::abs(angle_between(v_mps, next_mps)), kind.max_turn_radps * 0.1 + 1e-9);
      ASSERT_LE(next_mps.norm(), 20 * (1 + 1e-12));
      ASSERT_GE(next_mps.norm(), std::max(kind.min_speed_mps, 2e-8) * (1 - 1e-12));
      ASSERT_EQ(executed(mission, v_mps, next_mps), next_mps) << "it can reach what it has reached";
      const Eigen::Vector3d mean_mps = mean_velocity(mission, v_mps, next_mps);
      ASSERT_LE(mean_mps.norm(), next_mps.norm() * (1 + 1e-12));
      const double turn = angle_between(v_mps, next_mps);
      if (mean_mps.norm() > 0) {
        ASSERT_NEAR(angle_between(v_mps, mean_mps), turn / 2, 1e-9) << "the chord of an arc";
        const double radius_m = mean_mps.norm() * 0.1 / (2 * std::sin(std::abs(turn) / 2));
        ASSERT_GE(radius_m, next_mps.norm() / kind.max_turn_radps * (1 - 1e-6));
      }
      v_mps = next_mps;
    }
  }
}

TEST(Vehicle, ThatStandsLooksWhereItLookedAndTurnsOnTheSpot) {
  const Mission mission = mission_of(unicycle(1));
  const Eigen::Vector3d drives_mps(6, 8, 0);
  Eigen::Vector3d v_mps = executed(mission, drives_mps, {0, 0, 0});
  EXPECT_LT(v_mps.norm(), 1e-7);
  EXPECT_NEAR(angle_between(drives_mps, v_mps), 0, 1e-12);
  EXPECT_TRUE(mean_velocity(mission, drives_mps, v_mps).isZero(0)) << "it does not creep";
  const Eigen::Vector3d behind_mps = -10 * drives_mps;
  int ticks = 0;
  for (; ticks < 100 && v_mps.norm() < 1; ++ticks) {
    const Eigen::Vector3d next_mps = executed(mission, v_mps, behind_mps);
    if (std::abs(angle_between(next_mps, behind_mps)) > 1.6) {
      ASSERT_TRUE(mean_velocity(mission, v_mps, next_mps).isZero(0));
    }
    v_mps = next_mps;
  }
  EXPECT_NEAR(ticks * 0.1, 3.14159 / 2, 0.15) << "until its way is ahead of it";
}

TEST(Vehicle, LoitersAboutACentreThatStays) {
  for (const VehicleLimits& kind : {wings(0.35), wings(4), wings(0.05, 2)}) {
    const Mission mission = mission_of(kind);
    Drawn draw;
    Eigen::Vector3d x_m(700, 300, 0), v_mps = draw.vector(14);
    v_mps = executed(mission, {8, 0, 0}, v_mps);
    const Eigen::Vector3d center_m = anchor_m(mission, x_m, v_mps);
    EXPECT_NEAR((center_m - x_m).norm(), kind.min_speed_mps / kind.max_turn_radps, 1e-9);
    for (int tick = 0; tick < 10000; ++tick) {
      const Eigen::Vector3d next_mps = executed(mission, v_mps, {0, 0, 0});
      x_m += mean_velocity(mission, v_mps, next_mps) * 0.1;
      v_mps = next_mps;
      ASSERT_LT((anchor_m(mission, x_m, v_mps) - center_m).norm(), 1e-8);
    }
  }
}

TEST(Vehicle, WithWingsBeginsWithItsLoiterCircleInTheDomain) {
  const Mission mission = mission_of(wings(0.35));
  const double radius_m = 8 / 0.35;
  const Box room = room_to_begin(mission);
  EXPECT_NEAR(room.origin_m.x(), radius_m, 1e-9);
  EXPECT_NEAR(room.size_m.y(), 2000 - 2 * radius_m, 1e-9);
  Drawn draw;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d x_m =
        room.nearest(Eigen::Vector3d(draw.between(-200, 2200), draw.between(-200, 2200), 0));
    const Eigen::Vector3d center_m = anchor_m(mission, x_m, first_velocity(mission, x_m));
    ASSERT_LT((room.nearest(center_m) - center_m).norm(), 1e-9);
    ASSERT_NEAR((center_m - x_m).norm(), radius_m, 1e-9);
  }
}

// ---- teams

/// Where a vehicle is within a tick, after a share of it.
Eigen::Vector3d place_within_m(const Mission& mission, const Mover& before,
                               const Eigen::Vector3d& next_mps, double share) {
  const double dt_s = mission.timing.dt_s, t_s = share * dt_s;
  const Eigen::Vector3d& v_mps = before.velocity_mps;
  if (mission.vehicle.kind == VehicleKind::kAcceleration)
    return before.position_m + v_mps * t_s + 0.5 * t_s * t_s * (next_mps - v_mps) / dt_s;
  const double turn = angle_between(v_mps, next_mps);
  const Eigen::Vector3d whole_m = mean_velocity(mission, v_mps, next_mps) * dt_s;
  if (std::abs(turn) < 1e-9) return before.position_m + share * whole_m;
  const Eigen::Vector3d part_m = std::sin(share * turn / 2) / std::sin(turn / 2) * whole_m;
  const double back = (share - 1) * turn / 2;
  return before.position_m + Eigen::AngleAxisd(back, Eigen::Vector3d::UnitZ()) * part_m;
}

TEST(Vehicle, LeavesTheStraightWayOfItsAnchorByNoMoreThanItSays) {
  for (const VehicleLimits& kind : {unicycle(1), unicycle(5), wings(1), wings(5, 15)}) {
    const Mission mission = mission_of(kind);
    Drawn draw;
    double most_m = 0;
    for (int i = 0; i < 3000; ++i) {
      const Mover before{0, 0, {0, 0, 0}, 20, executed(mission, {8, 0, 0}, draw.vector(30))};
      const Eigen::Vector3d next_mps = executed(mission, before.velocity_mps, draw.vector(60));
      const double turn = angle_between(before.velocity_mps, next_mps);
      const Eigen::AngleAxisd half(turn / 2, Eigen::Vector3d::UnitZ());
      const auto anchor = [&](double share, const Eigen::Vector3d& v_mps) {
        return anchor_m(mission, place_within_m(mission, before, next_mps, share), v_mps);
      };
      const Eigen::Vector3d middle_m = (anchor(0, before.velocity_mps) + anchor(1, next_mps)) / 2;
      most_m = std::max(most_m, (anchor(0.5, half * before.velocity_mps) - middle_m).norm());
    }
    EXPECT_LE(most_m, bulge_m(mission) * (1 + 1e-9));
    EXPECT_GE(most_m, bulge_m(mission) * 0.9) << "and it says no more than needed";
  }
}

/// Neither at a tick nor between two.
double least_distance_within_m(const Mission& mission, const std::vector<Mover>& before,
                               const std::vector<Eigen::Vector3d>& next_mps) {
  double least_m = 1e300;
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    std::vector<Eigen::Vector3d> places_m;
    for (std::size_t i = 0; i < before.size(); ++i)
      places_m.push_back(place_within_m(mission, before[i], next_mps[i], share));
    least_m = std::min(least_m, least_distance_m(places_m));
  }
  return least_m;
}

enum class Flaw { kNone, kWholeGap, kNoVelocity, kNoBulge, kNoCircle, kAnyHeading, kMayStand };

/// The filter's mission, with one thing withheld from it.
Mission flawed(Mission mission, Flaw flaw) {
  if (flaw == Flaw::kNoBulge) mission.separation.distance_m -= 2 * bulge_m(mission);
  if (flaw == Flaw::kNoCircle) mission.separation.distance_m -= 2 * loiter_radius_m(mission);
  if (flaw == Flaw::kAnyHeading) mission.vehicle = {};
  if (flaw == Flaw::kMayStand) mission.vehicle = unicycle(mission.vehicle.max_turn_radps);
  return mission;
}

/// Vehicles that want to be where others are; some commands are lost, and their vehicles brake or
/// loiter.
/// @return the shortest distance of two less D [m]
double spare_m(const VehicleLimits& vehicle, Flaw flaw = Flaw::kNone) {
  Mission mission = mission_of(vehicle, 400);
  mission.separation.distance_m = 30;
  SeparationFilter filter(flawed(mission, flaw), 0);
  Drawn draw;
  std::vector<Mover> team;
  std::vector<Eigen::Vector3d> goals_m, places_m;
  for (AgentId id = 0; id < 12; ++id) {
    places_m.push_back(start_beside(mission, id, places_m, start_distance_m(mission)));
    team.push_back({id, 0, places_m.back(), 20, first_velocity(mission, places_m.back())});
    goals_m.push_back(mission.domain.center_m() + draw.vector(220));
  }
  EXPECT_GE(least_distance_m(places_m), start_distance_m(mission));
  double least_m = 1e300;
  for (Tick tick = 0; tick < 1500; ++tick) {
    std::vector<Neighbour> others;
    for (const Mover& one : team) {
      others.push_back({one.id, one.position_m, 20, 0, true, one.velocity_mps});
      if (flaw == Flaw::kWholeGap) others.back().max_speed_mps = 1e-9;
      if (flaw == Flaw::kNoVelocity) others.back().velocity_mps.setZero();
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
      if (flaw == Flaw::kNone) {
        EXPECT_LT((mission.domain.nearest(team[i].position_m) - team[i].position_m).norm(), 1e-9);
      }
    }
  }
  return least_m - 30;
}

TEST(Vehicles, WithInertiaKeepTheirDistanceAlsoBetweenTicks) {
  for (const double max_acceleration_mps2 : {2.0, 5.0, 40.0}) {
    EXPECT_GE(spare_m(inertia(max_acceleration_mps2)), 0) << max_acceleration_mps2;
    EXPECT_LT(spare_m(inertia(max_acceleration_mps2)), 3) << "they meet";
  }
  EXPECT_LT(spare_m(inertia(2), Flaw::kNoVelocity), -1);
  EXPECT_LT(spare_m(inertia(40), Flaw::kWholeGap), -0.1);
}

TEST(Vehicles, ThatTurnSlowlyKeepTheirDistanceAlsoBetweenTicks) {
  for (const double max_turn_radps : {0.35, 1.0, 5.0, 30.0}) {
    EXPECT_GE(spare_m(unicycle(max_turn_radps)), 0) << max_turn_radps;
    EXPECT_LT(spare_m(unicycle(max_turn_radps)), 3) << "they meet";
  }
  EXPECT_LT(spare_m(unicycle(1), Flaw::kWholeGap), -0.1);
  EXPECT_LT(spare_m(unicycle(1), Flaw::kAnyHeading), -0.1);
  EXPECT_LT(spare_m(unicycle(30), Flaw::kNoBulge), 0);
}

TEST(Vehicles, WithWingsKeepTheirDistanceAlsoBetweenTicks) {
  for (const double max_turn_radps : {1.0, 2.0, 5.0, 30.0}) {
    EXPECT_GE(spare_m(wings(max_turn_radps)), 0) << max_turn_radps;
    EXPECT_LT(spare_m(wings(max_turn_radps)), 3) << "they meet";
  }
  EXPECT_LT(spare_m(wings(1), Flaw::kWholeGap), -0.1);
  EXPECT_LT(spare_m(wings(1), Flaw::kNoVelocity), -1);
  EXPECT_LT(spare_m(wings(1), Flaw::kNoCircle), -1);
  EXPECT_LT(spare_m(wings(1), Flaw::kMayStand), -1);
  EXPECT_LT(spare_m(wings(30), Flaw::kNoBulge), 0);
}

TEST(Vehicles, WithInertiaStayInTheDomainAndMoveAsTheyCan) {
  const Mission mission = mission_of(inertia(2), 300);
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

TEST(Vehicles, ThatTurnSlowlyStayInTheDomainWithoutBeingFoldedBack) {
  for (const VehicleLimits& kind : {unicycle(0.35), wings(0.35, 5)}) {
    const Mission mission = mission_of(kind, 300);
    lab::IdealTeam team(mission, lab::Edges::kNone);
    double fastest_mps = 0;
    for (int tick = 0; tick < 2000; ++tick) {
      team.step();
      for (std::size_t i = 0; i < team.size(); ++i) {
        const Eigen::Vector3d x_m = team.x_m(i);
        ASSERT_LT((mission.domain.nearest(x_m) - x_m).norm(), 1e-9);
        fastest_mps = std::max(fastest_mps, team.v_mps(i).norm());
      }
    }
    EXPECT_GT(fastest_mps, 5);
  }
}

}  // namespace
}  // namespace ergocast
