// SPDX-License-Identifier: BSD-3-Clause
// Crowds of vehicles that are no points, of one kind and of all: they keep a distance, and stay in
// the domain.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/motion/separation.h"
#include "core/motion/starts.h"
#include "lab/ideal_team.h"
#include "tests/core/vehicles.h"

namespace ergocast {
namespace {

using namespace test;

/// The least distance of two bodies within a tick: at its ends and between them.
double least_distance_within_m(const Mission& mission, const std::vector<Mover>& before,
                               const std::vector<Eigen::Vector3d>& next_mps) {
  double least_m = 1e300;
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    std::vector<Eigen::Vector3d> places_m;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Motion motion = motion_of(mission, before[i].id);
      places_m.push_back(
          place_within_m(motion, before[i].position_m, before[i].velocity_mps, next_mps[i], share));
    }
    least_m = std::min(least_m, least_distance_m(places_m));
  }
  return least_m;
}

enum class Flaw {
  kNone,
  kWholeGap,
  kNoVelocity,  ///< neither braking paths nor headings of others are known
  kNoBulge,
  kNoCircle,     ///< no body has a loiter circle
  kItsNoCircle,  ///< no other body has one
  kAnyHeading,
  kMayStand,
  kAnotherKind,  ///< another body is taken for the vehicle of the number after its own
};

/// The filter's mission, with one thing withheld from it.
Mission flawed(Mission mission, Flaw flaw) {
  const Motion first = motion_of(mission, 0);
  if (flaw == Flaw::kNoBulge) mission.separation.distance_m -= 2 * bulge_m(first);
  if (flaw == Flaw::kNoCircle) mission.separation.distance_m -= 2 * loiter_radius_m(first);
  if (flaw == Flaw::kAnyHeading) mission.vehicle = {};
  if (flaw == Flaw::kMayStand) mission.vehicle = unicycle(mission.vehicle.max_turn_radps);
  return mission;
}

constexpr int kBodies = 12;

/// What `self` knows of the team.
std::vector<Neighbour> neighbours_of(const Mission& mission, const std::vector<Mover>& team,
                                     const Mover& self, Flaw flaw) {
  std::vector<Neighbour> others;
  for (const Mover& one : team) {
    if (one.id == self.id) continue;
    others.push_back({one.id, one.position_m, one.max_speed_mps, 0, true, one.velocity_mps});
    Neighbour& other = others.back();
    if (flaw == Flaw::kWholeGap) other.max_speed_mps = 1e-9;
    if (flaw == Flaw::kNoVelocity) other.velocity_mps.setZero();
    if (flaw == Flaw::kAnotherKind) other.id = (one.id + 1) % kBodies;
    if (flaw == Flaw::kItsNoCircle) {
      const Motion motion = motion_of(mission, one.id);
      const Eigen::Vector3d center_m = anchor_m(motion, one.position_m, one.velocity_mps);
      other.position_m += loiter_radius_m(motion) * (center_m - self.position_m).normalized();
    }
  }
  return others;
}

/// Vehicles that want to be where others are; some commands are lost, and their vehicles brake or
/// loiter.
/// @return the shortest distance of two less D [m]
double spare_m(Mission mission, Flaw flaw = Flaw::kNone) {
  mission.separation.distance_m = 30;
  SeparationFilter filter(flawed(mission, flaw), 0);
  Drawn draw;
  std::vector<Mover> team;
  std::vector<Eigen::Vector3d> goals_m;
  std::vector<Placed> placed;
  mission.starts_m.clear();
  for (AgentId id = 0; id < kBodies; ++id) {
    const Motion motion = motion_of(mission, id);
    const Eigen::Vector3d x_m = start_beside(mission, id, placed, start_distance_m);
    placed.push_back({id, x_m});
    mission.starts_m.push_back(x_m);
    team.push_back({id, 0, x_m, motion.speed_limit_mps, first_velocity(motion, x_m)});
    goals_m.push_back(mission.domain.center_m() + draw.vector(220));
  }
  EXPECT_FALSE(too_near_at_start(mission));
  double least_m = 1e300;
  for (Tick tick = 0; tick < 1500; ++tick) {
    std::vector<Eigen::Vector3d> next_mps;
    for (std::size_t i = 0; i < team.size(); ++i) {
      Mover& self = team[i];
      self.tick = tick;
      if ((goals_m[i] - self.position_m).norm() < 20)
        goals_m[i] = mission.domain.center_m() + draw.vector(220);
      const bool lost = draw.between(0, 1) < 0.1;
      const Eigen::Vector3d wanted_mps = (goals_m[i] - self.position_m).normalized() * 25;
      const Eigen::Vector3d safe_mps =
          filter.safe(self, wanted_mps, neighbours_of(mission, team, self, flaw)).velocity_mps;
      next_mps.push_back(executed(motion_of(mission, self.id), self.velocity_mps,
                                  lost ? Eigen::Vector3d(0, 0, 0) : safe_mps));
    }
    least_m = std::min(least_m, least_distance_within_m(mission, team, next_mps));
    for (std::size_t i = 0; i < team.size(); ++i) {
      const Motion motion = motion_of(mission, team[i].id);
      team[i].position_m += mean_velocity(motion, team[i].velocity_mps, next_mps[i]) * 0.1;
      team[i].velocity_mps = next_mps[i];
      if (flaw == Flaw::kNone) {
        EXPECT_LT((mission.domain.nearest(team[i].position_m) - team[i].position_m).norm(), 1e-9);
      }
    }
  }
  return least_m - 30;
}

double spare_m(const VehicleLimits& vehicle, Flaw flaw = Flaw::kNone) {
  return spare_m(mission_of(vehicle, 400), flaw);
}

/// Three bodies of each kind of vehicle, each with a speed limit of its own.
Mission mixed_mission(double max_acceleration_mps2, double turn_radps) {
  Mission mission = mission_of({}, 400);
  const auto kind = [&](const std::string& name, const VehicleLimits& vehicle, double limit_mps) {
    AgentKind one{name, 3};
    one.vehicle = vehicle;
    one.speed_limit_mps = limit_mps;
    mission.kinds.push_back(one);
  };
  kind("wing", wings(turn_radps), 20);
  kind("copter", inertia(max_acceleration_mps2), 15);
  kind("rover", unicycle(turn_radps), 10);
  kind("float", {}, 18);
  return mission;
}

TEST(Vehicles, OfDifferentKindsKeepTheirDistanceAlsoBetweenTicks) {
  for (const auto& [max_acceleration_mps2, turn_radps] :
       {std::pair(2.0, 1.0), std::pair(5.0, 3.0), std::pair(40.0, 20.0)}) {
    const Mission mission = mixed_mission(max_acceleration_mps2, turn_radps);
    EXPECT_GE(spare_m(mission), 0) << max_acceleration_mps2;
    EXPECT_LT(spare_m(mission), 3) << "they meet";
  }
  EXPECT_LT(spare_m(mixed_mission(2, 1), Flaw::kWholeGap), -0.1);
  EXPECT_LT(spare_m(mixed_mission(2, 1), Flaw::kNoVelocity), -1);
  EXPECT_LT(spare_m(mixed_mission(2, 1), Flaw::kItsNoCircle), -1);
  EXPECT_LT(spare_m(mixed_mission(2, 1), Flaw::kAnotherKind), -1);
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
