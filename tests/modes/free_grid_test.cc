// SPDX-License-Identifier: BSD-3-Clause
// Cells are neighbours only if they see each other.
#include "modes/free_grid.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/indexed_rings.h"
#include "core/basis/free_modes.h"
#include "core/motion/free_region.h"
#include "core/motion/walls.h"
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

/// Pillars from side to side, a cell apart, which points pass everywhere. At the lower end is a way
/// for bodies.
class Palisade : public ::testing::Test {
 protected:
  static constexpr double kClearance_m = 30, kWay_m = 200;

  static Rings pillars() {
    Rings walls;
    for (double y_m = kWay_m; y_m < test::kSide_m; y_m += 40)
      walls.push_back({{1000, y_m}, {1010, y_m}, {1010, y_m + 10}, {1000, y_m + 10}});
    return walls;
  }
  static bool sees_between(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) {
    static const IndexedRings walls = pillars();
    const Segment way{from_m, to_m};
    return !walls.find_near(way, 0, [&](const Edge& edge) { return touch(way, edge.segment); });
  }
  /// Through how many doors the way leads from one side to the other, far from bodies' way.
  static int doors_between_sides(const FreeGrid& grid) {
    std::vector<int> doors(grid.place.size(), -1);
    std::vector<int> reached = {cell_at(grid, {900, 1800})};
    doors[static_cast<std::size_t>(reached[0])] = 0;
    const int end = cell_at(grid, {1100, 1800});
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const auto pass = [&](int from, int to) {
        if (from != reached[i] || doors[static_cast<std::size_t>(to)] >= 0) return;
        doors[static_cast<std::size_t>(to)] = doors[static_cast<std::size_t>(from)] + 1;
        reached.push_back(to);
      };
      for (const auto& ways : {grid.doors_x, grid.doors_y}) {
        for (const auto& [one, other] : ways) pass(one, other), pass(other, one);
      }
    }
    return doors[static_cast<std::size_t>(end)];
  }
  static int cell_at(const FreeGrid& grid, const Eigen::Vector2d& at_m) {
    const auto column = static_cast<int>(at_m.x() / test::kSide_m * grid.columns);
    const auto row = static_cast<int>(at_m.y() / test::kSide_m * grid.rows);
    return static_cast<int>(std::ranges::find(grid.place, column * grid.rows + row) -
                            grid.place.begin());
  }
};

TEST_F(Palisade, HasDoorsForPointsAndNoneForBodies) {
  const FreeRegion bodies(pillars(), square(), kClearance_m);
  EXPECT_LT(doors_between_sides(free_grid(square(), sees_between).value()), 20);
  const FreeGrid grid = free_grid(square(), sees_between, &bodies).value();
  EXPECT_GT(doors_between_sides(grid), 100);
  EXPECT_GT(grid.cell_count(), 0.95 * grid.columns * grid.rows);
}

TEST_F(Palisade, HasDoorsForPointsIfBodiesHaveNoWayBetweenParts) {
  Rings walls = pillars();
  walls.push_back({{1000, -10}, {1010, -10}, {1010, kWay_m - 20}, {1000, kWay_m - 20}});
  const FreeRegion bodies(walls, square(), kClearance_m);
  ASSERT_EQ(bodies.parts(), 2);
  EXPECT_LT(doors_between_sides(free_grid(square(), sees_between, &bodies).value()), 20);
}

}  // namespace
}  // namespace ergocast
