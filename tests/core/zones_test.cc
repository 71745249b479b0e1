// SPDX-License-Identifier: BSD-3-Clause
// Zones: which are possible, which bodies they bind, that nobody enters one, and that a body inside
// leaves it in time. Each flaw must be seen to break that.
#include "core/motion/zones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/mission/station.h"
#include "core/motion/home.h"
#include "core/motion/push.h"
#include "core/motion/separation.h"
#include "core/motion/starts.h"
#include "core/motion/way_home.h"
#include "core/motion/way_out.h"
#include "tests/core/vehicles.h"

namespace ergocast {
namespace {

using namespace test;

constexpr double kSide_m = 300;
constexpr Tick kClosed = 100, kFrom = 600, kUntil = 1500, kEnd = 1600;

Ring box(double x_m, double y_m, double width_m, double height_m) {
  return {{x_m, y_m}, {x_m + width_m, y_m}, {x_m + width_m, y_m + height_m}, {x_m, y_m + height_m}};
}

Zone zone(Ring corners_m, std::int32_t number = 0) {
  return {number, kClosed, kFrom, kUntil, std::move(corners_m)};
}

/// Two that overlap, one of them not convex, and one at the domain's edge.
std::vector<Zone> overlapping() {
  return {zone({{60, 60}, {180, 60}, {180, 100}, {100, 100}, {100, 180}, {60, 180}}),
          zone(box(150, 40, 60, 90), 1), zone(box(240, 200, 90, 60), 2)};
}

TEST(Zone, HasCornersAnAreaAndTicksInTheirOrder) {
  const Box plane{{0, 0, 0}, {300, 200, 0}}, space{{0, 0, 0}, {300, 200, 50}};
  EXPECT_TRUE(is_zone(zone(box(10, 10, 50, 50)), plane));
  EXPECT_TRUE(is_zone(zone(box(290, 190, 50, 50)), plane)) << "it may go beyond the domain";
  EXPECT_FALSE(is_zone(zone(box(10, 10, 50, 50)), space)) << "it has no heights";
  Zone tall = zone(box(10, 10, 50, 50));
  tall.high_m = 20;
  EXPECT_TRUE(is_zone(tall, space));
  EXPECT_FALSE(is_zone(tall, plane));
  tall.low_m = 20;
  EXPECT_FALSE(is_zone(tall, space));
  tall.low_m = 50, tall.high_m = 60;
  EXPECT_FALSE(is_zone(tall, space)) << "it is above the domain";
  const Ring broken[] = {{},
                         {{0, 0}, {10, 10}},
                         {{0, 0}, {10, 10}, {10, 0}, {0, 10}},
                         {{0, 0}, {0, 0}, {10, 10}, {0, 10}},
                         {{0, 0}, {10, 10}, {5, 5 + 1e-9}},
                         {{0, 0}, {10, 10}, {0, std::nan("")}},
                         {{0, 0}, {10, 10}, {0, INFINITY}},
                         box(-4000, 0, 10, 10),
                         Ring(kMaxZoneCorners + 1, {1, 1})};
  for (std::size_t i = 0; i < std::size(broken); ++i)
    EXPECT_FALSE(is_zone(zone(broken[i]), plane)) << i;
  for (const auto& [closed, from, until] :
       {std::tuple<Tick, Tick, Tick>{-1, 5, 9}, {6, 5, 9}, {1, 9, 9}, {1, 2, kMaxZoneTicks + 3}}) {
    Zone odd = zone(box(10, 10, 50, 50));
    odd.closed = closed, odd.from = from, odd.until = until;
    EXPECT_FALSE(is_zone(odd, plane)) << closed << ' ' << from << ' ' << until;
  }
}

TEST(Zone, ThereAreEightAtMostAndTheirNumbersAscend) {
  const Box plane{{0, 0, 0}, {300, 200, 0}};
  std::vector<Zone> zones;
  for (int i = 0; i < 8; ++i) zones.push_back(zone(box(10, 10, 50, 50), i));
  EXPECT_TRUE(are_zones(zones, plane));
  zones[3].number = 2;
  EXPECT_FALSE(are_zones(zones, plane));
  zones[3].number = 3;
  zones.push_back(zone(box(10, 10, 50, 50), 8));
  EXPECT_FALSE(are_zones(zones, plane));
}

TEST(Zone, BindsABodyOnceItsWholeWayToAStandIsOutside) {
  const Mission mission = mission_of(inertia(5), kSide_m);
  const Motion motion = motion_of(mission, 0);
  const std::vector<Zone> zones = {zone(box(100, 100, 50, 50))};
  const auto leaves = [&](const Eigen::Vector3d& x_m, const Eigen::Vector3d& v_mps, Tick tick) {
    return must_leave(zones, tick, mission, motion, holding_way(motion, x_m, v_mps));
  };
  EXPECT_TRUE(leaves({120, 120, 0}, {0, 0, 0}, kClosed));
  EXPECT_FALSE(leaves({120, 120, 0}, {0, 0, 0}, kClosed - 1));
  EXPECT_FALSE(leaves({120, 120, 0}, {0, 0, 0}, kUntil));
  EXPECT_FALSE(leaves({80, 120, 0}, {0, 0, 0}, kClosed));
  EXPECT_FALSE(leaves({80, 120, 0}, {10, 0, 0}, kClosed)) << "it stands after ten metres";
  EXPECT_TRUE(leaves({80, 120, 0}, {20, 0, 0}, kClosed)) << "it stands after forty";
  EXPECT_FALSE(leaves({80, 120, 0}, {0, 20, 0}, kClosed));
  EXPECT_TRUE(leaves({155, 120, 0}, {-20, 0, 0}, kClosed));
}

TEST(Zone, OfABoxBindsWhatIsBesideAboveOrBelow) {
  Zone tall = zone(box(100, 100, 50, 50));
  tall.low_m = 20, tall.high_m = 40;
  const auto at = [&](double x_m, double z_m) { return StraightWay{{x_m, 120, z_m}, {0, 0, 0}}; };
  EXPECT_FALSE(lies_outside(tall, at(120, 30), 0));
  EXPECT_TRUE(lies_outside(tall, at(120, 45), 5));
  EXPECT_FALSE(lies_outside(tall, at(120, 44), 5));
  EXPECT_TRUE(lies_outside(tall, at(120, 10), 10));
  EXPECT_TRUE(lies_outside(tall, at(95, 30), 5));
  EXPECT_TRUE(is_inside(tall, {120, 120, 30}));
  EXPECT_FALSE(is_inside(tall, {120, 120, 41}));
}

// ---- bodies that want to be inside ----

struct Attack {
  Mission mission;
  std::vector<Zone> zones = overlapping();
  std::vector<Zone> known = zones;  ///< that the filter knows
  bool leave = true;                ///< or stay as in a pause
  int bodies = 30;
};

struct Result {
  int entered = 0;       ///< bodies that were outside, and then inside
  int late = 0;          ///< bodies inside at kFrom
  int inside_then = 0;   ///< bodies inside at kClosed
  int inside_after = 0;  ///< after the end
  double nearest_m = 1e9;
};

bool in_any(const std::vector<Zone>& zones, const Eigen::Vector3d& x_m) {
  return std::ranges::any_of(zones, [&](const Zone& one) { return is_inside(one, x_m); });
}

Result attack(const Attack& task) {
  const Mission& mission = task.mission;
  const Motion motion = motion_of(mission, 0);
  SeparationFilter filter(mission, 0);
  filter.set_zones(task.known);
  WayOut way(mission, 0, task.zones);
  Drawn draw;
  Result result;
  const double limit_mps = motion.speed_limit_mps > 0 ? motion.speed_limit_mps : 40;
  for (AgentId id = 0; id < task.bodies; ++id) {
    Eigen::Vector3d x_m = start_of(mission, 4 + id), goal_m = x_m;
    Eigen::Vector3d v_mps = first_velocity(motion, x_m);
    std::vector<bool> outside(task.zones.size(), false);
    for (Tick tick = 0; tick < kEnd; ++tick) {
      const bool inside = in_any(task.zones, x_m);
      if (tick == kClosed) result.inside_then += inside ? 1 : 0;
      if (tick == kFrom) result.late += inside ? 1 : 0;
      if (tick == kEnd - 1) result.inside_after += inside ? 1 : 0;
      const StraightWay holding = holding_way(motion, x_m, v_mps);
      for (std::size_t i = 0; i < task.zones.size(); ++i) {
        const bool closed = task.zones[i].closed_at(tick);
        const bool within = is_inside(task.zones[i], x_m);
        if (closed && outside[i] && within) ++result.entered;
        outside[i] = closed && !within &&
                     (outside[i] ||
                      lies_outside(task.zones[i], holding, bound_from_zones_m(mission, motion)));
        if (closed && !within)
          result.nearest_m = std::min(result.nearest_m, beside_m(task.zones[i], holding));
      }
      if (draw.between(0, 1) < 0.02)
        goal_m = {draw.between(0, kSide_m), draw.between(0, kSide_m),
                  draw.between(0, mission.domain.size_m.z())};
      Eigen::Vector3d wanted_mps = within_speed(10 * (goal_m - x_m), limit_mps);
      if (must_leave(task.zones, tick, mission, motion, holding))
        wanted_mps = task.leave ? way.velocity_mps(tick, x_m, v_mps) : Eigen::Vector3d(0, 0, 0);
      const Eigen::Vector3d command_mps =
          filter.safe({id, tick, x_m, limit_mps, v_mps}, wanted_mps, {}).velocity_mps;
      const Eigen::Vector3d next_mps = executed(motion, v_mps, command_mps);
      const Eigen::Vector3d mean_mps = mean_velocity(motion, v_mps, next_mps);
      x_m =
          reflect(moved(mission, id, tick, x_m, mean_mps, {task.known, next_mps}), mission.domain);
      v_mps = next_mps;
    }
  }
  return result;
}

TEST(ZoneFilter, LetsNobodyInAndAllOut) {
  const VehicleLimits kinds[] = {{}, inertia(5), inertia(40), unicycle(1), wings(1.5)};
  for (const VehicleLimits& kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.kind));
    Attack task{mission_of(kind, kSide_m)};
    const Result result = attack(task);
    EXPECT_EQ(result.entered, 0);
    EXPECT_EQ(result.late, 0);
    EXPECT_GT(result.inside_then, 3) << "some have to leave";
    EXPECT_GT(result.inside_after, 3) << "it ends by itself";
    EXPECT_LT(result.nearest_m, 40) << "they do come near";
    task.known.erase(task.known.begin() + 1);
    EXPECT_GT(attack(task).entered, 0) << "each zone counts";
    task = {mission_of(kind, kSide_m)};
    task.leave = false;
    EXPECT_GT(attack(task).late, 0) << "no body leaves that is not led";
  }
}

