// SPDX-License-Identifier: BSD-3-Clause
// What zones (core/mission/zones.h) ask of bodies, by geometry alone: world, agents and their
// successors find the same.
//
// A zone binds a body while the body's holding set Q lies outside of it by the clearance; Q is all
// that the body covers while it brakes or loiters (core/motion/separation_pairs.cc). In a box it
// suffices that Q lies beside the zone, or above, or below. The filter keeps a bound body farther
// away than that by what rounding may take, so the body stays bound. A body that no zone binds has
// to leave (core/motion/way_out.h). So each zone counts by itself, and zones may overlap.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "core/base/ids.h"
#include "core/base/rings.h"
#include "core/mission/mission.h"
#include "core/mission/zones.h"
#include "core/motion/vehicle.h"

namespace ergocast {

/// The places [from, from + along].
struct StraightWay {
  Eigen::Vector3d from_m{0, 0, 0}, along_m{0, 0, 0};

  Segment seen_from_above() const { return {from_m.head<2>(), (from_m + along_m).head<2>()}; }
};

/// The holding set of a body.
StraightWay holding_way(const Motion& motion, const Eigen::Vector3d& x_m,
                        const Eigen::Vector3d& v_mps);

/// Outside of a zone by this distance a body's holding set is bound [m]: wall_clearance_m, the
/// radius of the loiter circle, the bulge of the path, and half the margin for rounding.
double bound_from_zones_m(const Mission& mission, const Motion& motion);
/// The distance from a zone that the filter keeps [m]: half the margin for rounding more.
double kept_from_zones_m(const Mission& mission, const Motion& motion);

/// The vector between the nearest points of a way and an edge, from the way to the edge, if the two
/// do not cross.
Eigen::Vector2d shortest_to_m(const Segment& way, const Segment& edge);

/// How far a way lies beside a zone, seen from above [m]; below 0 if it is not beside it.
double beside_m(const Zone& zone, const StraightWay& way);
/// How far a way lies above or below a zone [m]; below 0 if it does neither, as in a plane.
double above_or_below_m(const Zone& zone, const StraightWay& way);
/// Whether a way lies outside of a zone by this distance.
bool lies_outside(const Zone& zone, const StraightWay& way, double distance_m);
/// Whether a place is in a zone. On an edge the result may be either.
bool is_inside(const Zone& zone, const Eigen::Vector3d& x_m);

/// The speed that a filter takes for a body's limit, if it has none: a little more than the wanted.
double limit_or_speed_mps(double limit_mps, const Eigen::Vector3d& wanted_mps);

/// Whether any zone is closed at a tick.
bool any_closed(std::span<const Zone> zones, Tick tick);
/// Whether a body has to leave a zone at a tick: there is one that is closed and does not bind it.
bool must_leave(std::span<const Zone> zones, Tick tick, const Mission& mission,
                const Motion& motion, const StraightWay& way);

/// The part of an uncommanded step that leaves a bound body at its distance from zones, and in the
/// domain. The whole step if no zone is closed at the tick.
/// @param way  the holding set before that step
Eigen::Vector3d stopped_by_zones(std::span<const Zone> zones, Tick tick, const Mission& mission,
                                 const Motion& motion, const StraightWay& way,
                                 const Eigen::Vector3d& push_m);

/// Why a zone is not possible beside the others of its time, and what to do about it.
struct ZoneProblem {
  std::string what, remedy;
};
/// @param zone    is_zone()
/// @param others  the zones that have not ended
/// The zone must be in the domain and leave a way out of each of its places. Outside of it there
/// must be a way to each station, from all others and from the largest part of the domain.
std::optional<ZoneProblem> zone_problem(const Mission& mission, const Zone& zone,
                                        std::span<const Zone> others);

/// How long the slowest agent takes out of a zone at most, with twice the way [ticks]: the least
/// `from` − `closed`. @pre no zone_problem()
Tick least_notice_ticks(const Mission& mission, const Zone& zone, std::span<const Zone> others);

}  // namespace ergocast
