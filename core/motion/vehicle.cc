// SPDX-License-Identifier: BSD-3-Clause
// Points take every velocity up to their limit at once; others change it by A dt a tick, or turn by
// at most ω dt.
#include "core/motion/vehicle.h"

#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"
#include "core/mission/kinds.h"

namespace ergocast {
namespace {

/// A velocity is cut to this share of the limit, so that rounding does not cut it again.
constexpr double kCutShare = 1 - 5e-13;
/// The tolerance for rounding in changes of velocity and in whole ticks of braking.
constexpr double kRounding = 1e-9;
/// The speed of a unicycle that stands, as a share of its limit.
constexpr double kStandingShare = 1e-9;

/// The greatest change of velocity in a tick [m/s].
double most_change_mps(const Motion& motion) {
  return motion.vehicle.max_acceleration_mps2 * motion.dt_s;
}

Eigen::Vector3d within_limit(const Motion& motion, const Eigen::Vector3d& v_mps) {
  Eigen::Vector3d possible_mps = v_mps;
  if (motion.domain.planar()) possible_mps.z() = 0;
  if (length_of(possible_mps) <= motion.speed_limit_mps) return possible_mps;
  return within_speed(possible_mps, kCutShare * motion.speed_limit_mps);
}

Eigen::Vector3d accelerated(const Motion& motion, const Eigen::Vector3d& now_mps,
                            const Eigen::Vector3d& aim_mps) {
  const Eigen::Vector3d change_mps = aim_mps - now_mps;
  const double most_mps = most_change_mps(motion);
  if (length_of(change_mps) <= most_mps * (1 + kRounding)) return aim_mps;
  return now_mps + within_speed(change_mps, most_mps);
}

Eigen::Vector3d heading_of(const Eigen::Vector3d& v_mps) {
  const double speed_mps = length_of(v_mps);
  return speed_mps > 0 ? Eigen::Vector3d(v_mps / speed_mps) : Eigen::Vector3d(1, 0, 0);
}

/// J of a vector in the plane.
Eigen::Vector3d to_the_left(const Eigen::Vector3d& v) { return {-v.y(), v.x(), 0}; }

double least_speed_mps(const Motion& motion) {
  return motion.vehicle.kind == VehicleKind::kUnicycle ? kStandingShare * motion.speed_limit_mps
                                                       : motion.vehicle.min_speed_mps;
}

/// The velocity after a turn towards the aim: as fast as the aim's part along the new heading.
Eigen::Vector3d turned(const Motion& motion, const Eigen::Vector3d& now_mps,
                       const Eigen::Vector3d& aim_mps) {
  const double most = motion.vehicle.max_turn_radps * motion.dt_s / 2;
  const double least_mps = least_speed_mps(motion), aim_speed_mps = length_of(aim_mps);
  const Eigen::Vector3d h = heading_of(now_mps);
  // With the whole angle to the aim, sin / (1 + cos) is the tangent of its half.
  const double aside_mps = to_the_left(h).dot(aim_mps), ahead_mps = aim_speed_mps + h.dot(aim_mps);
  const bool in_reach = ahead_mps > 0 && std::abs(aside_mps) <= most * ahead_mps * (1 + kRounding);
  if (in_reach && aim_speed_mps >= least_mps * (1 - kRounding)) return aim_mps;
  const bool stops = aim_speed_mps == 0 && motion.vehicle.kind == VehicleKind::kUnicycle;
  if (stops) return least_mps * h;
  const double t = in_reach ? aside_mps / ahead_mps : std::copysign(most, aside_mps);
  const Eigen::Vector3d next = ((1 - t * t) * h + 2 * t * to_the_left(h)) / (1 + t * t);
  return std::max(least_mps, next.dot(aim_mps)) * next;
}

/// The velocity of a standing unicycle only shows where it looks.
Eigen::Vector3d mean_of_turn(const Motion& motion, const Eigen::Vector3d& now_mps,
                             const Eigen::Vector3d& then_mps) {
  const double speed_mps = length_of(then_mps);
  if (stands(motion, then_mps)) return {0, 0, 0};
  return speed_mps / 2 * (heading_of(now_mps) + heading_of(then_mps));
}

}  // namespace

bool stands(const Motion& motion, const Eigen::Vector3d& v_mps) {
  return length_of(v_mps) <= 2 * kStandingShare * motion.speed_limit_mps;
}

Motion motion_of_kind(const Mission& mission, int kind) {
  return {vehicle_of(mission, kind), speed_limit_mps(mission, kind), mission.timing.dt_s,
          mission.domain};
}

Motion motion_of(const Mission& mission, AgentId id) {
  return motion_of_kind(mission, planned_kind(mission, id));
}

bool can_drive(const Mission& mission, int kind, AgentId id) {
  const Motion brought = motion_of_kind(mission, kind), body = motion_of(mission, id);
  return brought.vehicle == body.vehicle && brought.speed_limit_mps == body.speed_limit_mps;
}

std::optional<std::string> why_not_of_kind(const Mission& mission, const std::string& name,
                                           AgentId id) {
  const std::optional<int> known = kind_named(mission, name);
  if (name.empty() || (known && (id == kUnassigned || can_drive(mission, *known, id))))
    return std::nullopt;
  if (known) {
    return "an agent of the kind \"" + name + "\" cannot drive number " + std::to_string(id) +
           ": that is a vehicle of the kind " + name_of_kind(mission, planned_kind(mission, id));
  }
  const std::string unknown = "the mission has no kind \"" + name + "\"";
  if (mission.kinds.empty()) return unknown + ": all its agents are alike, so name none";
  std::string names;
  for (const AgentKind& kind : mission.kinds) names += (names.empty() ? "" : ", ") + kind.name;
  return unknown + ": its kinds are " + names;
}

bool any_but_points(const Mission& mission) {
  bool any = !motion_of_kind(mission, 0).is_point();
  for (int kind = 1; kind < std::ssize(mission.kinds); ++kind)
    any = any || !motion_of_kind(mission, kind).is_point();
  return any;
}

double fastest_mps(const Mission& mission) {
  double fastest_mps = motion_of_kind(mission, 0).speed_limit_mps;
  for (int kind = 1; kind < std::ssize(mission.kinds); ++kind)
    fastest_mps = std::max(fastest_mps, motion_of_kind(mission, kind).speed_limit_mps);
  return fastest_mps;
}

Eigen::Vector3d within_speed_limit(const Motion& motion, const Eigen::Vector3d& v_mps) {
  Eigen::Vector3d possible_mps = v_mps;
  if (motion.domain.planar()) possible_mps.z() = 0;
  if (motion.speed_limit_mps <= 0) return possible_mps;
  return within_speed(possible_mps, motion.speed_limit_mps);
}

Eigen::Vector3d executed(const Motion& motion, const Eigen::Vector3d& now_mps,
                         const Eigen::Vector3d& wanted_mps) {
  switch (motion.vehicle.kind) {
    case VehicleKind::kAcceleration:
      return accelerated(motion, now_mps, within_limit(motion, wanted_mps));
    case VehicleKind::kUnicycle:
    case VehicleKind::kFixedWing:
      return turned(motion, now_mps, within_limit(motion, wanted_mps));
    case VehicleKind::kPoint:
      break;
  }
  return within_speed_limit(motion, wanted_mps);
}

Eigen::Vector3d mean_velocity(const Motion& motion, const Eigen::Vector3d& now_mps,
                              const Eigen::Vector3d& then_mps) {
  switch (motion.vehicle.kind) {
    case VehicleKind::kAcceleration:
      return 0.5 * (now_mps + then_mps);
    case VehicleKind::kUnicycle:
    case VehicleKind::kFixedWing:
      return mean_of_turn(motion, now_mps, then_mps);
    case VehicleKind::kPoint:
      break;
  }
  return then_mps;
}

Eigen::Vector3d first_velocity(const Motion& motion, const Eigen::Vector3d& x_m) {
  if (motion.vehicle.kind != VehicleKind::kFixedWing) return {0, 0, 0};
  const bool center_is_left = x_m.x() > motion.domain.center_m().x();
  return {0, center_is_left ? motion.vehicle.min_speed_mps : -motion.vehicle.min_speed_mps, 0};
}

Box room_to_begin(const Motion& motion) {
  const double radius_m = loiter_radius_m(motion);
  if (radius_m == 0) return motion.domain;
  Box room = motion.domain;
  room.origin_m.head<2>().array() += radius_m;
  room.size_m.head<2>().array() -= 2 * radius_m;
  return room;
}

double loiter_radius_m(const Motion& motion) {
  const VehicleLimits& vehicle = motion.vehicle;
  return vehicle.kind == VehicleKind::kFixedWing ? vehicle.min_speed_mps / vehicle.max_turn_radps
                                                 : 0;
}

Eigen::Vector3d anchor_m(const Motion& motion, const Eigen::Vector3d& x_m,
                         const Eigen::Vector3d& v_mps) {
  const double radius_m = loiter_radius_m(motion);
  return radius_m == 0 ? x_m : Eigen::Vector3d(x_m + radius_m * to_the_left(heading_of(v_mps)));
}

double reach_m(const Motion& motion, double max_speed_mps) {
  return (max_speed_mps + motion.vehicle.min_speed_mps) * motion.dt_s +
         longest_braking_path_m(motion);
}

Eigen::Vector3d braking_path_m(const Motion& motion, const Eigen::Vector3d& v_mps) {
  if (motion.vehicle.kind != VehicleKind::kAcceleration) return {0, 0, 0};
  const double ticks = length_of(v_mps) / most_change_mps(motion);
  return 0.5 * motion.dt_s * std::ceil(ticks * (1 - kRounding)) * v_mps;
}

double longest_braking_path_m(const Motion& motion) {
  return length_of(braking_path_m(motion, {motion.speed_limit_mps, 0, 0}));
}

double bulge_m(const Motion& motion) {
  const VehicleLimits& vehicle = motion.vehicle;
  // The anchor's acceleration; in a turn it is the speed times the rate.
  const double most_mps2 =
      vehicle.max_acceleration_mps2 +
      (motion.speed_limit_mps + vehicle.min_speed_mps) * vehicle.max_turn_radps;
  return most_mps2 * motion.dt_s * motion.dt_s / 8;
}

}  // namespace ergocast