TEST(ZoneFilter, CountsTheBrakingWay) {
  Attack task{mission_of(inertia(5), kSide_m)};
  EXPECT_EQ(attack(task).entered, 0);
}

TEST(ZoneFilter, NeedsNoSpeedLimit) {
  Attack task{mission_of({}, kSide_m)};
  task.mission.speed_limit_mps = 0;
  const Result result = attack(task);
  EXPECT_EQ(result.entered, 0);
  EXPECT_EQ(result.late, 0);
}

TEST(ZoneFilter, KeepsTheClearanceOfWallsAndLeadsRoundThem) {
  Attack task{mission_of({}, kSide_m)};
  task.mission.wall_clearance_m = 3;
  // A wall with its back to the nearest side of the first zone.
  task.mission.walls = {box(70, 40, 5, 120), box(220, 130, 10, 40)};
  const Result result = attack(task);
  EXPECT_EQ(result.entered, 0);
  EXPECT_EQ(result.late, 0);
  EXPECT_GE(result.nearest_m, 0);
}

TEST(ZoneFilter, StopsWhatTheWorldPushes) {
  Attack task{mission_of({}, kSide_m)};
  task.mission.disturbance_intensity = 3;
  EXPECT_EQ(attack(task).entered, 0);
  task.mission.vehicle = inertia(5);
  EXPECT_EQ(attack(task).entered, 0);
}

