// SPDX-License-Identifier: BSD-3-Clause
// Every field of a mission, once: its number in the plan, its name, its limits, and when it has a
// value of its own. A new field is one entry here.
//
// list_fields(io, mission) visits them in the order of scenario.proto. The visitors:
//   limits                                  plan/mission_limits.cc
//   writer and reader of the plan           plan/plan.cc
//   conversion of scenarios, their rules    scenario/parse/convert.cc, scenario/parse/fields.cc
//   text of a scenario                      logger/mission_text.cc
//
// A field's number is that of plan/plan.proto, unique within its part. A dot in a name separates
// block and field, as in agents.quorum.
#pragma once

#include <concepts>
#include <initializer_list>
#include <type_traits>

#include "core/mission/mission.h"
#include "plan/mission_limits.h"

namespace ergocast {

/// When a field has a value of its own. Only then a scenario's text contains it. A visitor that
/// fills a mission uses only `otherwise`, because the mission does not yet have its values.
struct When {
  bool given = true;
  double otherwise = 0;  ///< its value if it is not given; plans omit this value
  bool in_box = false;   ///< the text of a scenario in a box has the field also if it is not given
};
inline constexpr When kAlways;
/// A field that is not given is 0, false or its first word.
constexpr When only_if(bool given) { return {given}; }
/// The field has a constant default, which a scenario's text omits.
constexpr When unless(auto value, double usual) { return {value != usual, usual}; }
/// The field is along z. In a plane it has the value `in_plane`.
constexpr When unless_in_plane(auto value, double in_plane) {
  return {value != in_plane, in_plane, true};
}

struct Field {
  int number;          ///< in the plan
  const char* name;    ///< in scenario.proto; in plan.proto if scenarios have no such field
  Limits limits = {};  ///< of a number, or of a text's length
  When when = kAlways;
};

/// The words of an enumeration in scenario.proto, in the order of its values in
/// core/mission/mission.h.
using Words = std::initializer_list<const char*>;

/// The kinds of fields. This class ignores every field. A visitor derives from it, and hides the
/// functions for the kinds that it needs.
struct FieldVisitor {
  void number(const Field&, auto&) {}         ///< a double or an int
  void choice(const Field&, auto&, Words) {}  ///< an enumeration
  void flag(const Field&, auto&) {}
  void text(const Field&, auto&) {}  ///< a name
  /// A block of fields, which may be optional, or a list of such blocks.
  void part(const Field&, auto&) {}
  /// One place or several: x and y, then z. For one place, y has the number after that of x.
  void places(const Field&, const Field&, auto&) {}
  /// A field that a scenario has in another form, or not at all. Its conversion is written by hand.
  void derived(const Field&, auto&) {}
};

template <class T, class Part>
concept MaybeConst = std::same_as<std::remove_const_t<T>, Part>;

void list_fields(auto& io, MaybeConst<Box> auto& domain) {
  io.number({1, "origin_x_m", limits::kCoordinate_m}, domain.origin_m.x());
  io.number({2, "origin_y_m", limits::kCoordinate_m}, domain.origin_m.y());
  io.number({3, "size_x_m", limits::kSize_m}, domain.size_m.x());
  io.number({4, "size_y_m", limits::kSize_m}, domain.size_m.y());
  io.number({5, "origin_z_m", limits::kCoordinate_m, unless_in_plane(domain.origin_m.z(), 0)},
            domain.origin_m.z());
  io.number({6, "size_z_m", limits::kSize_m, unless_in_plane(domain.size_m.z(), 0)},
            domain.size_m.z());
}

void list_fields(auto& io, MaybeConst<Basis> auto& basis) {
  io.number({1, "modes_x", limits::kModes}, basis.modes_x);
  io.number({2, "modes_y", limits::kModes}, basis.modes_y);
  io.flag({3, "normalized"}, basis.normalized);
  io.choice({4, "sobolev_form"}, basis.sobolev_form, {"SQUARED_NORM", "NORM"});
  io.number({5, "sobolev_exponent", limits::above(0, 10)}, basis.sobolev_exponent);
  io.number({6, "modes_z", limits::kModes, unless_in_plane(basis.modes_z, 1)}, basis.modes_z);
  io.flag({7, "free_domain"}, basis.free_domain);
  io.derived({8, "table_hash"}, basis.table_hash);
}

void list_fields(auto& io, MaybeConst<ControlLaw> auto& law) {
  const When adaptive = only_if(law.perturbation == Perturbation::kAdaptive);
  // With SEARCH its default may be another one: that of objects that drift.
  const When forgets = {law.memory_half_life_s != 0 || law.kind == LawKind::kSearch};
  io.number({1, "u_max_mps", limits::above(0, 1e6)}, law.u_max_mps);
  io.choice({2, "regularization"}, law.regularization, {"ABSOLUTE", "RELATIVE"});
  io.number({3, "epsilon", limits::between(0, 1e6)}, law.epsilon);
  io.number({5, "noise_intensity", limits::kIntensity}, law.noise_intensity);
  io.number({7, "contraction_gain_per_s", limits::between(0, 1e6)}, law.contraction_gain_per_s);
  io.places({8, "contraction_center_x_m"}, {13, "contraction_center_z_m"},
            law.contraction_center_m);
  io.choice({4, "perturbation"}, law.perturbation, {"CONSTANT", "ADAPTIVE"});
  io.number({6, "noise_ceiling", limits::kIntensity, adaptive}, law.noise_ceiling);
  io.number({10, "anticipation", limits::between(0, 100)}, law.anticipation);
  io.flag({11, "ends_with_plan"}, law.ends_with_plan);
  io.flag({12, "paired_pushes"}, law.paired_pushes);
  io.number({14, "memory_half_life_s", limits::between(0, 1e9), forgets}, law.memory_half_life_s);
  io.choice({15, "history"}, law.history, {"BY_TIME", "KEEP"});
  io.choice({16, "kind"}, law.kind, {"COVER", "MOW", "SEARCH"});
}

void list_fields(auto& io, MaybeConst<Timing> auto& timing) {
  const When not_each_period = unless(timing.high_mode_period_factor, 1);
  io.number({1, "dt_s", limits::between(1e-6, 3600)}, timing.dt_s);
  io.derived({2, "tick_count"}, timing.tick_count);
  io.number({3, "broadcast_period_ticks", limits::kPeriod_ticks}, timing.broadcast_period_ticks);
  io.choice({4, "pace"}, timing.pace, {"LOCKSTEP", "REALTIME"});
  io.number({5, "realtime_factor", limits::between(0.01, 1000)}, timing.realtime_factor);
  io.number({6, "lockstep_timeout_s", limits::kTimeout_s}, timing.lockstep_timeout_s);
  io.choice({10, "on_timeout"}, timing.on_timeout, {"END_MISSION", "EVICT"});
  io.number({7, "command_hold_s", limits::between(0, 1e6)}, timing.command_hold_s);
  io.number({8, "admission_timeout_s", limits::kTimeout_s}, timing.admission_timeout_s);
  io.number({9, "catch_up_limit_ticks", limits::between(0, 1000)}, timing.catch_up_limit_ticks);
  io.choice({11, "contribution_encoding"}, timing.contribution_encoding, {"DOUBLE", "FIXED16"});
  io.number({12, "high_mode_period_factor", limits::kPeriod_ticks, not_each_period},
            timing.high_mode_period_factor);
}

void list_fields(auto& io, MaybeConst<VehicleLimits> auto& vehicle) {
  const When has_inertia = unless(vehicle.max_acceleration_mps2, 0);
  const When turns = unless(vehicle.max_turn_radps, 0);
  const When has_wings = unless(vehicle.min_speed_mps, 0);
  io.choice({1, "kind", {}, only_if(vehicle.kind != VehicleKind::kPoint)}, vehicle.kind,
            {"POINT", "ACCELERATION", "UNICYCLE", "FIXED_WING"});
  io.number({2, "max_acceleration_mps2", limits::above(0, 1e6), has_inertia},
            vehicle.max_acceleration_mps2);
  io.number({3, "max_turn_radps", limits::above(0, 1e6), turns}, vehicle.max_turn_radps);
  io.number({4, "min_speed_mps", limits::above(0, 1e6), has_wings}, vehicle.min_speed_mps);
}

void list_fields(auto& io, MaybeConst<Separation> auto& separation) {
  const When kept = only_if(separation.distance_m != 0);
  const When leased = unless(separation.lease_s, 0);
  io.number({1, "distance_m", limits::above(0, 1e7), kept}, separation.distance_m);
  io.number({2, "position_error_m", limits::between(0, 1e7), kept}, separation.position_error_m);
  io.number({3, "disturbance_m", limits::between(0, 1e7), kept}, separation.disturbance_m);
  io.number({4, "response_s", limits::between(0, 1e4), kept}, separation.response_s);
  io.flag({5, "guard", {}, kept}, separation.guard);
  io.number({6, "lease_s", limits::between(0, 3600), leased}, separation.lease_s);
}

void list_fields(auto& io, MaybeConst<Battery> auto& battery) {
  const When has = only_if(battery.any());
  io.number({1, "capacity_wh", limits::above(0, 1e9), has}, battery.capacity_wh);
  io.number({2, "power_w", limits::above(0, 1e9), has}, battery.power_w);
  io.number({3, "charge_w", limits::between(0, 1e9), unless(battery.charge_w, 0)},
            battery.charge_w);
  io.number({4, "reserve", limits::between(0, 0.9), unless(battery.reserve, Battery().reserve)},
            battery.reserve);
}

void list_fields(auto& io, MaybeConst<AgentKind> auto& kind) {
  const When banded = only_if(kind.band_from != 0 || kind.band_to != 0);
  const When slowed = unless(kind.speed_limit_mps, 0);
  io.text({1, "name", limits::between(1, kMaxKindNameLength)}, kind.name);
  io.number({2, "count", limits::kTeam}, kind.count);
  io.number({3, "u_max_mps", limits::above(0, 1e6)}, kind.u_max_mps);
  io.number({4, "noise_intensity", limits::kIntensity}, kind.noise_intensity);
  io.number({5, "noise_ceiling", limits::kIntensity}, kind.noise_ceiling);
  io.number({6, "footprint_sigma_m", limits::between(0, 1e7)}, kind.footprint_sigma_m);
  io.number({7, "quality", limits::above(0, 1e6)}, kind.quality);
  io.number({8, "band.from", limits::kWaveNumber, banded}, kind.band_from);
  io.number({9, "band.to", limits::kWaveNumber, unless(kind.band_to, 0)}, kind.band_to);
  io.part({10, "vehicle"}, kind.vehicle);
  io.number({11, "speed_limit_mps", limits::above(0, 1e9), slowed}, kind.speed_limit_mps);
  io.places({12, "station"}, {13, "station_heights_m"}, kind.stations_m);
  io.number({14, "reserve_s", limits::between(0, 1e7), unless(kind.reserve_s, 0)}, kind.reserve_s);
  io.part({15, "battery"}, kind.battery);
}

void list_fields(auto& io, MaybeConst<ObjectMotion> auto& motion) {
  const ObjectMotion usual;
  const When moves = only_if(motion.any());
  io.number({1, "speed_mps", limits::above(0, 1e6), moves}, motion.speed_mps);
  io.number({2, "persistence_s", limits::between(1e-6, 1e7),
             unless(motion.persistence_s, usual.persistence_s)},
            motion.persistence_s);
}

void list_fields(auto& io, MaybeConst<HiddenObjects> auto& objects) {
  io.number({1, "count", limits::between(1, kMaxObjects), unless(objects.count, 0)}, objects.count);
  io.places({2, "places"}, {3, "place_heights_m"}, objects.places_m);
  io.number(
      {4, "end_when_found", limits::between(1, kMaxObjects), unless(objects.end_when_found, 0)},
      objects.end_when_found);
  io.part({5, "motion"}, objects.motion);
}

void list_fields(auto& io, MaybeConst<SearchSensor> auto& sensor) {
  const SearchSensor usual;
  io.number({1, "radius_m", limits::between(0, 1e7), unless(sensor.radius_m, usual.radius_m)},
            sensor.radius_m);
  io.number({2, "detections_per_s", limits::above(0, 1e6),
             unless(sensor.detections_per_s, usual.detections_per_s)},
            sensor.detections_per_s);
  io.number({3, "false_alarms_per_s", limits::between(0, 1e6),
             unless(sensor.false_alarms_per_s, usual.false_alarms_per_s)},
            sensor.false_alarms_per_s);
  io.number({4, "position_error_m", limits::between(0, 1e7),
             unless(sensor.position_error_m, usual.position_error_m)},
            sensor.position_error_m);
  io.number({5, "confirm_at", limits::between(0.5, 0.999999),
             unless(sensor.confirm_at, usual.confirm_at)},
            sensor.confirm_at);
}

void list_fields(auto& io, MaybeConst<TeamSites> auto& sites) {
  const TeamSites usual;
  io.number({1, "sites", limits::between(1, kMostSites), unless(sites.count, usual.count)},
            sites.count);
  io.number({2, "site_row_period_ticks", limits::kPeriod_ticks,
             unless(sites.row_period_ticks, usual.row_period_ticks)},
            sites.row_period_ticks);
}

/// Number 1 of the plan is the version of the program that wrote it.
void list_fields(auto& io, MaybeConst<Mission> auto& m) {
  const When limited = unless(m.speed_limit_mps, 0);
  const When has_goal = unless(m.goal_ergodic_metric, 0);
  const When walled = only_if(!m.walls.empty());
  io.text({2, "name", limits::between(1, kMaxNameLength)}, m.name);
  io.derived({3, "seed"}, m.seed);
  io.part({4, "domain"}, m.domain);
  io.derived({6, "target_coefficients"}, m.target_coefficients);
  io.part({5, "basis"}, m.basis);
  io.part({7, "law"}, m.law);
  io.part({8, "time"}, m.timing);
  io.places({9, "agents.starts"}, {17, "start_heights_m"}, m.starts_m);
  // This field has the greatest number and is never 0. So a truncated plan lacks it.
  io.number({100, "agents.quorum", limits::kTeam}, m.quorum);
  io.number({10, "agents.forget_silent_after_s", limits::between(0, 1e6)}, m.forget_silent_after_s);
  io.flag({15, "agents.dead_reckoning"}, m.dead_reckoning);
  io.part({20, "agents.kind"}, m.kinds);
  io.number({12, "world.disturbance_intensity", limits::kIntensity}, m.disturbance_intensity);
  io.number({13, "world.radio_range_m", limits::between(0, 1e13)}, m.radio_range_m);
  io.number({14, "world.speed_limit_mps", limits::above(0, 1e9), limited}, m.speed_limit_mps);
  io.derived({21, "world.walls"}, m.walls);
  io.number({22, "world.wall_clearance_m", limits::between(0, 1e7), walled}, m.wall_clearance_m);
  io.part({26, "world.objects"}, m.objects);
  io.number({11, "goal_ergodic_metric", limits::above(0, 1e9), has_goal}, m.goal_ergodic_metric);
  io.part({18, "vehicle"}, m.vehicle);
  io.part({19, "separation"}, m.separation);
  io.part({25, "sensor"}, m.sensor);
  io.part({27, "team"}, m.sites);
  io.derived({24, "cosine_target"}, m.cosine_target);
  io.derived({16, "wait_for_logger"}, m.wait_for_logger);
}

}  // namespace ergocast
