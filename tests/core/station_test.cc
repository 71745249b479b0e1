// SPDX-License-Identifier: BSD-3-Clause
#include "core/mission/station.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/geometry.h"
#include "core/motion/home.h"
#include "core/motion/push.h"
#include "core/motion/vehicle.h"
#include "core/motion/way_home.h"

namespace ergocast {
namespace {

/// Three agents at a common station, and one without.
Mission with_station(const VehicleLimits& vehicle = {}) {
  Mission mission;
  mission.domain.size_m = {200, 100, 0};
  mission.basis.modes_x = mission.basis.modes_y = 4;
  mission.law.u_max_mps = 8;
  mission.timing.dt_s = 0.1;
  mission.timing.tick_count = 1000;
  mission.timing.broadcast_period_ticks = 10;
  mission.starts_m = {{150, 80, 0}, {20, 80, 0}, {100, 50, 0}, {30, 30, 0}};
  mission.speed_limit_mps = 10;
  mission.vehicle = vehicle;
  mission.kinds = {{"a", 3, 8, 0, 0}, {"b", 1, 8, 0, 0}};
  mission.kinds[0].stations_m = {{30, 20, 0}};
  mission.kinds[0].reserve_s = 20;
  return mission;
}

Mission with_a_wall(Mission mission) {
  mission.walls = {{{60, -10}, {70, -10}, {70, 80}, {60, 80}}};
  mission.wall_clearance_m = 2;
  return mission;
}

TEST(Station, AnAgentRestsThereFromItsReserveOn) {
  Mission mission = with_station();
  EXPECT_EQ(rest_from(mission, 2), 800);
  EXPECT_FALSE(rests(mission, 2, 799));
  EXPECT_TRUE(rests(mission, 2, 800));
  EXPECT_FALSE(rests(mission, 3, 999));
  EXPECT_FALSE(rests(mission, 4, 999));  // beyond the plan
  mission.kinds[0].reserve_s = 0.05;
  EXPECT_EQ(rest_from(mission, 0), 999);
}

TEST(Station, AnAgentSendsAllOnceMoreBeforeItRests) {
  const Mission mission = with_station();
  Tick tick = 780;
  while (tick < 799) {
    const Tick next = next_broadcast(mission, 1, tick);
    ASSERT_GT(next, tick);
    ASSERT_LE(next, 799);
    tick = next;
  }
  EXPECT_EQ(next_broadcast(mission, 1, 799), 1000);
  EXPECT_LE(next_broadcast(mission, 3, 799), 809);
}

/// Goes home from its start at the latest time, and returns how far from home it is when it has to
/// be there.
double apart_when_due_m(const Mission& mission, AgentId id, double v_mps) {
  WayHome way(mission, id);
  const Motion motion = motion_of(mission, id);
  const Tick rest = rest_from(mission, id);
  Eigen::Vector3d x_m = mission.starts_m[static_cast<std::size_t>(id)];
  Eigen::Vector3d now_mps(v_mps, 0, 0);
  Tick tick = rest - static_cast<Tick>(std::floor(way.needed_s(x_m) / mission.timing.dt_s));
  for (; tick < rest; ++tick) {
    if (!way.begun(tick, x_m)) continue;
    const Eigen::Vector3d then_mps = executed(motion, now_mps, way.velocity_mps(x_m, now_mps));
    x_m = moved(mission, id, tick, x_m, mean_velocity(motion, now_mps, then_mps));
    now_mps = then_mps;
    EXPECT_LE(length_of(now_mps), 8 * (1 + 1e-9));
  }
  return length_of(x_m - *station_of(mission, id));
}

// Each vehicle starts at the latest time that the bound allows.
TEST(WayHome, IsInTimeForEachKindOfVehicle) {
  for (const VehicleLimits& vehicle :
       {VehicleLimits{}, VehicleLimits{VehicleKind::kAcceleration, 3},
        VehicleLimits{VehicleKind::kUnicycle, 0, 0.5},
        VehicleLimits{VehicleKind::kFixedWing, 0, 0.5, 4}}) {
    for (const Mission& mission : {with_station(vehicle), with_a_wall(with_station(vehicle))}) {
      for (AgentId id = 0; id < 3; ++id) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(vehicle.kind) << ", agent " << id
                                        << ", walls " << mission.walls.size());
        EXPECT_LE(apart_when_due_m(mission, id, 8), home_m(mission, id));
      }
    }
  }
}

