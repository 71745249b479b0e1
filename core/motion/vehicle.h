// SPDX-License-Identifier: BSD-3-Clause
// How a vehicle executes a command in one tick: the same for agents, world, laboratory, ideal team
// and driver.
//
// kPoint: the command is the velocity of the whole tick, x' = x + v dt.
// For all others the command is the velocity v' at the tick's end, and the state is (x, v).
//
// kAcceleration: the acceleration a = (v' − v)/dt is constant within the tick, ‖a‖ ≤ A, and
//   x' = x + (v + v')/2 dt.
// kUnicycle, kFixedWing: the vehicle looks along the unit vector h = v/‖v‖ and moves along it. Its
// speed s = ‖v'‖ may change at once. Within the tick it moves along an arc. With t, the tangent of
// half the angle from h to h', |t| ≤ ω dt/2:
//
//     h' = ((1 − t²) h + 2t J h)/(1 + t²),  x' = x + s dt (h + h')/2
//
//   J is a quarter turn to the left. Only + − × ÷ √: the same bits on every machine. The radius
//   s dt/2|t| is at least s/ω, the rate of turn at most ω, and the speed s·arctan(t)/t at most s.
//   A unicycle can turn on the spot. A standing one has the velocity kStandingShare V h, which
//   shows where it looks and does not move it. Without any velocity it looks along x.
//   A fixed wing moves no slower than s_min. For a command of 0 it loiters: it turns to the left as
//   tightly as it can, about its loiter centre c = x + r J h, r = s_min/ω, which then stays.
//
// ‖v‖ ≤ V, the vehicle's speed limit, at every moment.
//
// The vehicle belongs to a body, and so to its number. Only motion_of() determines it. It does not
// depend on the process that drives the body, nor on anything that happened before.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/mission/mission.h"

namespace ergocast {

/// What a vehicle can do, in the ticks and the domain of its mission.
struct Motion {
  VehicleLimits vehicle;
  double speed_limit_mps = 0;  ///< V; 0: none
  double dt_s = 0.1;
  Box domain;

  bool is_point() const { return vehicle.kind == VehicleKind::kPoint; }
  bool has_inertia() const { return vehicle.kind == VehicleKind::kAcceleration; }
};

/// The motion of agents of `kind`: their own vehicle and limit, or the scenario's where they have
/// none. A kind that the mission does not have gets the scenario's.
Motion motion_of_kind(const Mission& mission, int kind);

/// The motion of the body with the number `id`: that of its planned kind, or of the first kind
/// beyond the plan.
Motion motion_of(const Mission& mission, AgentId id);

/// Whether an agent of `kind` can drive the body `id`: the body's kind is the same, or moves alike.
bool can_drive(const Mission& mission, int kind, AgentId id);

/// A sentence that explains why no agent of the kind `name` can take part under the number `id`,
/// whose body may be another vehicle. Nothing if one can, or if `name` is empty.
/// @param id  kUnassigned: any number
std::optional<std::string> why_not_of_kind(const Mission& mission, const std::string& name,
                                           AgentId id);

/// Whether a vehicle with the velocity `v_mps` stands: the velocity of a standing unicycle only
/// shows where it looks.
bool stands(const Motion& motion, const Eigen::Vector3d& v_mps);

/// Whether any body of the mission is no point.
bool any_but_points(const Mission& mission);

/// The highest speed limit of all bodies of the mission; 0 if none has one.
double fastest_mps(const Mission& mission);

/// The velocity that a point executes for the command `v_mps`: the command, bit for bit, or the
/// speed limit in its direction. In a plane v_z is ignored. @pre v_mps is finite.
Eigen::Vector3d within_speed_limit(const Motion& motion, const Eigen::Vector3d& v_mps);

/// The velocity at the tick's end that comes nearest to the command `wanted_mps`, for a vehicle
/// that now has `now_mps`. A velocity that it can reach is returned bit for bit. In a plane v_z is
/// ignored.
/// @pre both are finite
Eigen::Vector3d executed(const Motion& motion, const Eigen::Vector3d& now_mps,
                         const Eigen::Vector3d& wanted_mps);

/// (x' − x)/dt of a step whose velocity changes from `now_mps` to `then_mps`.
Eigen::Vector3d mean_velocity(const Motion& motion, const Eigen::Vector3d& now_mps,
                              const Eigen::Vector3d& then_mps);

/// The velocity of a vehicle that begins at `x_m`. A fixed wing has its loiter circle in the
/// domain.
Eigen::Vector3d first_velocity(const Motion& motion, const Eigen::Vector3d& x_m);

/// Where vehicles may begin: the domain; for fixed wings without a margin of r at its edges.
Box room_to_begin(const Motion& motion);

/// r for a fixed wing, else 0 [m].
double loiter_radius_m(const Motion& motion);

/// The anchor: the point that stops at once under commands of 0. It is the loiter centre of a fixed
/// wing, else the vehicle's place. A vehicle with inertia also needs its braking path.
Eigen::Vector3d anchor_m(const Motion& motion, const Eigen::Vector3d& x_m,
                         const Eigen::Vector3d& v_mps);

/// How far the anchor of a vehicle with speed limit `max_speed_mps` moves in a tick, at most [m].
/// With inertia it is the end of the braking path.
double reach_m(const Motion& motion, double max_speed_mps);

/// The path of a vehicle with inertia until it stands, if it brakes as evenly as A allows in k
/// whole ticks: ½ v dt k. Commands of 0 stop it on this path. 0 for other vehicles.
Eigen::Vector3d braking_path_m(const Motion& motion, const Eigen::Vector3d& v_mps);

/// The length of the longest braking path, at the speed limit [m].
double longest_braking_path_m(const Motion& motion);

/// By how much the anchor within a tick is away from a straight, even motion between its two ends,
/// at most [m].
double bulge_m(const Motion& motion);

}  // namespace ergocast
