// SPDX-License-Identifier: BSD-3-Clause
// Bodies that want to be in walls, and behind them. The filter must keep them out, also between
// ticks. Each flaw withholds one thing from the filter, and must be seen to break the clearance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/noise.h"
#include "core/motion/push.h"
#include "core/motion/separation.h"
#include "core/motion/starts.h"
#include "core/motion/wall_following.h"
#include "core/motion/walls.h"
#include "tests/core/vehicles.h"

namespace ergocast {
namespace {

using namespace test;

constexpr double kSide_m = 300;

/// A ring with a door, a U, a needle, a wedge at the edge and a block that is partly outside.
Rings maze() {
  return {{{60, 60},
           {160, 60},
           {160, 100},
           {155, 100},
           {155, 65},
           {65, 65},
           {65, 155},
           {155, 155},
           {155, 130},
           {160, 130},
           {160, 160},
           {60, 160}},
          {{200, 200},
           {260, 200},
           {260, 205},
           {205, 205},
           {205, 255},
           {260, 255},
           {260, 260},
           {200, 260}},
          {{230, 20}, {290, 60}, {232, 22}},
          {{0, 200}, {50, 215}, {0, 230}},
          {{180, -20}, {200, -20}, {200, 30}, {180, 30}}};
}

Mission in_maze(const VehicleLimits& vehicle, double clearance_m = 3) {
  Mission mission = test::mission_of(vehicle, kSide_m);
  mission.walls = maze();
  mission.wall_clearance_m = clearance_m;
  return mission;
}

/// The task of the filter.
struct Attack {
  explicit Attack(const Mission& all) : mission(all), assumed(all) {}

  Mission mission;  ///< the world's
  Mission assumed;  ///< the filter's
  Tick hold_ticks = 0, reported_hold_ticks = 0;
  int bodies = 20, ticks = 1500;
  double restless = 0.02;  ///< the chance of a new goal in a tick
};

/// The least clearance of all bodies, within ticks too, less what the mission asks for [m].
double spare_m(const Attack& attack) {
  const Mission& mission = attack.mission;
  const Motion motion = motion_of(mission, 0), assumed = motion_of(attack.assumed, 0);
  SeparationFilter filter(attack.assumed, attack.reported_hold_ticks);
  Drawn draw;
  double least_m = 1e9;
  for (AgentId id = 0; id < attack.bodies; ++id) {
    Eigen::Vector3d x_m = start_of(mission, 4 + id), goal_m = x_m, command_mps(0, 0, 0);
    Eigen::Vector3d v_mps = first_velocity(motion, x_m);
    for (Tick tick = 0; tick < attack.ticks; ++tick) {
      if (draw.between(0, 1) < attack.restless)
        goal_m = {draw.between(0, kSide_m), draw.between(0, kSide_m), 0};
      if (tick % (1 + attack.hold_ticks) == 0) {
        const double error_m = mission.separation.position_error_m;
        const double angle = draw.between(0, 6.3);
        const Eigen::Vector3d seen_m =
            x_m + error_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
        const Eigen::Vector3d wanted_mps = 10 * (goal_m - seen_m);
        command_mps =
            filter.safe({id, tick, seen_m, assumed.speed_limit_mps, v_mps}, wanted_mps, {})
                .velocity_mps;
      }
      const Eigen::Vector3d next_mps = executed(motion, v_mps, command_mps);
      for (const double share : {0.25, 0.5, 0.75, 1.0}) {
        const Eigen::Vector3d at_m = place_within_m(motion, x_m, v_mps, next_mps, share);
        least_m = std::min(least_m, clearance_m(mission.walls, at_m.head<2>()));
      }
      x_m = moved(mission, id, tick, x_m, mean_velocity(motion, v_mps, next_mps));
      v_mps = next_mps;
      least_m = std::min(least_m, clearance_m(mission.walls, x_m.head<2>()));
      x_m = reflect(x_m, mission.domain);
    }
  }
  return least_m - mission.wall_clearance_m;
}

TEST(WallFilter, KeepsPointsOut) {
  Attack attack(in_maze({}));
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack), 1e-3) << "they do come near";
  attack.assumed.wall_clearance_m = 2.5;
  EXPECT_LT(spare_m(attack), -0.4);
  attack = Attack(in_maze({}));
  Rings some = maze();
  some.resize(2);
  attack.assumed.walls = std::move(some);
  EXPECT_LT(spare_m(attack), -3);
}

