// SPDX-License-Identifier: BSD-3-Clause
// The transform of a map: exact for cells of constant density, wherever the cells lie.
#include "target/raster_integral.h"

#include <gtest/gtest.h>

#include <vector>

#include "target/density_picture.h"
#include "tests/target/plane_target.h"
#include "tests/target/polygon_reference.h"

namespace ergocast {
namespace {

using namespace test;

const Rectangle kWide{{-30, 5}, {200, 120}};
const Basis kUnequalModes{.modes_x = 13, .modes_y = 10};

/// Values without any symmetry, some of them 0.
double value_at(int column, int row) { return (3 + 7 * column + 13 * row + column * row) % 11; }

RasterGrid seen_from_corner(const RasterGrid& grid) {
  return {from_corner(grid.extent, plane_of(kWide)), grid.columns, grid.rows};
}

PlaneIntegrals shares_of(const RasterGrid& grid, const std::vector<Polygon>& keep_outs = {},
                         const std::function<double(int, int)>& value = value_at) {
  std::vector<Polygon> moved;
  for (const Polygon& polygon : keep_outs) moved.push_back(from_corner(polygon, kWide.origin_m));
  RasterIntegral integral(seen_from_corner(grid), kWide.size_m, kUnequalModes,
                          free_area(kWide.size_m, moved));
  std::vector<double> values(static_cast<std::size_t>(grid.columns));
  for (int row = 0; row < grid.rows; ++row) {
    for (int i = 0; i < grid.columns; ++i) values[static_cast<std::size_t>(i)] = value(i, row);
    integral.add_row(row, values);
  }
  return integral.shares();
}

Ring cell_ring(const RasterGrid& grid, int column, int row) {
  const Eigen::Vector2d cell(grid.extent.size_m.x() / grid.columns,
                             grid.extent.size_m.y() / grid.rows);
  const Eigen::Vector2d low =
      grid.extent.origin_m + cell.cwiseProduct(Eigen::Vector2d(column, row));
  return {low, {low.x() + cell.x(), low.y()}, low + cell, {low.x(), low.y() + cell.y()}};
}

Ring clipped(Ring ring) {
  for (Eigen::Vector2d& corner : ring) {
    corner = corner.cwiseMax(kWide.origin_m).cwiseMin(kWide.origin_m + kWide.size_m);
  }
  return ring;
}

/// Each cell, clipped to the domain, by quadrature.
PlaneCoefficients reference(const RasterGrid& grid) {
  PlaneCoefficients sum = PlaneCoefficients::Zero(kUnequalModes.modes_x, kUnequalModes.modes_y);
  double whole = 0;
  const int panels = grid.columns * grid.rows > 1 ? 12 : 30;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Ring cell = cell_ring(grid, column, row);
      whole += value_at(column, row) * area_m2(cell);
      if (value_at(column, row) == 0 || area_m2(clipped(cell)) == 0) continue;
      sum += value_at(column, row) * over_ring(clipped(cell), one, kWide, kUnequalModes, panels);
    }
  }
  return sum / whole;
}

TEST(RasterIntegral, IsExactForCellsOfConstantDensity) {
  const RasterGrid grids[] = {
      {kWide, 7, 5},
      {{{-10, 20}, {100, 60}}, 6, 4},       // smaller than the domain
      {{{-100, -100}, {400, 400}}, 9, 11},  // larger, edges inside cells
      {{{50, -40}, {400, 90}}, 8, 5},       // beside it in part
      {{{-33, 4}, {300, 400}}, 1, 1},       // one cell
      {{{-30, 5}, {200, 0.5}}, 40, 3},      // thin
  };
  for (const RasterGrid& grid : grids) {
    const PlaneIntegrals ours = shares_of(grid);
    // The last digits are the reference's, which adds up to 22 500 terms a cell.
    EXPECT_LE(largest_difference(ours.values, reference(grid)), 1e-12);
    EXPECT_LE(ours.error_bound, 1e-13);
  }
}

// The mistake of treating a cell's centre as its corner shows in the first moment.
TEST(RasterIntegral, ACellIsWhereItsCentreIs) {
  const RasterGrid grid{kWide, 10, 8};  // cells of 20 × 15 m; (3, 5) has its centre at (40, 87.5)
  const auto only = [](int column, int row) { return column == 3 && row == 5 ? 2.5 : 0.0; };
  const PlaneCoefficients mu = shares_of(grid, {}, only).values;
  const double x = std::numbers::pi * 70 / 200, y = std::numbers::pi * 82.5 / 120;
  const double half_x = std::numbers::pi * 10 / 200, half_y = std::numbers::pi * 7.5 / 120;
  EXPECT_NEAR(mu(0, 0), 1, 1e-15);
  EXPECT_NEAR(mu(1, 0), std::cos(x) * std::sin(half_x) / half_x, 1e-15);
  EXPECT_NEAR(mu(0, 1), std::cos(y) * std::sin(half_y) / half_y, 1e-15);
  EXPECT_NEAR(mu(2, 1),
              std::cos(2 * x) * std::sin(2 * half_x) / (2 * half_x) * std::cos(y) *
                  std::sin(half_y) / half_y,
              1e-15);
}

