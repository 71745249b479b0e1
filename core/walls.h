// SPDX-License-Identifier: BSD-3-Clause
// Walls in the plane: what is solid, how far it is, and what a body owes it.
//
// Walls are rings that do not touch. A place is solid if an odd number of rings contain it: so a
// ring in a ring is a room, and a ring in a room is solid again.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/ids.h"
#include "core/mission.h"
#include "core/rings.h"
#include "core/vehicle.h"

namespace ergocast {

/// Of all rings together: 16 KiB of the plan, and a query looks at each.
/// Limit (Scenario): vertices of all walls and solid keep-outs. Beyond it: the scenario is refused.
inline constexpr int kMaxWallVertices = 1024;
/// How far outside the domain a corner may be, as a multiple of the longer side.
/// Limit (Scenario): distance of a wall from the domain [times the domain's longer side]. Beyond
/// it: the scenario is refused.
inline constexpr double kFarthestWallPerSize = 10;
/// The least area of a wall without its rooms, as a share of the square of the longer side.
/// Limit (Scenario): area of a polygon, at least [times the square of the domain's longer side].
/// Below it: the scenario is refused.
inline constexpr double kLeastWallArea = 1e-8;

/// Whether an odd number of rings contain `x_m`.
bool solid_at(const Rings& walls, const Eigen::Vector2d& x_m);

/// Distance from the nearest edge [m], below 0 in a wall; the greatest number without walls.
double clearance_m(const Rings& walls, const Eigen::Vector2d& x_m);

std::size_t vertex_count(const Rings& walls);

/// Whether a corner is so near to the domain that rounding does not count.
bool near_enough(const Eigen::Vector2d& corner_m, const Box& domain);

/// Whether the rings are walls: at most kMaxWallVertices corners, near the domain, no edges that
/// touch, each room after the wall that it is in.
bool are_walls(const Rings& walls, const Box& domain);

/// How far the anchor (core/vehicle.h) of such a vehicle keeps from all walls [m]:
/// wall_clearance_m, the radius of its loiter circle, the bulge of its path, and what rounding may
/// take away in a mission.
double kept_from_walls_m(const Mission& mission, const Motion& motion);

/// The least wall_clearance_m at which bodies that are not where they are said to be, or go on by
/// old commands, know on which side of a wall they are [m]. 0 where both cannot be.
double least_wall_clearance_m(const Mission& mission);

/// By how much a body that begins at `x_m` is farther from all walls than it has to be [m]; below
/// 0, it must not begin there.
double spare_at_start_m(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m);

/// As much of a step that nobody has commanded as leaves a point in the domain and as far from each
/// wall as it has to be: a wall stops what is pushed against it. All of it without walls.
Eigen::Vector3d stopped_by_walls(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m,
                                 const Eigen::Vector3d& push_m);

/// Whether the mission's walls are such, and its bodies can keep from them: in a plane, with speed
/// limits; starts are free; pushed are only points.
bool walls_fit(const Mission& mission);

}  // namespace ergocast
