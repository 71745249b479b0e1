// SPDX-License-Identifier: BSD-3-Clause
// A plan is refused if its mission breaks a limit, or if its parts do not belong together.
#include "plan/mission_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/motion/walls.h"
#include "tests/plan/rich_mission.h"
#include "tests/plan/taken_plan.h"

namespace ergocast {
namespace {

using test::has;
using test::is_taken;
using test::problem_of;
using test::rich_mission;
using test::rich_mission_in_space;
using test::with_false_alarms;
using test::with_free_domain;
using test::with_inertia;
using test::with_lease;
using test::with_places;
using test::with_sites;
using test::with_stations;
using test::with_walls;
using test::with_wings;

/// The mission with changed walls.
Mission with_changed_walls(const Mission& mission, const std::function<void(Rings&)>& change) {
  Mission changed = with_walls(mission);
  Rings walls = changed.walls;
  change(walls);
  changed.walls = std::move(walls);
  return changed;
}

// The computation of modes relies on this.
TEST(HostilePlan, SteersByModesOnlyWithAllThatBelongsToThem) {
  ASSERT_TRUE(is_taken(with_free_domain(rich_mission())));
  constexpr void (*kBroken[])(Mission&) = {
      [](Mission& m) { m.basis.table_hash = 0; },
      [](Mission& m) { m.basis.free_domain = false; },
      [](Mission& m) { m.basis.free_domain = false, m.basis.table_hash = 0; },
      [](Mission& m) { m.basis.free_domain = false, m.cosine_target = {}; },
      [](Mission& m) { m.cosine_target = {}; },
      [](Mission& m) { m.cosine_target.conservativeResize(5); },
      [](Mission& m) { m.cosine_target[0] = 0.5; },
      [](Mission& m) { m.cosine_target[3] = 1.001; },
      [](Mission& m) { m.cosine_target[3] = std::nan(""); },
      [](Mission& m) { m.kinds[0].footprint_sigma_m = 1; },
      [](Mission& m) { m.kinds[1].band_from = 1; },
      [](Mission& m) { m.kinds[1].band_to = 2; },
      [](Mission& m) {  // more than anybody computes
        m.basis.modes_x = 21;
        m.basis.modes_y = 20;
        m.target_coefficients = m.cosine_target = Coefficients::Unit(420, 0);
      },
  };
  for (std::size_t i = 0; i < std::size(kBroken); ++i) {
    Mission mission = with_free_domain(rich_mission());
    kBroken[i](mission);
    EXPECT_FALSE(is_taken(mission)) << "change " << i;
  }
  EXPECT_FALSE(within_limits(with_free_domain(rich_mission_in_space())));
}

TEST(HostilePlan, InAPlaneHasNoHeights) {
  ASSERT_TRUE(within_limits(rich_mission()));
  constexpr void (*kHigh[])(Mission&) = {
      [](Mission& m) { m.domain.origin_m.z() = 5; },
      [](Mission& m) { m.law.contraction_center_m.z() = 5; },
      [](Mission& m) { m.starts_m[1].z() = 5; },
      [](Mission& m) {
        m.basis.modes_z = 2;
        m.target_coefficients.setZero(m.basis.mode_count());
        m.target_coefficients[0] = 1;
      },
  };
  for (const auto change : kHigh) {
    Mission mission = rich_mission();
    change(mission);
    EXPECT_FALSE(is_taken(mission));
  }
}

TEST(HostilePlan, InABoxKeepsToItsHeights) {
  ASSERT_TRUE(is_taken(rich_mission_in_space()));
  constexpr void (*kBroken[])(Mission&) = {
      [](Mission& m) { m.domain.size_m.z() = -53; },
      [](Mission& m) { m.domain.size_m.z() = 1e-4, m.domain.origin_m.z() = 0; },
      [](Mission& m) { m.domain.origin_m.z() = -5.4e6, m.law.contraction_gain_per_s = 0; },
      [](Mission& m) { m.starts_m[1].z() = 46.1; },
      [](Mission& m) { m.starts_m[0].z() = -7.1; },
      [](Mission& m) { m.law.u_max_mps = 425; },  // longer steps than the height
      [](Mission& m) { m.law.contraction_center_m.z() = 1.1e13; },
      [](Mission& m) { m.law.contraction_center_m.z() = 1e5; },  // too strong a pull
      [](Mission& m) { m.basis.modes_z = 3; },                   // μ has less
      [](Mission& m) {
        m.basis.modes_x = m.basis.modes_y = kMaxModesPerAxis;
        m.target_coefficients.setZero(m.basis.mode_count());
        m.target_coefficients[0] = 1;
      },
  };
  for (std::size_t i = 0; i < std::size(kBroken); ++i) {
    Mission mission = rich_mission_in_space();
    kBroken[i](mission);
    EXPECT_FALSE(within_limits(mission)) << "change " << i;
  }
}

/// A domain in which nothing is too fast, and nothing pulls.
void widen(Mission& m) {
  m.domain.size_m = {1e7, 1e7, 0};
  m.law.contraction_gain_per_s = 0;
}
/// One more mode than there may be, μ as large.
void refine(Mission& m, int modes_x, int modes_y) {
  m.basis.modes_x = modes_x;
  m.basis.modes_y = modes_y;
  m.target_coefficients.setZero(modes_x * modes_y);
  m.target_coefficients[0] = 1;
}
/// Half a step of contraction beyond the centre, for which the input is strong enough.
void pull(Mission& m) {
  m.domain.size_m = {52, 52, 0};
  m.law.contraction_center_m = m.domain.center_m();
  m.law.contraction_gain_per_s = 9.6;
  m.law.u_max_mps = 360;
}

// Each breaks one limit, and as few others as possible.
TEST(HostilePlan, ThatBreaksALimitIsRefused) {
  using Change = void (*)(Mission&);
  constexpr Change kBroken[] = {
      [](Mission& m) { m.name = ""; },
      [](Mission& m) { m.name = "../up"; },
      [](Mission& m) { m.name = "a/b"; },
      [](Mission& m) { m.name = std::string(kMaxNameLength + 1, 'x'); },
      [](Mission& m) {  // 1e5 times the size away
        m.law.contraction_gain_per_s = 0;
        m.domain.origin_m.x() = -1.02e7;
        m.starts_m.assign(2, m.domain.center_m());
      },
      [](Mission& m) { widen(m), m.domain.size_m.y() = 1.1e7; },
      [](Mission& m) {
        m.domain.size_m.y() = 1e-4;
        m.domain.origin_m = {0, 0, 0};
        m.law = {.u_max_mps = 1e-4};
        m.disturbance_intensity = 0;
        m.starts_m.assign(2, m.domain.center_m());
      },
      [](Mission& m) { m.basis.modes_x = 0; },
      [](Mission& m) { m.basis.modes_x = -3, m.basis.modes_y = -2; },
      [](Mission& m) { refine(m, kMaxModesPerAxis + 1, 2); },
      [](Mission& m) { refine(m, 3, kMaxModesPerAxis + 1); },
      [](Mission& m) { m.basis.modes_y = 3; },  // μ has less
      [](Mission& m) { refine(m, 1, 1); },
      [](Mission& m) { m.basis.sobolev_exponent = 0; },
      [](Mission& m) { m.basis.sobolev_exponent = 10.1; },
      [](Mission& m) { m.law.contraction_gain_per_s = m.law.u_max_mps = 0; },
      [](Mission& m) { widen(m), m.law.u_max_mps = 1.1e6; },
      [](Mission& m) { m.law.u_max_mps = 417; },  // longer steps than the domain
      [](Mission& m) { m.law.epsilon = -0.1; },
      [](Mission& m) { m.law.noise_intensity = -0.1; },
      [](Mission& m) { m.law.noise_intensity = 1.6; },  // above the ceiling
      [](Mission& m) { m.law.noise_ceiling = 148; },    // longer steps than the domain
      [](Mission& m) { widen(m), m.law.noise_ceiling = 1.1e6; },
      [](Mission& m) { m.law.perturbation = Perturbation::kConstant; },  // has no ceiling
      [](Mission& m) { m.law.contraction_gain_per_s = 0.5; },            // too strong at the corner
      [](Mission& m) { m.law.contraction_gain_per_s = -0.1; },
      [](Mission& m) { pull(m); },
      [](Mission& m) { m.law.contraction_gain_per_s = 0, m.law.contraction_center_m.x() = 1.1e13; },
      [](Mission& m) { m.law.contraction_gain_per_s = 0, m.law.contraction_center_m.y() = 1.1e13; },
      [](Mission& m) { m.law.anticipation = 100.1; },
      [](Mission& m) { m.law.memory_half_life_s = -1; },
      [](Mission& m) { m.law.memory_half_life_s = 9.9 * m.timing.dt_s; },
      [](Mission& m) { m.law.memory_half_life_s = 1.1e9; },
      [](Mission& m) { m.timing.pace = Pace::kLockstep, m.timing.dt_s = 9e-7; },
      [](Mission& m) { widen(m), m.timing.dt_s = 3601; },
      [](Mission& m) { m.timing.tick_count = 0; },
      [](Mission& m) { m.timing.tick_count = -1; },
      [](Mission& m) { m.timing.tick_count = 80'000'001; },  // 1e7 s
      [](Mission& m) { m.timing.dt_s = 0.01, m.timing.tick_count = 100'000'001; },
      [](Mission& m) { m.timing.tick_count = std::numeric_limits<Tick>::max(); },
      [](Mission& m) { m.timing.broadcast_period_ticks = 0; },
      [](Mission& m) { m.timing.broadcast_period_ticks = 1001; },
      [](Mission& m) { m.timing.high_mode_period_factor = -3; },
      [](Mission& m) { m.timing.high_mode_period_factor = 143; },  // of 7 ticks
      [](Mission& m) { m.timing.realtime_factor = 0.009; },
      [](Mission& m) { m.timing.dt_s = 1e-3, m.timing.realtime_factor = 11; },  // 0.09 ms a step
      [](Mission& m) { m.timing.lockstep_timeout_s = 0; },
      [](Mission& m) { m.timing.admission_timeout_s = 86401; },
      [](Mission& m) { m.timing.command_hold_s = -1; },
      [](Mission& m) { m.timing.catch_up_limit_ticks = -1; },
      [](Mission& m) { m.timing.catch_up_limit_ticks = 1001; },
      [](Mission& m) { m.starts_m[1].x() = 98.1; },  // outside
      [](Mission& m) { m.starts_m.clear(); },
      [](Mission& m) { m.speed_limit_mps = 0; },  // and a distance
      [](Mission& m) { m.separation.distance_m = -1; },
      [](Mission& m) { m.vehicle.max_acceleration_mps2 = 1; },  // of a point
      [](Mission& m) {
        m.vehicle = {VehicleKind::kAcceleration, 1000};
      },  // and errors of places
      [](Mission& m) { m.separation = {}, m.vehicle.kind = VehicleKind::kAcceleration; },
      [](Mission& m) { m = with_wings(m), m.vehicle.max_acceleration_mps2 = 1; },
      [](Mission& m) { m = with_wings(m), m.vehicle.max_turn_radps = 0; },
      [](Mission& m) { m = with_wings(m), m.vehicle.max_turn_radps = 0.01; },
      [](Mission& m) { m = with_wings(m), m.vehicle.min_speed_mps = 0; },
      [](Mission& m) { m = with_wings(m), m.vehicle.min_speed_mps = 5.6; },  // above the input
      [](Mission& m) { m = with_wings(m), m.vehicle.kind = VehicleKind::kUnicycle; },
      [](Mission& m) { m = with_wings(m), m.vehicle.max_turn_radps = 0.7; },  // circles of 0.7 m
      [](Mission& m) { m = with_wings(m), m.starts_m[0].x() = -2.99; },       // too near an edge
      [](Mission& m) { m = with_wings(rich_mission_in_space()); },
      [](Mission& m) { m.kinds[1].vehicle->max_turn_radps = 1; },  // of a point
      [](Mission& m) { m.kinds[1].vehicle->kind = VehicleKind::kAcceleration; },
      [](Mission& m) {
        m.kinds[1].vehicle = {VehicleKind::kAcceleration, 1000};
      },  // and errors of places
      [](Mission& m) { m = with_wings(m), m.kinds[1].vehicle->min_speed_mps = 0; },
      [](Mission& m) { m = with_wings(m), m.kinds[0].speed_limit_mps = 0.5; },  // as slow as it is
      [](Mission& m) { m.kinds[0].speed_limit_mps = -1; },
      [](Mission& m) { m.kinds[0].speed_limit_mps = 7; },  // too slow for the disturbance
      [](Mission& m) { m.speed_limit_mps = 0; },           // which the second kind relies on
      [](Mission& m) {
        m.separation = {}, m.vehicle = {VehicleKind::kAcceleration, 1e-3};
      },
      [](Mission& m) { m.separation.distance_m = 13.1, m.starts_m.resize(1), m.quorum = 1; },
      [](Mission& m) { m.separation.distance_m = 0.9; },  // starts are 1.41 m apart, and 0.6 m off
      [](Mission& m) { m.separation.distance_m = 0; },    // and an error
      [](Mission& m) { m.separation.disturbance_m = 0.26; },  // of steps of 1 m
      [](Mission& m) { m.separation.guard = false; },         // and commands are held for 0.8 s
      [](Mission& m) {
        m.starts_m.assign(kMaxAgents + 1, {17, 20, 0});
      },
      [](Mission& m) { m = with_lease(m), m.separation.guard = true; },
      [](Mission& m) { m = with_lease(m), m.radio_range_m = 60; },
      [](Mission& m) { m = with_lease(m), m.separation.disturbance_m = 0.001; },
      [](Mission& m) { m = with_lease(m), m.separation.lease_s = 0.04; },  // four ticks
      [](Mission& m) { m = with_lease(m), m.separation.lease_s = 101; },
      [](Mission& m) { m = with_lease(m), m.timing.command_hold_s = 0.02; },
      [](Mission& m) { m = with_lease(m), m.separation = {}, m.separation.lease_s = 4; },
      [](Mission& m) { m.kinds[0].reserve_s = 1; },  // of no station
      [](Mission& m) {
        m.kinds[0].battery = {50, 100};
      },  // the same
      [](Mission& m) {
        m = with_stations(m), m.kinds[1].battery = {50, 0};
      },
      [](Mission& m) {
        m = with_stations(m), m.kinds[1].battery = {0, 100};
      },
      [](Mission& m) {
        m = with_stations(m), m.kinds[1].battery = {50, 100, -1};
      },
      [](Mission& m) {
        m = with_stations(m), m.kinds[1].battery = {50, 100, 0, 1};
      },
      [](Mission& m) { m = with_stations(m), m.kinds[1].reserve_s = -1; },
      [](Mission& m) { m = with_stations(m), m.kinds[1].reserve_s = 1e6; },  // than the mission
      [](Mission& m) { m = with_stations(m), m.kinds[1].stations_m[0].x() = 1e6; },
      [](Mission& m) { m = with_stations(m), m.kinds[1].stations_m[0].z() = 1; },  // of a plane
      [](Mission& m) {
        m = with_stations(m), m.kinds[1].stations_m.push_back({30, 30, 0});
      },  // of one agent
      [](Mission& m) {
        m = with_stations(m), m.kinds[0].stations_m = {{25.5, 26, 0}};
      },  // side by side
      [](Mission& m) {
        m = with_stations(with_walls(m)), m.kinds[1].stations_m[0] = {41, 31, 0};
      },
      [](Mission& m) { m.objects.count = 33; },
      [](Mission& m) { m = rich_mission_in_space(), m.objects.count = 1; },
      [](Mission& m) { m = with_places(m), m.objects.count = 1; },
      [](Mission& m) {
        m.objects = {0, {}, 1};
      },  // of none
      [](Mission& m) { m = with_places(m), m.objects.end_when_found = 3; },
      [](Mission& m) { m = with_places(m), m.objects.motion.speed_mps = -1; },
      [](Mission& m) { m = with_places(m), m.objects.motion.speed_mps = 53; },  // in a step too far
      [](Mission& m) { m = with_places(m), m.objects.motion.persistence_s = -1; },
      [](Mission& m) { m = with_places(m), m.objects.motion.speed_mps = 0; },  // and a persistence
      [](Mission& m) { m.objects = {}, m.objects.motion.speed_mps = 1; },      // of no objects
      [](Mission& m) {
        m = with_places(m), m.timing.tick_count = 10000000, m.objects.motion.persistence_s = 0.01;
      },  // too many legs
      [](Mission& m) { m = with_places(m), m.objects.end_when_found = -1; },
      [](Mission& m) { m = with_places(with_stations(m)); },
      [](Mission& m) {
        m = with_places(m), m.objects.places_m.resize(33, {20, 20, 0});
      },
      [](Mission& m) { m = with_places(m), m.objects.places_m[0].x() = 98.1; },  // outside
      [](Mission& m) { m = with_places(m), m.objects.places_m[0].z() = 1; },     // of a plane
      [](Mission& m) {
        m = with_places(with_walls(m)), m.objects.places_m[0] = {41, 31, 0};
      },
      [](Mission& m) { m = with_places(with_false_alarms(m)); },  // ends when found
      [](Mission& m) { m = with_false_alarms(rich_mission_in_space()); },
      [](Mission& m) { m.sensor.position_error_m = 1e4; },
      [](Mission& m) { m.sensor.confirm_at = 1; },
      [](Mission& m) { m.sensor.false_alarms_per_s = -1; },
      [](Mission& m) { m.sites.row_period_ticks = 3; },  // of no sites
      [](Mission& m) { m.sites.count = 1; },             // and a distance
      [](Mission& m) { m = with_sites(m), m.sites.count = -1; },
      [](Mission& m) { m = with_sites(m), m.sites.count = 3; },  // of two agents
      [](Mission& m) { m = with_sites(m), m.sites.row_period_ticks = -1; },
      [](Mission& m) { m = with_sites(m), m.radio_range_m = 60; },
      [](Mission& m) { m = with_sites(m), m.dead_reckoning = false; },
      [](Mission& m) { m = with_sites(m), m.law.memory_half_life_s = 321; },
      [](Mission& m) { m = with_sites(m), m.law.anticipation = 0; },
      [](Mission& m) {
        m = with_sites(m), m.kinds.clear(), m.starts_m.assign(2049, {17, 20, 0});
      },                                           // 1025 at a site
      [](Mission& m) { m.wall_clearance_m = 1; },  // of no walls
      [](Mission& m) { m = with_walls(rich_mission_in_space()); },
      [](Mission& m) { m = with_walls(m), m.wall_clearance_m = -1; },
      [](Mission& m) { m = with_walls(m), m.wall_clearance_m = 0.29; },  // errors of 0.15 m
      [](Mission& m) {
        m = with_walls(m), m.starts_m[0] = {41, 31, 0};
      },
      [](Mission& m) {
        m = with_walls(m), m.starts_m[0] = {38.3, 35, 0};
      },
      [](Mission& m) { m = with_changed_walls(m, [](Rings& walls) { walls[0].resize(2); }); },
      [](Mission& m) { m = with_changed_walls(m, [](Rings& walls) { walls[0].clear(); }); },
      [](Mission& m) {
        m = with_changed_walls(m, [](Rings& walls) { std::swap(walls[0][0], walls[0][1]); });
      },
      [](Mission& m) {
        m = with_changed_walls(m, [](Rings& walls) { std::swap(walls[1], walls[2]); });
      },  // a room elsewhere
      [](Mission& m) {
        m = with_changed_walls(m, [](Rings& walls) { walls[2][0] = {50, 40}; });
      },  // crosses
      [](Mission& m) { m = with_changed_walls(m, [](Rings& walls) {
                         walls[2][0] = {1200, 12};
                       }); },
      [](Mission& m) {
        m = with_changed_walls(m, [](Rings& walls) { walls[2][1] = walls[2][0]; });
      },
      [](Mission& m) {
        m = with_changed_walls(m, [](Rings& walls) {
          walls[2].resize(kMaxWallVertices, {75, 15});
        });
      },
      [](Mission& m) { m = with_walls(with_inertia(m)); },  // and a disturbance
      [](Mission& m) { m.quorum = 0; },
      [](Mission& m) { m.quorum = 3; },
      [](Mission& m) { m.forget_silent_after_s = -1; },
      [](Mission& m) { m.goal_ergodic_metric = -1; },
      [](Mission& m) { m.disturbance_intensity = -1; },
      [](Mission& m) { m.disturbance_intensity = 148; },  // longer steps than the domain
      [](Mission& m) { widen(m), m.disturbance_intensity = 1.1e6; },
      [](Mission& m) { m.radio_range_m = -1; },
      [](Mission& m) { m.speed_limit_mps = -1; },
  };
  for (std::size_t i = 0; i < std::size(kBroken); ++i) {
    Mission mission = rich_mission();
    kBroken[i](mission);
    EXPECT_FALSE(within_limits(mission)) << "change " << i;
    EXPECT_TRUE(has(problem_of(encode_plan(mission)), "breaks that version's rules"))
        << "change " << i << ": " << problem_of(encode_plan(mission));
  }
  EXPECT_TRUE(is_taken(with_walls(rich_mission())));
  EXPECT_TRUE(is_taken(with_sites(rich_mission())));
  Mission crowd = with_sites(rich_mission());
  crowd.kinds.clear();
  crowd.starts_m.assign(2048, {17, 20, 0});
  EXPECT_TRUE(is_taken(crowd));
  Mission wide = rich_mission();
  widen(wide);
  EXPECT_TRUE(is_taken(wide));
}

}  // namespace
}  // namespace ergocast
