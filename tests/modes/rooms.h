// SPDX-License-Identifier: BSD-3-Clause
// Two rooms with a door, and tables of their modes.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "modes/table.h"

namespace ergocast::test {

inline constexpr double kSide_m = 2000;
inline constexpr double kWall_m = 1005;  ///< 5 m behind an edge of the cells, which are 25 m wide
inline constexpr double kHalfDoor_m = 100;

inline Box square() {
  Box domain;
  domain.size_m = {kSide_m, kSide_m, 0};
  return domain;
}

/// A wall without thickness along y, with a door in its middle.
inline bool sees_through_the_door(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) {
  const double before_m = from_m.x() - kWall_m, after_m = to_m.x() - kWall_m;
  if ((before_m < 0) == (after_m < 0)) return true;
  const Eigen::Vector2d at_m = from_m + (to_m - from_m) * (before_m / (before_m - after_m));
  return std::abs(at_m.y() - kSide_m / 2) < kHalfDoor_m;
}

inline bool sees_all(const Eigen::Vector2d&, const Eigen::Vector2d&) { return true; }

inline FreeGrid grid_of(const Box& domain, const Sees& sees) {
  return free_grid(domain, sees).value();
}

inline ModesTable table_of(const FreeGrid& grid, int modes, std::uint64_t key = 1) {
  const auto bytes = std::make_shared<const std::vector<std::byte>>(
      encode_table(grid, *eigen_modes(grid, modes), key));
  return decode_table(*bytes, bytes).value();
}

inline ModesTable two_rooms(int modes) {
  return table_of(grid_of(square(), sees_through_the_door), modes);
}

}  // namespace ergocast::test