TEST(WallFilter, KeepsPointsOutThatKeepNoClearance) {
  EXPECT_GE(spare_m(Attack(in_maze({}, 0))), 0);
}

TEST(WallFilter, KeepsOutVehiclesThatBrake) {
  for (const double limit_mps2 : {5.0, 40.0}) {
    Attack attack(in_maze(inertia(limit_mps2)));
    EXPECT_GE(spare_m(attack), 0) << limit_mps2;
    attack.assumed.vehicle = {};
    EXPECT_LT(spare_m(attack), -0.5) << "as if it could stand at once";
  }
}

TEST(WallFilter, KeepsOutVehiclesThatTurnSlowly) {
  for (const VehicleLimits& kind : {unicycle(1), unicycle(10)}) {
    Attack attack(in_maze(kind));
    EXPECT_GE(spare_m(attack), 0);
    attack.assumed.vehicle = {};
    EXPECT_LT(spare_m(attack), -0.1) << "as if it could look anywhere at once";
  }
  Attack attack(in_maze(unicycle(10), 2));
  attack.restless = 0.2;
  EXPECT_GE(spare_m(attack), 0);
  attack.assumed.wall_clearance_m -= bulge_m(motion_of(attack.mission, 0));
  EXPECT_LT(spare_m(attack), 0) << "the bulge of an arc counts";
}

TEST(WallFilter, KeepsOutLoiterCircles) {
  Attack attack(in_maze(wings(1.5)));
  EXPECT_GE(spare_m(attack), 0);
  attack.assumed.wall_clearance_m -= loiter_radius_m(motion_of(attack.mission, 0));
  EXPECT_LT(spare_m(attack), -1);
}

Mission with_distance(double clearance_m) {
  Mission mission = in_maze({}, clearance_m);
  mission.separation.distance_m = 5;
  return mission;
}

TEST(WallFilter, KeepsOutVehiclesThatAreNotWhereTheyAreReported) {
  Mission mission = with_distance(3);
  mission.separation.position_error_m = 1.2;
  Attack attack(mission);
  EXPECT_GE(spare_m(attack), 0);
  attack.assumed.separation.position_error_m = 0;
  EXPECT_LT(spare_m(attack), -0.5);
}

TEST(WallFilter, KeepsOutVehiclesThatHoldTheirCommands) {
  Attack attack(with_distance(7));
  attack.hold_ticks = attack.reported_hold_ticks = 3;
  EXPECT_GE(spare_m(attack), 0);
  attack.reported_hold_ticks = 0;
  EXPECT_LT(spare_m(attack), -1);
}

TEST(WallFilter, KeepsOutVehiclesThatArePushed) {
  Mission mission = with_distance(3);
  mission.separation.disturbance_m = 0.4;
  mission.disturbance_intensity = 1;
  Attack attack(mission);
  EXPECT_GE(spare_m(attack), 0);
  // Walls rarely stop an agent that keeps w more distance, and often stop others.
  mission.separation.distance_m = 0;
  EXPECT_GE(spare_m(Attack(mission)), 0);
}

/// A push may have brought a body nearer to a wall than its margin. It then moves away from the
/// wall and never towards it, also when others are in its way.
TEST(WallFilter, HoldsWallsWhereNothingElseCanBeHeld) {
  Mission mission = with_distance(3);
  mission.separation.disturbance_m = 0.4;
  SeparationFilter filter(mission, 0);
  const double y_m = 60 - 3.2;
  const SafeVelocity away = filter.safe({0, 0, {110, y_m, 0}, 20}, {0, 10, 0}, {});
  EXPECT_LT(away.velocity_mps.y(), -1) << "0.2 m of the 0.4 m are missing";
  EXPECT_TRUE(away.wall);
  const Neighbour below[] = {{1, {110, y_m - 5.3, 0}, 20}};
  const SafeVelocity squeezed = filter.safe({0, 0, {110, y_m, 0}, 20}, {0, 10, 0}, below);
  EXPECT_LE(squeezed.velocity_mps.y() * mission.timing.dt_s, 0.2 + 1e-9);
}

