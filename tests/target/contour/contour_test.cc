// SPDX-License-Identifier: BSD-3-Clause
// Polygons around cells: no wall is opened and no passage is closed, whatever the cells are.
#include "target/contour/contour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <string>

#include "core/base/indexed_rings.h"
#include "target/contour/specks.h"

namespace ergocast {
namespace {

constexpr Straightening kAll[] = {Straightening::kOutwards, Straightening::kBothWays};

/// Rows from the north: '#' is solid or occupied, '?' unknown, '.' free.
CellGrid grid_of(const std::vector<std::string>& rows) {
  CellGrid cells(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int y = 0; y < cells.rows(); ++y) {
    for (int x = 0; x < cells.columns(); ++x) {
      const char c =
          rows[rows.size() - 1 - static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
      cells.at(x, y) = c == '#' ? kOccupiedCell : c == '?' ? kUnknownCell : kFreeCell;
    }
  }
  return cells;
}

std::vector<std::string> text_of(const CellGrid& cells) {
  std::vector<std::string> rows;
  for (int y = cells.rows() - 1; y >= 0; --y) {
    std::string& row = rows.emplace_back();
    for (int x = 0; x < cells.columns(); ++x) row += ".#?x"[cells.at(x, y)];
  }
  return rows;
}

std::string printed(const CellGrid& cells) {
  std::string text;
  for (const std::string& row : text_of(cells)) text += row + '\n';
  return text;
}

Rings rings_of(const std::vector<Polygon>& polygons) {
  Rings rings;
  for (const Polygon& polygon : polygons) {
    rings.push_back(polygon.outline);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

std::size_t corners_of(const std::vector<Polygon>& polygons) {
  std::size_t count = 0;
  for (const Ring& ring : rings_of(polygons)) count += ring.size();
  return count;
}

bool solid_at(const Rings& rings, const Eigen::Vector2d& x) {
  bool solid = false;
  for (const Ring& ring : rings) solid ^= contains(ring, x);
  return solid;
}

double distance_of(const Rings& rings, const Eigen::Vector2d& x) {
  double least = 1e9;
  for_segments(
      rings, [&](const Segment& edge) { least = std::min(least, (edge.nearest_m(x) - x).norm()); });
  return least;
}

bool is_solid(const CellGrid& cells, int x, int y) { return cells.has(x, y) && cells.at(x, y) > 0; }

/// Checks outlines and holes: apart from each other, and each hole in its outline.
void expect_valid(const std::vector<Polygon>& polygons, const std::string& text) {
  const IndexedRings rings(rings_of(polygons));
  ASSERT_FALSE(touching_edges(rings)) << text;
  const std::vector<int> depth = depths(rings);
  std::size_t ring = 0;
  for (const Polygon& polygon : polygons) {
    EXPECT_GE(polygon.outline.size(), 3U) << text;
    EXPECT_EQ(depth[ring++] % 2, 0) << text;
    for (const Ring& hole : polygon.holes) {
      EXPECT_TRUE(contains(polygon.outline, hole.front())) << text;
      EXPECT_EQ(depth[ring++] % 2, 1) << text;
    }
  }
}

/// Checks the centre of each cell, and if `whole` also eight places near the sides and corners of
/// solid cells.
void expect_same_cells(const CellGrid& cells, const Rings& rings, bool whole) {
  for (int y = -1; y <= cells.rows(); ++y) {
    for (int x = -1; x <= cells.columns(); ++x) {
      const Eigen::Vector2d centre(x + 0.5, y + 0.5);
      const bool solid = is_solid(cells, x, y);
      if (!solid && distance_of(rings, centre) < 1e-12) continue;
      ASSERT_EQ(solid_at(rings, centre), solid) << "cell " << x << ", " << y << '\n'
                                                << printed(cells);
      if (!solid || !whole) continue;
      for (const double dx : {-0.499, 0.0, 0.499}) {
        for (const double dy : {-0.499, 0.0, 0.499})
          ASSERT_TRUE(solid_at(rings, centre + Eigen::Vector2d(dx, dy)))
              << "cell " << x << ", " << y << '\n'
              << printed(cells);
      }
    }
  }
}

/// Solid cells that have only a corner in common are joined there.
void expect_joined(const CellGrid& cells, const Rings& rings) {
  for (int y = 0; y < cells.rows(); ++y) {
    for (int x = 0; x < cells.columns(); ++x) {
      if (!is_solid(cells, x, y)) continue;
      for (const int dx : {-1, 1}) {
        if (!is_solid(cells, x + dx, y + 1)) continue;
        if (is_solid(cells, x + dx, y) || is_solid(cells, x, y + 1)) continue;
        const Eigen::Vector2d corner(x + (dx + 1) / 2, y + 1);
        ASSERT_TRUE(solid_at(rings, corner)) << corner.transpose() << '\n' << printed(cells);
        ASSERT_GE(distance_of(rings, corner), 0.1) << corner.transpose() << '\n' << printed(cells);
      }
    }
  }
}

/// No corner of a ring is more than half a cell from the sides of cells.
void expect_near(const CellGrid& cells, const Rings& rings) {
  for_segments(rings, [&](const Segment& edge) {
    for (const double share : {0.0, 0.25, 0.5, 0.75}) {
      const Eigen::Vector2d at = edge.from_m + share * (edge.to_m - edge.from_m);
      const int column = static_cast<int>(std::floor(at.x())),
                row = static_cast<int>(std::floor(at.y()));
      const bool solid = is_solid(cells, column, row);
      double least = 9;
      for (int y = row - 1; y <= row + 1; ++y) {
        for (int x = column - 1; x <= column + 1; ++x) {
          if (is_solid(cells, x, y) == solid) continue;
          const Eigen::Vector2d low(x, y);
          const Eigen::Vector2d to = at.cwiseMax(low).cwiseMin(low + Eigen::Vector2d(1, 1)) - at;
          least = std::min(least, to.cwiseAbs().maxCoeff());
        }
      }
      ASSERT_LE(least, 0.5) << at.transpose() << '\n' << printed(cells);
    }
  });
}

void expect_closed(const CellGrid& cells) {
  for (const Straightening straightening : kAll) {
    const auto polygons = polygons_around(cells, straightening);
    ASSERT_TRUE(polygons);
    const Rings rings = rings_of(*polygons);
    expect_valid(*polygons, printed(cells));
    const bool whole = straightening == Straightening::kOutwards;
    expect_same_cells(cells, rings, whole);
    expect_joined(cells, rings);
    expect_near(cells, rings);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(Contour, NeverOpensAWallOfAnyCells) {
  std::mt19937 random(5);
  const auto below = [&](int most) {
    return static_cast<int>(random() % static_cast<unsigned>(most));
  };
  for (int trial = 0; trial < 1500 && !::testing::Test::HasFatalFailure(); ++trial) {
    CellGrid cells(1 + below(12), 1 + below(12));
    const int share = below(11);
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = below(10) < share ? 1 : 0;
    expect_closed(cells);
  }
}

/// Lines as a robot draws them: one cell thick, in any direction.
TEST(Contour, NeverOpensThinLines) {
  std::mt19937 random(6);
  const auto below = [&](int most) {
    return static_cast<int>(random() % static_cast<unsigned>(most));
  };
  for (int trial = 0; trial < 200 && !::testing::Test::HasFatalFailure(); ++trial) {
    CellGrid cells(30, 30);
    for (int line = 0; line < 3; ++line) {
      const Eigen::Vector2d from(below(30), below(30)), to(below(30), below(30));
      const double steps = std::max(1.0, (to - from).cwiseAbs().maxCoeff());
      for (double step = 0; step <= steps; ++step) {
        const Eigen::Vector2d at = from + step / steps * (to - from);
        cells.at(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))) = 1;
      }
    }
    expect_closed(cells);
  }
}

TEST(Contour, AThinDiagonalWallIsOneClosedRing) {
  const CellGrid cells = grid_of(
      {"....#....", "...#.#...", "..#...#..", ".#.....#.", "..#...#..", "...#.#...", "....#...."});
  for (const Straightening straightening : kAll) {
    const auto polygons = polygons_around(cells, straightening);
    ASSERT_EQ(polygons->size(), 1U);
    ASSERT_EQ((*polygons)[0].holes.size(), 1U);
    EXPECT_LE(corners_of(*polygons), 24U);
  }
  expect_closed(cells);
}

TEST(Contour, IslandsInHolesArePolygonsOfTheirOwn) {
  const auto polygons = polygons_around(
      grid_of({"#######", "#.....#", "#.###.#", "#.#.#.#", "#.###.#", "#.....#", "#######"}),
      Straightening::kOutwards);
  ASSERT_EQ(polygons->size(), 2U);
  EXPECT_EQ((*polygons)[0].holes.size(), 1U);
  EXPECT_EQ((*polygons)[1].holes.size(), 1U);
  EXPECT_EQ(corners_of(*polygons), 16U);
}

/// A room of 240 by 200 cells with a partition and a round pillar, turned by `angle`.
CellGrid turned_room(double angle) {
  CellGrid cells(400, 400);
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) {
      const double u = (x - 200) * std::cos(angle) + (y - 200) * std::sin(angle);
      const double v = (y - 200) * std::cos(angle) - (x - 200) * std::sin(angle);
      const bool room = std::abs(u) < 120 && std::abs(v) < 100;
      const bool outer = std::abs(u) < 123 && std::abs(v) < 103;
      const bool partition = std::abs(u) < 1.5 && std::abs(v - 20) < 85;
      const bool pillar = std::hypot(u - 60, v - 30) < 12;
      cells.at(x, y) = (outer && !room) || partition || pillar ? 1 : 0;
    }
  }
  return cells;
}

TEST(Contour, StraightensTurnedWalls) {
  EXPECT_LE(corners_of(*polygons_around(turned_room(0), Straightening::kOutwards)), 40U);
  EXPECT_LE(corners_of(*polygons_around(turned_room(std::atan(1)), Straightening::kOutwards)),
            100U);
  EXPECT_LE(corners_of(*polygons_around(turned_room(0.1), Straightening::kBothWays)), 100U);
  EXPECT_LE(corners_of(*polygons_around(turned_room(0.3), Straightening::kBothWays)), 400U);
}

TEST(Contour, IsNothingIfThereAreTooManySides) {
  CellGrid cells(2100, 2100);
  for (std::size_t i = 0; i < cells.size(); i += 2) cells[i] = 1;
  EXPECT_FALSE(polygons_around(cells, Straightening::kOutwards));
}

TEST(Specks, SmallUnknownPatchesAmidFreeCellsAreFree) {
  CellGrid cells =
      grid_of({"...........", ".??.??.?.#.", ".??.??..?..", ".....?...?#", "..........."});
  free_unknown_specks(cells, 5);
  EXPECT_EQ(text_of(cells), (std::vector<std::string>{"...........", "....??.?.#.", "....??..?..",
                                                      ".....?...?#", "..........."}));
}

TEST(Specks, UnknownCellsAtTheEdgeStay) {
  CellGrid cells = grid_of({"?...", "....", "..?."});
  free_unknown_specks(cells, 5);
  EXPECT_EQ(text_of(cells), (std::vector<std::string>{"?...", "....", "..?."}));
}

TEST(Specks, SmallPocketsOfFreeCellsAreClosed) {
  CellGrid cells = grid_of({"#######", "#..#.##", "#..##.#", "#######"});
  close_pockets(cells, 2);
  EXPECT_EQ(text_of(cells), (std::vector<std::string>{"#######", "#..#x##", "#..##x#", "#######"}));
  EXPECT_EQ(count_free(cells), 4U);
}

}  // namespace
}  // namespace ergocast
