// SPDX-License-Identifier: BSD-3-Clause
// Every field of a mission, once: its number in the plan, its name in scenario.proto, its limits.
//
// list_fields(io, mission) visits them in the order of scenario.proto. The visitors are the limits
// (plan/mission_limits.cc), the plan's writer and reader (plan/plan.cc), the conversion of
// scenarios and their rules (scenario/parse/convert.cc, scenario/parse/fields.cc) and the text
// (logger/mission_text.cc).
//
// A number in the plan is that of plan/plan.proto, unique within its part. A name with a dot is
// that of a field in a block, such as agents.quorum.
#pragma once

#include <concepts>
#include <initializer_list>
#include <type_traits>

#include "core/mission/mission.h"
#include "plan/mission_limits.h"

namespace ergocast {

/// The words of an enumeration in scenario.proto, in the order of its values in
/// core/mission/mission.h.
using Words = std::initializer_list<const char*>;

/// The kinds of fields: number in the plan, name, value. A visitor derives from this class, which
/// ignores every field, and hides the functions that it uses.
struct FieldVisitor {
  /// If the last argument is false, the number is 0 and in no scenario.
  void number(int, const char*, auto&, const Limits&, bool = true) {}
  /// If the number equals the last argument, plans and texts omit it.
  void number_unless(int, const char*, auto&, const Limits&, double) {}
  /// A number along z. In a plane it equals the last argument and is in no scenario.
  void height(int, const char*, auto&, const Limits&, double) {}
  void flag(int, const char*, auto&) {}
  /// If the last argument is false, the choice is its first word, and a text omits it.
  void choice(int, const char*, auto&, Words, bool = true) {}
  void seed(int, const char*, auto&) {}
  void name(int, const char*, auto&) {}
  void part(int, const char*, auto&) {}
  void contraction_center(int, int, auto&) {}  ///< x, and y has the next number; z
  void duration(int, auto&) {}     ///< Timing::tick_count, which follows from a duration
  void target(int, auto&) {}       ///< μ: agents receive it, so only one processor rounds it
  void starts(int, int, auto&) {}  ///< x and y of each; z
  void stations(int, int, const char*, auto&) {}  ///< as starts(), for a kind; may be empty
  void kinds(int, const char*, auto&) {}          ///< each as a part of its own
  void kind_name(int, const char*, auto&) {}
  void own_vehicle(int, const char*, auto&) {}  ///< a part that may be absent
  void walls(int, const char*, auto&) {}        ///< rings
  void hidden_flag(int, auto&) {}               ///< in no scenario
  void hash(int, auto&) {}                      ///< of a file; in no scenario
  void other_target(int, auto&) {}              ///< μ in cosines; empty where target() is that
};

template <class T, class Part>
concept MaybeConst = std::same_as<std::remove_const_t<T>, Part>;

void list_fields(auto& io, MaybeConst<Box> auto& domain) {
  io.number(1, "origin_x_m", domain.origin_m.x(), limits::kCoordinate_m);
  io.number(2, "origin_y_m", domain.origin_m.y(), limits::kCoordinate_m);
  io.number(3, "size_x_m", domain.size_m.x(), limits::kSize_m);
  io.number(4, "size_y_m", domain.size_m.y(), limits::kSize_m);
  io.height(5, "origin_z_m", domain.origin_m.z(), limits::kCoordinate_m, 0);
  io.height(6, "size_z_m", domain.size_m.z(), limits::kSize_m, 0);
}

void list_fields(auto& io, MaybeConst<Basis> auto& basis) {
  io.number(1, "modes_x", basis.modes_x, limits::kModes);
  io.number(2, "modes_y", basis.modes_y, limits::kModes);
  io.flag(3, "normalized", basis.normalized);
  io.choice(4, "sobolev_form", basis.sobolev_form, {"SQUARED_NORM", "NORM"});
  io.number(5, "sobolev_exponent", basis.sobolev_exponent, limits::above(0, 10));
  io.height(6, "modes_z", basis.modes_z, limits::kModes, 1);
  io.flag(7, "free_domain", basis.free_domain);
  io.hash(8, basis.table_hash);
}

void list_fields(auto& io, MaybeConst<ControlLaw> auto& law) {
  const bool adaptive = law.perturbation == Perturbation::kAdaptive;
  io.number(1, "u_max_mps", law.u_max_mps, limits::above(0, 1e6));
  io.choice(2, "regularization", law.regularization, {"ABSOLUTE", "RELATIVE"});
  io.number(3, "epsilon", law.epsilon, limits::between(0, 1e6));
  io.number(5, "noise_intensity", law.noise_intensity, limits::kIntensity);
  io.number(7, "contraction_gain_per_s", law.contraction_gain_per_s, limits::between(0, 1e6));
  io.contraction_center(8, 13, law.contraction_center_m);
  io.choice(4, "perturbation", law.perturbation, {"CONSTANT", "ADAPTIVE"});
  io.number(6, "noise_ceiling", law.noise_ceiling, limits::kIntensity, adaptive);
  io.number(10, "anticipation", law.anticipation, limits::between(0, 100));
  io.flag(11, "ends_with_plan", law.ends_with_plan);
  io.flag(12, "paired_pushes", law.paired_pushes);
}

void list_fields(auto& io, MaybeConst<Timing> auto& timing) {
  io.number(1, "dt_s", timing.dt_s, limits::between(1e-6, 3600));
  io.duration(2, timing);
  io.number(3, "broadcast_period_ticks", timing.broadcast_period_ticks, limits::kPeriod_ticks);
  io.choice(4, "pace", timing.pace, {"LOCKSTEP", "REALTIME"});
  io.number(5, "realtime_factor", timing.realtime_factor, limits::between(0.01, 1000));
  io.number(6, "lockstep_timeout_s", timing.lockstep_timeout_s, limits::kTimeout_s);
  io.choice(10, "on_timeout", timing.on_timeout, {"END_MISSION", "EVICT"});
  io.number(7, "command_hold_s", timing.command_hold_s, limits::between(0, 1e6));
  io.number(8, "admission_timeout_s", timing.admission_timeout_s, limits::kTimeout_s);
  io.number(9, "catch_up_limit_ticks", timing.catch_up_limit_ticks, limits::between(0, 1000));
  io.choice(11, "contribution_encoding", timing.contribution_encoding, {"DOUBLE", "FIXED16"});
  io.number_unless(12, "high_mode_period_factor", timing.high_mode_period_factor,
                   limits::kPeriod_ticks, 1);
}

void list_fields(auto& io, MaybeConst<VehicleLimits> auto& vehicle) {
  const bool moves_at_once = vehicle.kind == VehicleKind::kPoint;
  io.choice(1, "kind", vehicle.kind, {"POINT", "ACCELERATION", "UNICYCLE", "FIXED_WING"},
            !moves_at_once);
  io.number(2, "max_acceleration_mps2", vehicle.max_acceleration_mps2, limits::above(0, 1e6),
            vehicle.max_acceleration_mps2 != 0);
  io.number(3, "max_turn_radps", vehicle.max_turn_radps, limits::above(0, 1e6),
            vehicle.max_turn_radps != 0);
  io.number(4, "min_speed_mps", vehicle.min_speed_mps, limits::above(0, 1e6),
            vehicle.min_speed_mps != 0);
}

/// All are 0 where no distance is kept.
void list_fields(auto& io, MaybeConst<Separation> auto& separation) {
  const bool kept = separation.distance_m != 0;
  io.number(1, "distance_m", separation.distance_m, limits::above(0, 1e7), kept);
  io.number(2, "position_error_m", separation.position_error_m, limits::between(0, 1e7), kept);
  io.number(3, "disturbance_m", separation.disturbance_m, limits::between(0, 1e7), kept);
  io.number(4, "response_s", separation.response_s, limits::between(0, 1e4), kept);
  if (separation.distance_m != 0) io.flag(5, "guard", separation.guard);
  io.number_unless(6, "lease_s", separation.lease_s, limits::between(0, 3600), 0);
}

void list_fields(auto& io, MaybeConst<AgentKind> auto& kind) {
  io.kind_name(1, "name", kind.name);
  io.number(2, "count", kind.count, limits::kTeam);
  io.number(3, "u_max_mps", kind.u_max_mps, limits::above(0, 1e6));
  io.number(4, "noise_intensity", kind.noise_intensity, limits::kIntensity);
  io.number(5, "noise_ceiling", kind.noise_ceiling, limits::kIntensity);
  io.number(6, "footprint_sigma_m", kind.footprint_sigma_m, limits::between(0, 1e7));
  io.number(7, "quality", kind.quality, limits::above(0, 1e6));
  const bool banded = kind.band_from != 0 || kind.band_to != 0;
  io.number(8, "band.from", kind.band_from, limits::kWaveNumber, banded);
  io.number(9, "band.to", kind.band_to, limits::kWaveNumber, kind.band_to != 0);
  io.own_vehicle(10, "vehicle", kind.vehicle);
  io.number(11, "speed_limit_mps", kind.speed_limit_mps, limits::above(0, 1e9),
            kind.speed_limit_mps != 0);
  io.stations(12, 13, "station", kind.stations_m);
  io.number_unless(14, "reserve_s", kind.reserve_s, limits::between(0, 1e7), 0);
}

/// Number 1 of the plan is the version of the program that wrote it.
void list_fields(auto& io, MaybeConst<Mission> auto& m) {
  io.name(2, "name", m.name);
  io.seed(3, "seed", m.seed);
  io.part(4, "domain", m.domain);
  io.target(6, m.target_coefficients);
  io.part(5, "basis", m.basis);
  io.part(7, "law", m.law);
  io.part(8, "time", m.timing);
  io.starts(9, 17, m.starts_m);
  // The greatest field number, and its value is never 0: a truncated plan lacks it.
  io.number(100, "agents.quorum", m.quorum, limits::kTeam);
  io.number(10, "agents.forget_silent_after_s", m.forget_silent_after_s, limits::between(0, 1e6));
  io.flag(15, "agents.dead_reckoning", m.dead_reckoning);
  io.kinds(20, "agents.kind", m.kinds);
  io.number(12, "world.disturbance_intensity", m.disturbance_intensity, limits::kIntensity);
  io.number(13, "world.radio_range_m", m.radio_range_m, limits::between(0, 1e13));
  io.number(14, "world.speed_limit_mps", m.speed_limit_mps, limits::above(0, 1e9),
            m.speed_limit_mps != 0);
  io.walls(21, "world.walls", m.walls);
  io.number(22, "world.wall_clearance_m", m.wall_clearance_m, limits::between(0, 1e7),
            !m.walls.empty());
  io.number(11, "goal_ergodic_metric", m.goal_ergodic_metric, limits::above(0, 1e9),
            m.goal_ergodic_metric != 0);
  io.part(18, "vehicle", m.vehicle);
  io.part(19, "separation", m.separation);
  io.other_target(24, m.cosine_target);
  io.hidden_flag(16, m.wait_for_logger);
}

}  // namespace ergocast
