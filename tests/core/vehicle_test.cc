// SPDX-License-Identifier: BSD-3-Clause
// Vehicles that are no points: what they execute, and how they brake, turn and loiter.
#include "core/motion/vehicle.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"
#include "tests/core/vehicles.h"

namespace ergocast {
namespace {

using namespace test;

TEST(Vehicle, OfNoKindTakesEveryVelocityAtOnce) {
  Motion motion = motion_in(inertia(5));
  motion.vehicle = {};
  EXPECT_EQ(executed(motion, {-20, 0, 0}, {3, 4, 0}), Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(mean_velocity(motion, {-20, 0, 0}, {3, 4, 0}), Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(longest_braking_path_m(motion), 0);
  EXPECT_EQ(bulge_m(motion), 0);
}

TEST(Vehicle, ChangesItsVelocityByNoMoreThanItsAccelerationAndNeverExceedsItsLimit) {
  const Motion motion = motion_in(inertia(5));
  Drawn draw;
  Eigen::Vector3d v_mps(0, 0, 0);
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3d wanted_mps = draw.vector(draw.between(0, 1) < 0.5 ? 1 : 60);
    const Eigen::Vector3d next_mps = executed(motion, v_mps, wanted_mps);
    ASSERT_LE((next_mps - v_mps).norm(), 0.5 * (1 + 1e-9));
    ASSERT_LE(next_mps.norm(), 20 * (1 + 1e-12));
    ASSERT_EQ(executed(motion, v_mps, next_mps), next_mps) << "it can reach what it has reached";
    v_mps = next_mps;
  }
  EXPECT_EQ(executed(motion, {3, 4, 0}, {3.3, 4.4, 7}), Eigen::Vector3d(3.3, 4.4, 0));
  EXPECT_LT((executed(motion, {10, 0, 0}, {-20, 0, 0}) - Eigen::Vector3d(9.5, 0, 0)).norm(), 1e-12);
}

TEST(Vehicle, BrakesWithinItsBrakingPath) {
  const Motion motion = motion_in(inertia(5));
  Drawn draw;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d start_mps = draw.vector(14);
    const Eigen::Vector3d path_m = braking_path_m(motion, start_mps);
    Eigen::Vector3d v_mps = start_mps, x_m(0, 0, 0);
    for (int tick = 0; tick < 41; ++tick) {
      const Eigen::Vector3d next_mps = executed(motion, v_mps, {0, 0, 0});
      x_m += mean_velocity(motion, v_mps, next_mps) * 0.1;
      v_mps = next_mps;
    }
    ASSERT_TRUE(v_mps.isZero(0));
    ASSERT_LE(x_m.norm(), path_m.norm() + 1e-9);
    ASSERT_GE(x_m.norm(), path_m.norm() - 0.5 * 0.1 * start_mps.norm()) << "one tick longer";
    ASSERT_NEAR(x_m.cross(path_m).norm(), 0, 1e-9);
  }
  EXPECT_NEAR(longest_braking_path_m(motion), 20 * 20 / (2 * 5.0), 1e-9);
}

TEST(Vehicle, TurnsByNoMoreThanItsRateAndMovesNoSlowerThanItMust) {
  for (const VehicleLimits& kind : {unicycle(1), unicycle(40), wings(0.35), wings(4)}) {
    const Motion motion = motion_in(kind);
    Drawn draw;
    Eigen::Vector3d v_mps = first_velocity(motion, {100, 100, 0});
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d wanted_mps = draw.vector(draw.between(0, 1) < 0.5 ? 1 : 60);
      const Eigen::Vector3d next_mps = executed(motion, v_mps, wanted_mps);
      ASSERT_LE(std::abs(angle_between(v_mps, next_mps)), kind.max_turn_radps * 0.1 + 1e-9);
      ASSERT_LE(next_mps.norm(), 20 * (1 + 1e-12));
      ASSERT_GE(next_mps.norm(), std::max(kind.min_speed_mps, 2e-8) * (1 - 1e-12));
      ASSERT_EQ(executed(motion, v_mps, next_mps), next_mps) << "it can reach what it has reached";
      const Eigen::Vector3d mean_mps = mean_velocity(motion, v_mps, next_mps);
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
  const Motion motion = motion_in(unicycle(1));
  const Eigen::Vector3d drives_mps(6, 8, 0);
  Eigen::Vector3d v_mps = executed(motion, drives_mps, {0, 0, 0});
  EXPECT_LT(v_mps.norm(), 1e-7);
  EXPECT_NEAR(angle_between(drives_mps, v_mps), 0, 1e-12);
  EXPECT_TRUE(mean_velocity(motion, drives_mps, v_mps).isZero(0)) << "it does not creep";
  const Eigen::Vector3d behind_mps = -10 * drives_mps;
  int ticks = 0;
  for (; ticks < 100 && v_mps.norm() < 1; ++ticks) {
    const Eigen::Vector3d next_mps = executed(motion, v_mps, behind_mps);
    if (std::abs(angle_between(next_mps, behind_mps)) > 1.6) {
      ASSERT_TRUE(mean_velocity(motion, v_mps, next_mps).isZero(0));
    }
    v_mps = next_mps;
  }
  EXPECT_NEAR(ticks * 0.1, 3.14159 / 2, 0.15) << "until its way is ahead of it";
}

TEST(Vehicle, LoitersAboutACentreThatStays) {
  for (const VehicleLimits& kind : {wings(0.35), wings(4), wings(0.05, 2)}) {
    const Motion motion = motion_in(kind);
    Drawn draw;
    Eigen::Vector3d x_m(700, 300, 0), v_mps = draw.vector(14);
    v_mps = executed(motion, {8, 0, 0}, v_mps);
    const Eigen::Vector3d center_m = anchor_m(motion, x_m, v_mps);
    EXPECT_NEAR((center_m - x_m).norm(), kind.min_speed_mps / kind.max_turn_radps, 1e-9);
    for (int tick = 0; tick < 10000; ++tick) {
      const Eigen::Vector3d next_mps = executed(motion, v_mps, {0, 0, 0});
      x_m += mean_velocity(motion, v_mps, next_mps) * 0.1;
      v_mps = next_mps;
      ASSERT_LT((anchor_m(motion, x_m, v_mps) - center_m).norm(), 1e-8);
    }
  }
}

TEST(Vehicle, WithWingsBeginsWithItsLoiterCircleInTheDomain) {
  const Motion motion = motion_in(wings(0.35));
  const double radius_m = 8 / 0.35;
  const Box room = room_to_begin(motion);
  EXPECT_NEAR(room.origin_m.x(), radius_m, 1e-9);
  EXPECT_NEAR(room.size_m.y(), 2000 - 2 * radius_m, 1e-9);
  Drawn draw;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d x_m =
        room.nearest(Eigen::Vector3d(draw.between(-200, 2200), draw.between(-200, 2200), 0));
    const Eigen::Vector3d center_m = anchor_m(motion, x_m, first_velocity(motion, x_m));
    ASSERT_LT((room.nearest(center_m) - center_m).norm(), 1e-9);
    ASSERT_NEAR((center_m - x_m).norm(), radius_m, 1e-9);
  }
}

TEST(Vehicle, LeavesTheStraightWayOfItsAnchorByNoMoreThanItsBound) {
  for (const VehicleLimits& kind : {unicycle(1), unicycle(5), wings(1), wings(5, 15)}) {
    const Motion motion = motion_in(kind);
    Drawn draw;
    double most_m = 0;
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d now_mps = executed(motion, {8, 0, 0}, draw.vector(30));
      const Eigen::Vector3d next_mps = executed(motion, now_mps, draw.vector(60));
      const double turn = angle_between(now_mps, next_mps);
      const Eigen::AngleAxisd half(turn / 2, Eigen::Vector3d::UnitZ());
      const auto anchor = [&](double share, const Eigen::Vector3d& v_mps) {
        return anchor_m(motion, place_within_m(motion, {0, 0, 0}, now_mps, next_mps, share), v_mps);
      };
      const Eigen::Vector3d middle_m = (anchor(0, now_mps) + anchor(1, next_mps)) / 2;
      most_m = std::max(most_m, (anchor(0.5, half * now_mps) - middle_m).norm());
    }
    EXPECT_LE(most_m, bulge_m(motion) * (1 + 1e-9));
    EXPECT_GE(most_m, bulge_m(motion) * 0.9) << "and the bound is close";
  }
}

}  // namespace
}  // namespace ergocast
