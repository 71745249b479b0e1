// SPDX-License-Identifier: BSD-3-Clause
// Walls in the plane: what is solid, how far it is, and the distance that a body keeps from it.
//
// Walls are rings that do not touch. A place is solid if an odd number of rings contain it. So a
// ring in a ring is a room, and a ring in a room is solid again.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/base/ids.h"
#include "core/base/indexed_rings.h"
#include "core/mission/mission.h"
#include "core/motion/vehicle.h"

namespace ergocast {

/// The most vertices of all rings together: they take 256 KiB of the plan.
/// Limit (Scenario): vertices of all walls and solid keep-outs. Beyond it: the scenario is refused.
inline constexpr int kMaxWallVertices = 16384;
/// How far outside the domain a corner may be, as a multiple of the longer side.
/// Limit (Scenario): distance of a wall from the domain [times the domain's longer side]. Beyond
/// it: the scenario is refused.
inline constexpr double kFarthestWallPerSize = 10;
/// The least area of a wall without its rooms, as a share of the square of the longer side.
/// Limit (Scenario): area of a polygon, at least [times the square of the domain's longer side].
/// Below it: the scenario is refused.
inline constexpr double kLeastWallArea = 1e-8;

/// Whether an odd number of rings contain `x_m`.
bool solid_at(const IndexedRings& walls, const Eigen::Vector2d& x_m);

/// Distance from the nearest edge [m]. It is negative in a wall, and the greatest number without
/// walls.
double clearance_m(const IndexedRings& walls, const Eigen::Vector2d& x_m);

/// Whether the straight way keeps a distance from all walls.
bool is_clear(const IndexedRings& walls, const Segment& way, double kept_m);

std::size_t vertex_count(const Rings& walls);

/// Whether a corner is so near to the domain that rounding does not count.
bool near_enough(const Eigen::Vector2d& corner_m, const Box& domain);

/// Whether the rings are walls: at most kMaxWallVertices corners, near the domain, not crowded
/// (core/base/indexed_rings.h), no edges that touch, and each room after the wall that contains it.
bool are_walls(const IndexedRings& walls, const Box& domain);

/// How far the anchor (core/motion/vehicle.h) of such a vehicle keeps from all walls [m]: the sum
/// of wall_clearance_m, the radius of its loiter circle, the bulge of its path, and a margin for
/// rounding in a mission.
double kept_from_walls_m(const Mission& mission, const Motion& motion);

/// The least wall_clearance_m at which bodies know on which side of a wall they are, in spite of
/// position errors and old commands [m]. 0 where there are neither.
double least_wall_clearance_m(const Mission& mission);

/// By how much a body that begins at `x_m` is farther from all walls than required [m]. Below 0 it
/// must not begin there.
double spare_at_start_m(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m);

/// The part of an uncommanded step that leaves a point in the domain and at the required distance
/// from each wall: a wall stops what is pushed against it. The whole step without walls.
Eigen::Vector3d stopped_by_walls(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m,
                                 const Eigen::Vector3d& push_m);

/// Whether the mission's walls are valid and its bodies can keep from them: in a plane, with speed
/// limits, with free starts, and with disturbances only for points.
bool walls_fit(const Mission& mission);

}  // namespace ergocast
