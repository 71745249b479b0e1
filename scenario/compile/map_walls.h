// SPDX-License-Identifier: BSD-3-Clause
// The walls that an occupancy map has in a domain.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/geometry.h"
#include "scenario/compile/drawn_polygons.h"
#include "scenario/compile/map_rooms.h"
#include "target/maps/occupancy_map.h"

namespace ergocast {

/// What a map shows at a place that is solid in the end.
enum class SolidPlace : std::uint8_t {
  kNone,     ///< the place is free
  kWall,     ///< an occupied cell, or an edge of one that was straightened
  kUnknown,  ///< unknown space, also outside the map
  kClosed,   ///< free space that bodies cannot reach from the first start, or that is too small
};

struct MapWalls {
  std::vector<PlacedPolygon> polygons;
  std::filesystem::path image;
  MapRooms rooms;
  std::vector<SolidPlace> starts;  ///< of each planned start
};

/// What map_walls need to know of the bodies.
struct MapBodies {
  double clearance_m = 0;                 ///< that they keep from walls
  std::vector<Eigen::Vector2d> starts_m;  ///< those that are planned
};

/// The solid space of a map in and near a domain, as polygons that do not touch. Occupied cells are
/// solid; unknown ones and all outside the map, too, unless `unknown_free`. What is outside the map
/// does not matter to a domain that the map covers. Without `unknown_free`, patches of up to four
/// unknown cells amid free ones are free, and pockets of less than 1/1000 of the free cells are
/// solid. So are the parts of the domain that no way of core/motion/free_region.h joins with the
/// part of the first start, or else with the largest, and niches that no body reaches into. The
/// polygons have at most kMaxWallVertices corners; polygons_around() straightens them both ways if
/// that takes less.
Result<MapWalls, MapProblem> read_map_walls(const std::filesystem::path& yaml, const Box& domain,
                                            bool unknown_free, const MapBodies& bodies);

/// Outlines and holes of all.
Rings rings_of(const MapWalls& walls);

}  // namespace ergocast
