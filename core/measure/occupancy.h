// SPDX-License-Identifier: BSD-3-Clause
// Densities as maps of cells with whole numbers, as ROS 2 shows them (nav_msgs/OccupancyGrid).
#pragma once

#include <cstdint>
#include <vector>

#include "core/basis/basis.h"
#include "core/measure/detection.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Square cells from a corner of the domain.
struct OccupancyGrid {
  double resolution_m = 1;              ///< the side of a cell
  std::uint32_t width = 0, height = 0;  ///< cells along x and y
  /// The cell (i along x, j along y) is at j · width + i: 100 for the target's greatest density,
  /// −1 outside of the domain.
  std::vector<std::int8_t> data;
};

/// Cells along the domain's longer side.
inline constexpr int kOccupancyCells = 64;

/// The density Σ a_k f_k / mean(f_k²) of `coefficients`; for a box, averaged along z.
/// @param target  μ of the target, which is the scale; both in the basis (2)
/// @pre mission is in the basis (2), core/mission/mission.h in_cosines()
OccupancyGrid occupancy_of(const Coefficients& coefficients, const Coefficients& target,
                           const Mission& mission);

/// How much of the target an object may still be in: the target times the probability that no
/// sensor has detected an object there.
/// @param detection  of this target and mission
OccupancyGrid occupancy_left(const Detection& detection, const Coefficients& target,
                             const Mission& mission);

}  // namespace ergocast
