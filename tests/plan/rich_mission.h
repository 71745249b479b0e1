// SPDX-License-Identifier: BSD-3-Clause
// A mission in which every field has an effect.
#pragma once

#include <algorithm>

#include "plan/mission_fields.h"

namespace ergocast::test {

/// Gives every field of a plane another value than the default, within its limits.
class Enricher : public FieldVisitor {
 public:
  template <class Number>
  void number(const Field& field, Number& value) {
    if (field.when.in_box) return;
    const Limits& limits = field.limits;
    ++count_;
    const double width = std::min(limits.high - limits.low, 10.0);
    value = static_cast<Number>(limits.low + width * count_ / (count_ + 1));
  }
  void flag(const Field&, bool& value) { value = !value; }
  template <class Enum>
  void choice(const Field&, Enum& value, Words words) {
    value = static_cast<Enum>((static_cast<std::size_t>(value) + 1) % words.size());
  }
  void part(const Field&, auto& part) { list_fields(*this, part); }
  void part(const Field&, std::vector<AgentKind>&) {}

 private:
  int count_ = 0;
};

/// A mission with no field at its default and no number twice.
inline Mission rich_mission() {
  Mission mission;
  Enricher enricher;
  list_fields(enricher, mission);
  mission.name = "rich";
  mission.seed = ~std::uint64_t{0};
  mission.domain = {{-3, 4, 0}, {101, 52, 0}};
  mission.basis.modes_x = 3;
  mission.basis.modes_y = 2;
  mission.basis.sobolev_exponent = 1.75;
  mission.basis.free_domain = false;  // kinds have footprints: with_free_domain()
  mission.target_coefficients = Coefficients(6);
  mission.target_coefficients << 1, 0.1, -0.2, 0.3, -0.4, 0.55;
  ControlLaw& law = mission.law;
  law.u_max_mps = 5.5;
  law.epsilon = 0.25;
  law.noise_intensity = 0.75;
  law.noise_ceiling = 1.5;
  law.contraction_gain_per_s = 0.0002;
  law.contraction_center_m = {33, 34, 0};
  law.anticipation = 3.5;
  law.memory_half_life_s = 321.5;
  law.history = TargetHistory::kKeep;
  Timing& timing = mission.timing;
  timing.dt_s = 0.125;
  timing.tick_count = 480;
  timing.broadcast_period_ticks = 7;
  timing.realtime_factor = 2.5;
  timing.lockstep_timeout_s = 11;
  timing.command_hold_s = 0.8;
  timing.admission_timeout_s = 31;
  timing.catch_up_limit_ticks = 6;
  timing.contribution_encoding = ContributionEncoding::kFixed16;
  timing.high_mode_period_factor = 13;
  mission.starts_m = {{17, 20, 0}, {18, 21, 0}};
  mission.kinds = {{"first", 1, 5.25, 0.5, 1.25, 2.5, 0.7, 1, 2.25},
                   {"second-kind", 1, 4.75, 0.625, 1.375, 0, 1.3, 0.5, 0}};
  mission.kinds[0].speed_limit_mps = 7.5;
  mission.kinds[1].vehicle = VehicleLimits();  // a point: not the same as none
  mission.quorum = 2;
  mission.forget_silent_after_s = 12;
  mission.goal_ergodic_metric = 0.03;
  mission.disturbance_intensity = 0.6;
  mission.radio_range_m = 60;
  mission.speed_limit_mps = 8;
  mission.separation.distance_m = 0.65;
  mission.separation.position_error_m = 0.15;
  mission.separation.disturbance_m = 0.22;
  mission.separation.response_s = 1.1;
  mission.separation.lease_s = 0;         // needs bodies with beacons: with_lease()
  mission.wall_clearance_m = 0;           // needs walls: with_walls()
  mission.sensor.false_alarms_per_s = 0;  // needs a plane: with_false_alarms()
  mission.sensor.position_error_m = 0.25;
  mission.sensor.confirm_at = 0.95;
  mission.sites = {};    // need a team without most of these: with_sites()
  mission.vehicle = {};  // inertia allows none of these: with_inertia()
  mission.wait_for_logger = false;
  return mission;
}

/// The same mission in a box.
inline Mission rich_mission_in_space() {
  Mission mission = rich_mission();
  mission.domain.origin_m.z() = -7;
  mission.domain.size_m.z() = 53;
  mission.basis.modes_z = 2;
  mission.target_coefficients.conservativeResize(12);
  mission.target_coefficients.tail(6) << 0.15, -0.25, 0.35, 0.45, -0.05, 0.65;
  mission.law.contraction_center_m.z() = 9;
  mission.starts_m[0].z() = -6;
  mission.starts_m[1].z() = 41;
  mission.law.kind = LawKind::kMow;
  mission.objects = {};  // they need a plane
  return mission;
}

/// The mission with objects at known places; it must be in a plane, and without stations.
inline Mission with_places(Mission mission) {
  mission.objects = {0, {{20, 21, 0}, {22, 23, 0}}, 2, {0.25, 70}};
  return mission;
}

/// The mission with sensors that have false alarms, which does not end by finding; it must be in a
/// plane.
inline Mission with_false_alarms(Mission mission) {
  mission.sensor.false_alarms_per_s = 0.02;
  mission.objects.end_when_found = 0;
  return mission;
}

/// The mission in sites, without what they exclude; it must be in a plane.
inline Mission with_sites(Mission mission) {
  mission.sites = {2, 5};
  mission.law.memory_half_life_s = 0;
  mission.dead_reckoning = true;
  mission.law.kind = LawKind::kCover;
  mission.timing.pace = Pace::kLockstep;
  mission.timing.contribution_encoding = ContributionEncoding::kDouble;
  mission.radio_range_m = 0;
  mission.separation = {};
  mission.objects.end_when_found = 0;
  return mission;
}

/// The mission with vehicles that are no points and know all positions.
inline Mission with_inertia(Mission mission) {
  mission.vehicle = {VehicleKind::kAcceleration, 11};
  mission.kinds[1].vehicle = {VehicleKind::kAcceleration, 12.5};
  mission.separation = {};
  mission.separation.distance_m = 0.65;
  mission.separation.guard = true;
  return mission;
}

/// The mission with bodies that know only their own position, and an unlimited radio range.
inline Mission with_lease(Mission mission) {
  mission.radio_range_m = 0;
  mission.separation.guard = false;
  mission.separation.lease_s = 4.25;
  mission.separation.position_error_m = 0.05;
  mission.separation.disturbance_m = 0;
  mission.timing.dt_s = 0.01;
  mission.timing.command_hold_s = 0;
  return mission;
}

/// The mission with a triangle, and a wall around a room. The room is too small to need an
/// entrance.
inline Mission with_walls(Mission mission) {
  mission.walls = {{{40, 30}, {60, 30}, {60, 45}, {40, 45}},
                   {{45, 35}, {49, 35}, {49, 39}, {45, 39}},
                   {{70, 10}, {80, 12}, {75.5, 20}}};
  mission.wall_clearance_m = 1.75;
  return mission;
}

/// The mission with a station for the second agent.
inline Mission with_stations(Mission mission) {
  mission.kinds[1].stations_m = {{25, 26, mission.domain.planar() ? 0.0 : 12.0}};
  mission.kinds[1].reserve_s = 1.5;
  mission.kinds[1].battery = {50, 100, 90, 0.3};
  mission.objects.end_when_found = 0;  // an end that nobody knows before
  return mission;
}

/// The mission with the modes of its free domain, and sensors that see points.
inline Mission with_free_domain(Mission mission) {
  mission.basis.free_domain = true;
  mission.basis.table_hash = 0xfedcba9876543210;
  mission.cosine_target = -0.5 * mission.target_coefficients;
  mission.cosine_target[0] = 1;
  for (AgentKind& kind : mission.kinds) kind.footprint_sigma_m = kind.band_from = kind.band_to = 0;
  return mission;
}

/// The mission with vehicles that turn slowly and never stand; it must be in a plane.
inline Mission with_wings(Mission mission) {
  mission = with_inertia(std::move(mission));
  mission.vehicle = {VehicleKind::kFixedWing, 0, 13, 0.5};
  mission.kinds[1].vehicle = {VehicleKind::kFixedWing, 0, 14, 0.25};
  return mission;
}

}  // namespace ergocast::test