TEST(ZoneFilter, LetsNobodyIntoAPrism) {
  for (const VehicleLimits& kind : {VehicleLimits{}, inertia(5)}) {
    Attack task{mission_of(kind, kSide_m)};
    task.mission.domain.size_m.z() = 80;
    for (Zone& one : task.zones) one.low_m = 20, one.high_m = 60;
    task.zones[1].low_m = -10, task.zones[1].high_m = 30;
    task.known = task.zones;
    const Result result = attack(task);
    EXPECT_EQ(result.entered, 0);
    EXPECT_EQ(result.late, 0);
    EXPECT_GT(result.inside_then, 2);
    task.mission.disturbance_intensity = 2;
    EXPECT_EQ(attack(task).entered, 0);
  }
}

TEST(ZoneFilter, LeavesCommandsFarFromZonesAsTheyAre) {
  const Mission mission = mission_of({}, kSide_m);
  SeparationFilter filter(mission, 0);
  filter.set_zones(overlapping());
  const Eigen::Vector3d wanted_mps(3.3, -7.1, 0);
  EXPECT_EQ(filter.safe({0, 700, {30, 280, 0}, 20, {0, 0, 0}}, wanted_mps, {}).velocity_mps,
            wanted_mps);
}

// ---- which are possible ----

std::string why_not(const Mission& mission, const Zone& one, std::span<const Zone> others = {}) {
  const auto problem = zone_problem(mission, one, others);
  return problem ? problem->what : "";
}

Mission with_station(const Eigen::Vector3d& home_m) {
  Mission mission = mission_of({}, kSide_m);
  mission.kinds = {{.name = "all", .count = 4, .u_max_mps = 5, .stations_m = {home_m}}};
  return mission;
}

