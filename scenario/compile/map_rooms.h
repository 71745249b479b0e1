// SPDX-License-Identifier: BSD-3-Clause
// What became of an occupancy map that has walls.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "target/polygon.h"

namespace ergocast {

struct MapRooms {
  /// A part of the domain that bodies can be in.
  struct Room {
    Eigen::Vector2d middle_m;  ///< its widest place
    double area_m2;            ///< where the bodies' centres can be
  };

  std::filesystem::path file;
  double free_m2 = 0;           ///< of the map's cells in the domain
  double clearance_m = 0;       ///< that bodies keep from walls
  std::vector<Room> rooms;      ///< that no way joins, the largest first; as the map has them
  int used = 0;                 ///< the number of the room that stays free: agents start there
  std::vector<Polygon> closed;  ///< what the map shows as free, and no body can reach
};

}  // namespace ergocast
