// SPDX-License-Identifier: BSD-3-Clause
// Objects that drift: how far, against the closed form, and what holds them.
#include "core/measure/drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/measure/objects.h"

namespace ergocast {
namespace {

using Eigen::Vector3d;

/// A wide sea in which nothing is near an edge.
Mission sea(std::uint64_t seed = 1) {
  Mission mission;
  mission.seed = seed;
  mission.domain = {{-1e5, -1e5, 0}, {2e5, 2e5, 0}};
  mission.timing.dt_s = 0.5;
  mission.timing.tick_count = 4000;
  mission.sensor.radius_m = 10;
  mission.objects.places_m.assign(kMaxObjects, {10, 20, 0});
  mission.objects.motion = {2, 40};
  return mission;
}

/// A square of 100 m with a wall across, which leaves a gap of 6 m.
Mission rooms(std::uint64_t seed) {
  Mission mission = sea(seed);
  mission.domain = {{-20, 30, 0}, {100, 100, 0}};
  mission.walls = {{{28, 29}, {32, 29}, {32, 77}, {28, 77}},
                   {{28, 83}, {32, 83}, {32, 131}, {28, 131}}};
  mission.objects.places_m.assign(8, {-19, 31, 0});
  return mission;
}

TEST(Drift, GoesAsFarAsAPersistentRandomWalk) {
  for (const double t_s : {5.0, 40.0, 400.0}) {
    double square_m2 = 0, east_m = 0;
    int count = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      const Mission mission = sea(seed);
      Drift drift(mission, mission.objects.places_m);
      for (std::size_t object = 0; object < kMaxObjects; ++object) {
        const Vector3d off_m =
            drift.place_m(object, std::llround(t_s / mission.timing.dt_s)) - Vector3d(10, 20, 0);
        square_m2 += off_m.squaredNorm();
        east_m += off_m.x();
        ++count;
      }
    }
    // Legs make it a little shorter within one leg, and a square varies about as much as its mean.
    const double mean_m2 = mean_square_m2({2, 40}, t_s), deviation_m = std::sqrt(mean_m2 / 2);
    EXPECT_NEAR(square_m2 / count, mean_m2, mean_m2 * (0.02 + 4 / std::sqrt(count))) << t_s;
    EXPECT_NEAR(east_m / count, 0, 4 * deviation_m / std::sqrt(count)) << t_s;
  }
}

TEST(Drift, HasAClosedFormWithTheRightLimits) {
  const ObjectMotion motion{2, 40};
  EXPECT_NEAR(mean_square_m2(motion, 0.01), 4e-4, 4e-7) << "straight at first";
  const double late_m2 = 2 * 4 * 40 * (1e6 - 40);
  EXPECT_NEAR(mean_square_m2(motion, 1e6), late_m2, 1e-9 * late_m2) << "a diffusion at last";
  for (const double distance_m : {0.1, 60.0, 5000.0}) {
    const double t_s = time_to_drift_s(motion, distance_m);
    EXPECT_NEAR(std::sqrt(mean_square_m2(motion, t_s)), distance_m, 1e-6 * distance_m);
    EXPECT_GE(t_s, distance_m / motion.speed_mps);
  }
}

TEST(Drift, MovesAtItsSpeedAndStaysInTheDomainAndOutsideWalls) {
  int through_gap = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Mission mission = rooms(seed);
    Drift drift(mission, mission.objects.places_m);
    const double step_m = mission.objects.motion.speed_mps * mission.timing.dt_s;
    for (std::size_t object = 0; object < mission.objects.places_m.size(); ++object) {
      Vector3d last_m = drift.place_m(object, 0);
      EXPECT_EQ(last_m, mission.objects.places_m[object]);
      int moved = 0;
      for (Tick tick = 1; tick < mission.timing.tick_count; ++tick) {
        const Vector3d x_m = drift.place_m(object, tick);
        ASSERT_TRUE(mission.domain.contains(x_m)) << x_m.transpose();
        ASSERT_FALSE(mission.walls.solid_at(x_m.head<2>())) << x_m.transpose();
        const double way_m = (x_m - last_m).norm();
        ASSERT_LE(way_m, step_m * (1 + 1e-9));
        moved += way_m > 0.99 * step_m ? 1 : 0;
        last_m = x_m;
      }
      EXPECT_GT(moved, 0.95 * static_cast<double>(mission.timing.tick_count)) << "it rarely rests";
      through_gap += last_m.x() > 32 ? 1 : 0;
    }
  }
  EXPECT_GT(through_gap, 20);
}