TEST(WallFilter, LeavesWhatIsAllowedAsItIs) {
  const Mission mission = in_maze({});
  SeparationFilter filter(mission, 0);
  const Eigen::Vector3d along_mps(7.3, 0, 0), wanted_mps(5, 5, 0);
  const SafeVelocity free = filter.safe({0, 0, {110, 20, 0}, 20}, wanted_mps, {});
  EXPECT_EQ(free.velocity_mps, wanted_mps);
  EXPECT_FALSE(free.wall);
  const double kept_m = kept_from_walls_m(mission, motion_of(mission, 0));
  const SafeVelocity slides = filter.safe({0, 0, {110, 60 - kept_m, 0}, 20}, wanted_mps, {});
  EXPECT_NEAR(slides.velocity_mps.x(), 5, 1e-6) << "along the wall";
  EXPECT_LE(slides.velocity_mps.y(), 1e-9);
  EXPECT_TRUE(slides.wall);
  EXPECT_EQ(filter.safe({0, 0, {110, 60 - kept_m, 0}, 20}, along_mps, {}).velocity_mps, along_mps);
}

/// A spiral wall with so many corners, of which the turns are so far apart.
Ring spiral(int corners, double pitch_m) {
  Ring ring;
  const int half = corners / 2;
  const auto point = [&](int i, double off_m) {
    const double turns = 0.5 + (kSide_m / 2 - 20) / pitch_m * i / half;
    const double angle = 2 * M_PI * turns, radius_m = pitch_m * turns + off_m;
    return Eigen::Vector2d(kSide_m / 2 + radius_m * std::cos(angle),
                           kSide_m / 2 + radius_m * std::sin(angle));
  };
  for (int i = 0; i < half; ++i) ring.push_back(point(i, 0));
  for (int i = half - 1; i >= 0; --i) ring.push_back(point(i, 0.2));
  return ring;
}

/// A round room with so many corners in a block.
Rings round_room(int corners, double radius_m) {
  const double middle_m = kSide_m / 2;
  Ring room;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners;
    room.emplace_back(middle_m + radius_m * std::cos(angle), middle_m + radius_m * std::sin(angle));
  }
  return {{{50, 50}, {250, 50}, {250, 250}, {50, 250}}, room};
}

/// A plan may come from anyone who knows the key. Bodies that follow walls under it keep out. If
/// each edge at hand were held against all others, this would take minutes.
TEST(WallFilter, KeepsFollowersOutWhateverThePlansWallsAre) {
  const std::vector<Rings> plans = {{spiral(kMaxWallVertices, 8)},
                                    {spiral(4000, 6.2)},
                                    round_room(kMaxWallVertices - 4, 4),
                                    round_room(kMaxWallVertices - 4, 40)};
  for (std::size_t plan = 0; plan < plans.size(); ++plan) {
    Mission mission = in_maze({});
    mission.walls = IndexedRings(plans[plan]);
    ASSERT_TRUE(are_walls(mission.walls, mission.domain)) << plan;
    SeparationFilter filter(mission, 0);
    WallFollower follower(mission, 0);
    Drawn draw;
    Eigen::Vector3d x_m(kSide_m / 2 + 0.3, kSide_m / 2, 0);
    ASSERT_GE(spare_at_start_m(mission, 0, x_m), 0) << plan;
    double least_m = 1e9;
    for (Tick tick = 0; tick < 40; ++tick) {
      const Eigen::Vector3d wanted_mps(draw.between(-15, 15), 10, 0);
      const auto safe = filter.safe({0, tick, x_m, mission.speed_limit_mps},
                                    follower.aim(tick, x_m, wanted_mps), {});
      follower.note(true);
      x_m += safe.velocity_mps * mission.timing.dt_s;
      ASSERT_TRUE(x_m.allFinite()) << plan;
      least_m = std::min(least_m, clearance_m(mission.walls, x_m.head<2>()));
    }
    EXPECT_GE(least_m, mission.wall_clearance_m) << plan;
  }
}

TEST(WallFilter, RefusesPlansWithEdgesOfLengthZero) {
  Rings walls = maze();
  EXPECT_TRUE(are_walls(walls, in_maze({}).domain));
  walls[0].push_back(walls[0].back());
  EXPECT_FALSE(are_walls(walls, in_maze({}).domain));
  walls[0].back() = walls[0].front();
  EXPECT_FALSE(are_walls(walls, in_maze({}).domain));
}

}  // namespace
}  // namespace ergocast