TEST(RasterIntegral, OfAMirroredMapHasNoOddModes) {
  const RasterGrid grid{kWide, 8, 6};
  const auto mirrored = [](int column, int row) {
    return value_at(std::min(column, 7 - column), std::min(row, 5 - row));
  };
  const PlaneCoefficients mu = shares_of(grid, {}, mirrored).values;
  for (int m = 0; m < kUnequalModes.modes_x; ++m) {
    for (int n = 0; n < kUnequalModes.modes_y; ++n) {
      if (m % 2 == 1 || n % 2 == 1) {
        EXPECT_NEAR(mu(m, n), 0, 1e-15) << m << "," << n;
      }
    }
  }
}

TEST(RasterIntegral, TurningAMapByHalfATurnChangesTheSignOfOddModes) {
  const RasterGrid grid{kWide, 8, 6};
  const PlaneCoefficients mu = shares_of(grid).values;
  const PlaneCoefficients turned =
      shares_of(grid, {}, [](int column, int row) { return value_at(7 - column, 5 - row); }).values;
  for (int m = 0; m < kUnequalModes.modes_x; ++m) {
    for (int n = 0; n < kUnequalModes.modes_y; ++n) {
      EXPECT_NEAR(turned(m, n), (m + n) % 2 == 0 ? mu(m, n) : -mu(m, n), 1e-14) << m << "," << n;
    }
  }
}

TEST(RasterIntegral, OfAUniformMapIsTheUniformTarget) {
  PlaneCoefficients expected =
      PlaneCoefficients::Zero(kUnequalModes.modes_x, kUnequalModes.modes_y);
  expected(0, 0) = 1;
  for (const auto& [columns, rows] : {std::pair(1, 1), {7, 5}, {300, 200}}) {
    const PlaneIntegrals ours = shares_of({kWide, columns, rows}, {}, [](int, int) { return 0.1; });
    EXPECT_LE(largest_difference(ours.values, expected), ours.error_bound);
    EXPECT_LE(ours.error_bound, 1e-13);
  }
}

TEST(RasterIntegral, EntryZeroIsTheShareThatTheDomainLeaves) {
  const RasterGrid shifted{{{-130, 5}, {200, 120}}, 4, 3};  // its left half is outside
  EXPECT_NEAR(shares_of(shifted, {}, [](int, int) { return 1; }).values(0, 0), 0.5, 1e-15);
  const auto left_third = [](int column, int) { return column == 0 ? 3 : 1; };
  EXPECT_NEAR(shares_of(shifted, {}, left_third).values(0, 0), 2.0 / 6, 1e-15);
}

/// Slanted, crossing each other, reaching out of the domain, with a hole, and along cells' edges.
std::vector<Polygon> keep_outs() {
  return {{{{-40, 0}, {60, 30}, {10, 70}}, {}},
          {{{40, 20}, {90, 35}, {70, 100}, {20, 60}}, {{{55, 50}, {65, 52}, {60, 70}}}},
          {{{130, 45}, {150, 45}, {150, 65}, {130, 65}}, {}}};
}

// A cell as a region of its own is computed differently: cut as a polygon, not along its row.
TEST(RasterIntegral, CellsThatKeepOutsCutCountByWhatIsLeft) {
  for (const RasterGrid& grid :
       {RasterGrid{kWide, 10, 6}, RasterGrid{{{-60, -20}, {270, 160}}, 31, 23},
        RasterGrid{{{0, 20}, {100, 70}}, 2, 2}}) {
    TargetDensity cells;
    for (const Polygon& polygon : keep_outs()) cells.keep_outs.push_back({polygon});
    double whole = 0;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        if (value_at(column, row) == 0) continue;
        const Ring ring = cell_ring(grid, column, row);
        const double mass = value_at(column, row) * area_m2(ring);
        cells.regions.push_back({mass, {ring, {}}});
        whole += mass;
      }
    }
    const PlaneCoefficients expected = target_integrals(cells, kWide, kUnequalModes).values / whole;
    const PlaneIntegrals ours = shares_of(grid, keep_outs());
    EXPECT_LE(largest_difference(ours.values, expected), 1e-13);
    EXPECT_LE(ours.error_bound, 1e-11);
    EXPECT_LT(ours.values(0, 0), 0.9 * shares_of(grid).values(0, 0));
  }
}

TEST(RasterPicture, HasTheMassOfTheMap) {
  const RasterGrid grid{{{-60, -20}, {270, 160}}, 31, 23};
  for (const auto& [cells_x, cells_y] : {std::pair(16, 10), {100, 60}, {1, 1}}) {
    RasterPicture picture(seen_from_corner(grid), kWide.size_m, cells_x, cells_y);
    for (int row = 0; row < grid.rows; ++row) {
      std::vector<double> values;
      for (int column = 0; column < grid.columns; ++column) values.push_back(value_at(column, row));
      picture.add_row(row, values);
    }
    EXPECT_NEAR(picture.density().mean() * 200 * 120, shares_of(grid).values(0, 0), 1e-13);
  }
}

TEST(RasterPicture, OfEqualCellsIsTheMapItself) {
  RasterPicture picture({{{0, 0}, kWide.size_m}, 4, 3}, kWide.size_m, 4, 3);
  for (int row = 0; row < 3; ++row) {
    picture.add_row(row, std::vector<double>{1.0 * row, 2, 3, 4});
  }
  const DensityGrid density = picture.density();
  const double whole = (3 + 27) * 50 * 40;
  EXPECT_NEAR(density(0, 2), 2 / whole, 1e-18);
  EXPECT_NEAR(density(0, 0), 0, 1e-18);
  EXPECT_NEAR(density(3, 1), 4 / whole, 1e-18);
}

}  // namespace
}  // namespace ergocast
