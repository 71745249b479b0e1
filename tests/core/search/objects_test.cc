// SPDX-License-Identifier: BSD-3-Clause
// Objects to find: where they are, and how often sensors detect them, against closed forms.
#include "core/measure/objects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "core/measure/detection.h"
#include "core/measure/target_mass.h"

namespace ergocast {
namespace {

constexpr int kMissions = 2000;

/// A mission in a square of 100 m, with most of the target at small x.
Mission square(std::uint64_t seed) {
  Mission mission;
  mission.seed = seed;
  mission.domain = {{-20, 30, 0}, {100, 100, 0}};
  mission.basis.modes_x = mission.basis.modes_y = 8;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.target_coefficients[mission.basis.modes_y] = 0.25;  // p V = 1 + ½ cos(πx/100)
  mission.timing.dt_s = 0.1;
  mission.sensor = {.radius_m = 10, .detections_per_s = 0.5};
  mission.objects.count = 4;
  return mission;
}

/// Four standard deviations of a share of so many.
double tolerance(double share, double count) { return 4 * std::sqrt(share * (1 - share) / count); }

TEST(Objects, AreDrawnFromTheTarget) {
  std::map<int, int> left;  // by object
  for (std::uint64_t seed = 0; seed < kMissions; ++seed) {
    const Mission mission = square(seed);
    const auto places_m = Objects(mission).places_m();
    ASSERT_EQ(places_m.size(), 4u);
    for (int object = 0; object < 4; ++object) {
      const Eigen::Vector3d& x_m = places_m[static_cast<std::size_t>(object)];
      EXPECT_TRUE(mission.domain.contains(x_m));
      EXPECT_NE(x_m, places_m[static_cast<std::size_t>((object + 1) % 4)]);
      if (x_m.x() < 30) ++left[object];
    }
  }
  const double share = 0.5 + 0.5 / std::numbers::pi;  // ∫ over the left half
  for (int object = 0; object < 4; ++object)
    EXPECT_NEAR(left[object] / double{kMissions}, share, tolerance(share, kMissions)) << object;
}

TEST(Objects, AreWhereSeedAndPlanPutThem) {
  EXPECT_EQ(Objects(square(5)).places_m(), Objects(square(5)).places_m());
  EXPECT_NE(Objects(square(5)).places_m(), Objects(square(6)).places_m());
  Mission fewer = square(5), placed = square(5);
  fewer.objects.count = 2;
  EXPECT_EQ(Objects(fewer).places_m()[1], Objects(square(5)).places_m()[1]);
  placed.objects = {0, {{1, 40, 0}, {2, 50, 0}}};
  EXPECT_EQ(Objects(placed).places_m(), placed.objects.places_m);
}

TEST(Objects, AreOutsideWalls) {
  const Ring wall{{-19, 31}, {79, 31}, {79, 128.9}, {-19, 128.9}};
  const Ring room{{10.1, 50.2}, {15.3, 50.2}, {15.3, 54.7}, {10.1, 54.7}};
  int in_room = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Mission mission = square(seed);
    mission.walls = {wall, room};
    const Objects objects(mission);
    for (const Eigen::Vector3d& x_m : objects.places_m()) {
      const bool inside = contains(room, x_m.head<2>());
      in_room += inside ? 1 : 0;
      EXPECT_TRUE(inside || !contains(wall, x_m.head<2>())) << x_m.transpose();
    }
  }
  EXPECT_GT(in_room, 0);
}

/// Over many seeds, objects at a known place that agents have in reach for a time.
double share_found(int agents, Tick ticks, double off_m) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < kMissions; ++seed) {
    Mission mission = square(seed);
    mission.objects = {0, {{20, 60, 0}}};
    Objects objects(mission);
    Finds finds(1);
    for (Tick tick = 0; tick < ticks; ++tick) {
      for (AgentId id = 0; id < agents; ++id) {
        const Eigen::Vector3d x_m(20 + off_m, 60, 0);
        finds.note(objects.detected(id, tick, x_m), {.agent = id, .tick = tick, .x_m = x_m});
      }
    }
    found += static_cast<int>(finds.list().size());
  }
  return found / double{kMissions};
}

TEST(Objects, AreFoundAsOftenAsTheTimeInReachSays) {
  for (const auto& [agents, ticks] : {std::pair(1, 1), {1, 10}, {1, 40}, {3, 10}}) {
    const double share = 1 - std::exp(-0.5 * agents * ticks * 0.1);
    EXPECT_NEAR(share_found(agents, ticks, 9.99), share, tolerance(share, kMissions))
        << agents << " agents, " << ticks << " ticks";
  }
  EXPECT_EQ(share_found(2, 20, 10.01), 0);
}

TEST(Objects, AreDetectedByAFunctionOfThePlace) {
  Mission mission = square(3);
  mission.objects = {0, {{20, 60, 0}, {20.5, 60, 0}}};
  Objects one(mission), other(mission);
  int both = 0, any = 0;
  for (Tick tick = 0; tick < 4000; ++tick) {
    const ObjectSet set = one.detected(7, tick, {21, 60, 0});
    EXPECT_EQ(set, other.detected(7, tick, {21, 60, 0})) << "in any order, by any world";
    both += set == 3 ? 1 : 0;
    any += set != 0 ? 1 : 0;
  }
  const double p = 1 - std::exp(-0.05);
  EXPECT_NEAR(both / 4000.0, p * p, tolerance(p * p, 4000)) << "each by its own chance";
  EXPECT_NEAR(any / 4000.0, 1 - (1 - p) * (1 - p), tolerance(2 * p, 4000));
}

TEST(Finds, AreTheFirstDetectionsOfWhatExists) {
  Finds finds(2);
  EXPECT_EQ(finds.known(0xffffffff), 3u);
  EXPECT_EQ(Finds(32).known(0xffffffff), 0xffffffff);
  EXPECT_EQ(Finds().known(0xffffffff), 0u);
  finds.note(0b110, {.agent = 4, .tick = 8});
  finds.note(0b111, {.agent = 3, .tick = 9});
  finds.note(0b011, {.agent = 2, .tick = 10});
  ASSERT_EQ(finds.list().size(), 2u);
  EXPECT_EQ(finds.list()[0].object, 1);
  EXPECT_EQ(finds.list()[0].agent, 4);
  EXPECT_EQ(finds.list()[1].object, 0);
  EXPECT_EQ(finds.list()[1].tick, 9);
}

}  // namespace
}  // namespace ergocast
