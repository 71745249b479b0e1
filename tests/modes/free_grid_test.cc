// SPDX-License-Identifier: BSD-3-Clause
// Cells are neighbours only if they see each other.
#include "modes/free_grid.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/basis/free_modes.h"
#include "tests/modes/rooms.h"

namespace ergocast {
namespace {

using test::grid_of;
using test::square;

bool is_left(const FreeGrid& grid, int cell) {
  const double column = grid.place[static_cast<std::size_t>(cell)] / grid.rows + 0.5;
  return column * test::kSide_m / grid.columns < test::kWall_m;
}

double y_of(const FreeGrid& grid, int cell) {
  return (grid.place[static_cast<std::size_t>(cell)] % grid.rows + 0.5) * test::kSide_m / grid.rows;
}

TEST(FreeGrid, HasNearlySquareCells) {
  Box domain = square();
  domain.size_m = {3000, 1000, 0};
  const FreeGrid grid = grid_of(domain, test::sees_all);
  EXPECT_EQ(grid.cell_count(), grid.columns * grid.rows);
  EXPECT_NEAR(3000.0 / grid.columns, 1000.0 / grid.rows, 1);
  EXPECT_NEAR(grid.cell_count(), 6400, 200);
}

TEST(FreeGrid, HasNoDoorThroughAWallThatIsThinnerThanACell) {
  const FreeGrid grid = grid_of(square(), test::sees_through_the_door);
  int doors = 0;
  for (const auto& [one, other] : grid.doors_x) {
    if (is_left(grid, one) == is_left(grid, other)) continue;
    EXPECT_LT(std::abs(y_of(grid, one) - test::kSide_m / 2), test::kHalfDoor_m);
    ++doors;
  }
  EXPECT_EQ(doors, 8);
}

// A door's cells see both sides; away from it, no value comes from the other room.
TEST(FreeGrid, SeesNothingOfTheOtherRoomThroughTheWall) {
  const FreeGrid grid = grid_of(square(), test::sees_through_the_door);
  for (int cell = 0; cell < grid.cell_count(); ++cell) {
    const double from_door_m = std::abs(y_of(grid, cell) - test::kSide_m / 2);
    if (from_door_m < test::kHalfDoor_m + 30) continue;
    for (int i = 0; i < 9; ++i) {
      const int seen = grid.around[static_cast<std::size_t>(cell * 9 + i)];
      ASSERT_EQ(is_left(grid, seen), is_left(grid, cell)) << cell;
    }
  }
}

// The wall is not in the middle between two cells: a part of one cell is in the other room.
TEST(FreeGrid, GivesEachPartToACellOnItsSideOfTheWall) {
  const FreeGrid grid = grid_of(square(), test::sees_through_the_door);
  const int parts = grid.columns * kPartsPerCell;
  for (int i = 0; i < parts; ++i) {
    const double x_m = (i + 0.5) * test::kSide_m / parts;
    for (const int j : {3, parts / 5, parts - 2}) {
      const int owner = grid.owner[static_cast<std::size_t>(i * parts + j)];
      EXPECT_EQ(is_left(grid, owner), x_m < test::kWall_m) << x_m;
    }
  }
}

TEST(FreeGrid, GivesWallsToTheNearestCells) {
  const Sees sees = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (a - Eigen::Vector2d(1000, 1000)).norm() > 400 &&
           (b - Eigen::Vector2d(1000, 1000)).norm() > 400;
  };
  const FreeGrid grid = grid_of(square(), sees);
  EXPECT_LT(grid.cell_count(), 6400 * 0.9);
  EXPECT_TRUE(std::ranges::all_of(
      grid.owner, [&](int owner) { return owner >= 0 && owner < grid.cell_count(); }));
}

TEST(FreeGrid, RefusesWhatIsCutInTwoOrWhollySolid) {
  const Sees apart = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (a.x() < 700) == (b.x() < 700);
  };
  const auto two = free_grid(square(), apart);
  ASSERT_FALSE(two);
  EXPECT_NE(two.error().find("no way between its parts"), std::string::npos);
  const auto none = free_grid(square(), [](const auto&, const auto&) { return false; });
  ASSERT_FALSE(none);
}

TEST(FreeGrid, LeavesOutACornerThatIsCutOff) {
  const Sees corner = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (a.maxCoeff() < 60) == (b.maxCoeff() < 60);
  };
  EXPECT_EQ(grid_of(square(), corner).cell_count(), 6400 - 4);
}

}  // namespace
}  // namespace ergocast