TEST(Zone, IsRefusedWhereItLeavesNoWay) {
  const Mission mission = mission_of({}, kSide_m);
  EXPECT_EQ(why_not(mission, zone(box(50, 50, 100, 100))), "");
  EXPECT_EQ(why_not(mission, zone(box(250, 250, 100, 100))), "");
  EXPECT_NE(why_not(mission, zone(box(350, 350, 100, 100))).find("outside of the domain"),
            std::string::npos);
  EXPECT_NE(
      why_not(mission, zone({{330, 280}, {350, 250}, {350, 350}, {250, 350}})).find("outside"),
      std::string::npos);
  EXPECT_NE(why_not(mission, zone(box(-1, -1, 302, 302))).find("no place"), std::string::npos);
  const std::vector<Zone> half = {zone(box(-1, -1, 150, 302))};
  EXPECT_NE(why_not(mission, zone(box(100, -1, 201, 302), 1), half).find("no place"),
            std::string::npos);
}

TEST(Zone, IsRefusedOverAStationOrAroundIt) {
  EXPECT_NE(why_not(with_station({100, 100, 0}), zone(box(50, 50, 100, 100)))
                .find("covers the station of agent 0"),
            std::string::npos);
  EXPECT_EQ(why_not(with_station({20, 100, 0}), zone(box(50, 50, 100, 100))), "");
  EXPECT_NE(why_not(with_station({20, 100, 0}), zone(box(50, -1, 20, 302))).find("cuts"),
            std::string::npos);
  EXPECT_EQ(why_not(with_station({200, 100, 0}), zone(box(50, -1, 20, 302))), "");
  const std::vector<Zone> lower = {zone(box(50, -1, 20, 200))};
  EXPECT_NE(why_not(with_station({20, 100, 0}), zone(box(50, 150, 20, 200), 1), lower).find("cuts"),
            std::string::npos);
}

TEST(Zone, IsRefusedIfAnotherOneClosesItsOnlyWayOut) {
  const Mission mission = mission_of({}, kSide_m);
  // A corner of the domain, behind a zone.
  const std::vector<Zone> around = {
      zone({{-9, 60}, {60, 60}, {60, -9}, {90, -9}, {90, 90}, {-9, 90}})};
  EXPECT_NE(why_not(mission, zone(box(-9, -9, 75, 75), 1), around).find("no way leads out"),
            std::string::npos);
}

TEST(Zone, NeedsNoticeForTwiceTheWay) {
  const Mission mission = mission_of({}, kSide_m);
  const double u_mps = home_speed_mps(mission, 0);
  const Tick small = least_notice_ticks(mission, zone(box(50, 50, 40, 40)), {});
  const Tick large = least_notice_ticks(mission, zone(box(50, 50, 160, 160)), {});
  EXPECT_GE(static_cast<double>(small) * mission.timing.dt_s, 2 * 20 / u_mps);
  EXPECT_NEAR(static_cast<double>(large - small) * mission.timing.dt_s, 2 * 60 / u_mps,
              2 * 10 / u_mps);
}

TEST(WayHome, LeadsRoundZones) {
  const Mission mission = with_station({250, 150, 0});
  WayHome straight(mission, 0), round(mission, 0);
  const std::vector<Zone> zones = {zone(box(100, 100, 100, 100))};
  round.note_zones(mission, zones);
  const Eigen::Vector3d from_m(50, 150, 0);
  EXPECT_GT(round.needed_s(from_m), straight.needed_s(from_m) + 20 / home_speed_mps(mission, 0));
  SeparationFilter filter(mission, 0);
  filter.set_zones(zones);
  Eigen::Vector3d x_m = from_m;
  const double dt_s = mission.timing.dt_s;
  const auto needed = static_cast<Tick>(round.needed_s(from_m) / dt_s);
  for (Tick tick = kClosed; tick < kClosed + needed; ++tick)
    x_m += dt_s * filter.safe({0, tick, x_m, 20, {0, 0, 0}}, round.velocity_mps(x_m, {0, 0, 0}), {})
                      .velocity_mps;
  EXPECT_LT((x_m - Eigen::Vector3d(250, 150, 0)).norm(), 1);
  const auto late = round.needed_s(from_m) - dt_s;
  const auto counted = rest_from(mission, 0) - static_cast<Tick>(late / dt_s);
  EXPECT_TRUE(round.begun(counted, from_m));
  round.note_zones(mission, {});
  EXPECT_FALSE(round.begun(counted, from_m)) << "the way is shorter now";
  EXPECT_EQ(round.needed_s(from_m), straight.needed_s(from_m)) << "the zone has ended";
}

}  // namespace
}  // namespace ergocast
