// SPDX-License-Identifier: BSD-3-Clause
// The shortest way to a place around walls and closed zones.
//
// Without either the way is straight. Else it leads along the cells of core/motion/free_region.h,
// and its length is never too short. A body that follows it moves straight to the farthest of these
// cells that it can see.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/base/indexed_rings.h"
#include "core/mission/mission.h"
#include "core/mission/zones.h"
#include "core/motion/free_region.h"
#include "core/motion/vehicle.h"

namespace ergocast {

class WayAround {
 public:
  /// @param motion  of the vehicle that follows it: how far it keeps from walls
  WayAround(const Mission& mission, const Motion& motion);

  /// From now on it leads around these zones, too, and to the same place. In a box it stays
  /// straight. Returns whether anything has changed.
  bool note_zones(const Mission& mission, std::vector<Zone> zones);
  /// From now on it leads to `to_m`. Among walls this takes some milliseconds, and allocates.
  void lead_to(const Eigen::Vector3d& to_m);

  /// The length of the way from `x_m` [m]; infinite where there is none.
  double length_m(const Eigen::Vector3d& x_m) const;
  /// The end of the way, or the farthest visible cell on it. Does not allocate.
  Eigen::Vector3d next_place_m(const Eigen::Vector3d& x_m);
  /// Whether the straight way between two places keeps its distance from all walls and zones.
  bool is_clear(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const;
  /// The nearest cell to `x_m`, a few cells away at most, whose centre may be on a way; `x_m`
  /// itself if there are no walls or zones. Nothing if none is near.
  std::optional<Eigen::Vector3d> free_place_near(const Eigen::Vector3d& x_m) const;

 private:
  void find_ways();
  std::optional<int> open_cell_near(const Eigen::Vector2d& x_m) const;
  std::optional<int> first_cell(const Eigen::Vector3d& x_m) const;

  IndexedRings walls_;
  std::vector<Zone> zones_;
  double seen_m_ = 0;                 // how far a straight way keeps from walls
  double seen_zones_m_ = 0;           // and from zones
  std::optional<FreeRegion> region_;  // where there are walls or zones
  std::vector<bool> open_;            // its cells outside of zones; empty: all
  Motion motion_;
  Eigen::Vector3d to_m_{0, 0, 0};
  std::vector<double> ways_m_;  // from its cells to that of the end; empty: none
  std::optional<int> cell_;     // of the way, the farthest that can be seen
};

}  // namespace ergocast