// A law may ask for more than the vehicle can do.
TEST(WayHome, GoesByTheSpeedOfASlowVehicle) {
  Mission mission = with_station();
  mission.speed_limit_mps = 5;
  EXPECT_EQ(home_speed_mps(mission, 0), 5);
  EXPECT_NEAR(WayHome(mission, 0).needed_s({190, 90, 0}), std::hypot(160, 70) / 5 + 0.2, 1e-9);
  for (AgentId id = 0; id < 3; ++id) {
    EXPECT_LE(apart_when_due_m(mission, id, 5), home_m(mission, id)) << id;
  }
}

TEST(WayHome, BeginsOnceAndBoundsTheTime) {
  const Mission mission = with_station();
  WayHome way(mission, 0);
  const Eigen::Vector3d near_m(30, 20, 0), far_m(190, 90, 0);
  EXPECT_NEAR(way.needed_s(far_m), std::hypot(160, 70) / 8 + 0.2, 1e-9);
  EXPECT_FALSE(way.begun(700, near_m));
  EXPECT_TRUE(way.begun(700, far_m));
  EXPECT_TRUE(way.begun(701, near_m));
}

TEST(WayHome, LeadsAroundWalls) {
  const Mission mission = with_a_wall(with_station());
  const WayHome way(mission, 0);
  const Eigen::Vector3d behind_m(100, 20, 0);
  const double least_m = std::hypot(38, 62) + 10 + std::hypot(30, 62);
  EXPECT_GT(way.needed_s(behind_m), least_m / 8);
  EXPECT_LT(way.needed_s(behind_m), 1.1 * least_m / 8 + 1);
}

TEST(Station, HasToBeAPlaceToStay) {
  const auto fits = [](auto change) {
    Mission mission = with_a_wall(with_station());
    change(mission);
    return stations_fit(mission);
  };
  EXPECT_TRUE(fits([](Mission&) {}));
  EXPECT_FALSE(fits([](Mission& m) { m.kinds[0].stations_m[0].x() = 65; }));
  EXPECT_FALSE(fits([](Mission& m) { m.kinds[0].stations_m[0].x() = 59; }));
  EXPECT_FALSE(fits([](Mission& m) { m.kinds[0].stations_m[0].x() = -1; }));
  EXPECT_FALSE(fits([](Mission& m) { m.kinds[0].stations_m.push_back({40, 20, 0}); }));
  EXPECT_FALSE(fits([](Mission& m) { m.kinds[0].reserve_s = 100; }));
  EXPECT_FALSE(fits([](Mission& m) { m.separation.distance_m = 1; }));  // one for three
}

/// u_max is 8 m/s, so it is home within 1.6 m, and slow below 4 m/s.
TEST(Station, ABatteryIsChargedWhereItsVehicleHasAllButStopped) {
  Mission mission = with_station();
  EXPECT_FALSE(charges(mission, 0, {30, 20, 0}, {0, 0, 0})) << "it has no battery";
  mission.kinds[0].battery = {.capacity_wh = 5, .power_w = 100, .charge_w = 300};
  EXPECT_TRUE(any_battery(mission));
  EXPECT_TRUE(charges(mission, 2, {30, 20, 0}, {0, 0, 0}));
  EXPECT_TRUE(charges(mission, 2, {31.5, 20, 0}, {0, 3.9, 0}));
  EXPECT_FALSE(charges(mission, 2, {31.7, 20, 0}, {0, 0, 0})) << "it is beside its station";
  EXPECT_FALSE(charges(mission, 2, {30, 20, 0}, {0, 4, 0})) << "it passes its station";
  EXPECT_FALSE(charges(mission, 3, {30, 20, 0}, {0, 0, 0})) << "its kind has no battery";
  EXPECT_FALSE(charges(mission, 9, {30, 20, 0}, {0, 0, 0})) << "it is beyond the plan";
}

/// Its circle has a radius of 5 m.
TEST(Station, AFixedWingIsChargedWhileItCirclesAroundItsStation) {
  Mission mission =
      with_station({.kind = VehicleKind::kFixedWing, .max_turn_radps = 1, .min_speed_mps = 5});
  mission.kinds[0].battery = {.capacity_wh = 5, .power_w = 100, .charge_w = 300};
  EXPECT_TRUE(charges(mission, 0, {35, 20, 0}, {0, 5, 0}));
  EXPECT_TRUE(charges(mission, 0, {30, 25, 0}, {-5, 0, 0}));
  EXPECT_FALSE(charges(mission, 0, {30, 20, 0}, {5, 0, 0})) << "it passes its station";
}

}  // namespace
}  // namespace ergocast