TEST(Drift, IsAFunctionOfSeedObjectAndTick) {
  const Mission mission = rooms(3);
  Drift forwards(mission, mission.objects.places_m), backwards(mission, mission.objects.places_m);
  std::vector<Vector3d> places_m;
  for (Tick tick = 0; tick < 2000; ++tick) places_m.push_back(forwards.place_m(5, tick));
  for (Tick tick = 1999; tick >= 0; --tick)
    ASSERT_EQ(backwards.place_m(5, tick), places_m[static_cast<std::size_t>(tick)]) << tick;
  EXPECT_NE(forwards.place_m(4, 1999), places_m[1999]) << "each object has its own way";
  Mission other = mission;
  other.seed = 4;
  EXPECT_NE(Drift(other, mission.objects.places_m).place_m(5, 1999), places_m[1999]);
  EXPECT_EQ(forwards.place_m(5, -7), mission.objects.places_m[5]) << "before the start";
}

TEST(Drift, EndsAfterItsLastLeg) {
  Mission mission = rooms(1);
  Drift drift(mission, mission.objects.places_m);
  const Tick last = kMaxLegs / 8 * leg_ticks(mission);
  EXPECT_EQ(drift.place_m(0, last), drift.place_m(0, last + 100000));
  EXPECT_NE(drift.place_m(0, last), drift.place_m(0, last - leg_ticks(mission)));
  EXPECT_EQ(drift_legs(mission), 8 * (4000 / leg_ticks(mission) + 1));
  EXPECT_EQ(leg_ticks(mission), 10) << "an eighth of the persistence";
  mission.objects.motion = {10, 40};
  EXPECT_EQ(leg_ticks(mission), 2) << "an eighth of the shorter side";
}

TEST(Drift, StandsStillWithoutRoom) {
  Mission mission = rooms(1);
  mission.walls = {{{0, 50}, {30, 50}, {30, 80}, {0, 80}},
                   {{10, 60}, {12, 60}, {12, 62}, {10, 62}}};
  Drift drift(mission, {{11, 61, 0}});
  for (Tick tick = 0; tick < 2000; ++tick)
    ASSERT_EQ(drift.place_m(0, tick), Vector3d(11, 61, 0)) << tick;
}

TEST(Drift, MovesWhatSensorsDetect) {
  Mission mission = sea();
  mission.domain = {{-400, -400, 0}, {1000, 1000, 0}};
  mission.sensor.detections_per_s = 1e6;
  mission.objects.places_m = {{10, 20, 0}};
  Objects objects(mission);
  Drift drift(mission, mission.objects.places_m);
  for (Tick tick = 0; tick < 4000; tick += 50) {
    const Vector3d x_m = drift.place_m(0, tick);
    EXPECT_EQ(objects.detected(2, tick, x_m + Vector3d(9.9, 0, 0)), 1u);
    EXPECT_EQ(objects.detected(2, tick, x_m + Vector3d(10.1, 0, 0)), 0u);
    EXPECT_EQ(objects.places_m(), std::vector<Vector3d>{x_m});
  }
  EXPECT_EQ(objects.detected(2, 3950, {10, 20, 0}), 0u) << "it is there no more";
}

}  // namespace
}  // namespace ergocast
