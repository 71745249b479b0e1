// SPDX-License-Identifier: BSD-3-Clause
// The cut of the domain: areas are those of the plane geometry, and no point is in two pieces.
#include "target/trapezoids.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ergocast {
namespace {

const Eigen::Vector2d kSize_m(20, 10);

Ring box(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

double area_of(const std::vector<Trapezoid>& pieces) {
  double area = 0;
  for (const Trapezoid& piece : pieces) {
    area += (piece.high - piece.low) * 0.5 *
            (piece.right_low - piece.left_low + piece.right_high - piece.left_high);
  }
  return area;
}

int pieces_around(const std::vector<Trapezoid>& pieces, const Eigen::Vector2d& at) {
  int count = 0;
  for (const Trapezoid& piece : pieces) {
    if (at.y() <= piece.low || at.y() > piece.high) continue;
    const Trapezoid line = piece.between(at.y(), at.y());
    count += at.x() > line.left_low && at.x() <= line.right_low ? 1 : 0;
  }
  return count;
}

TEST(FreeArea, WithoutKeepOutsIsTheDomainInOnePiece) {
  const std::vector<Trapezoid> pieces = free_area(kSize_m, {});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].corners()[0], Eigen::Vector2d(0, 0));
  EXPECT_EQ(pieces[0].corners()[2], Eigen::Vector2d(20, 10));
}

TEST(FreeArea, LosesWhatKeepOutsShareOnlyOnce) {
  const std::vector<Polygon> overlapping{{box(2, 2, 4, 4), {}}, {box(4, 4, 4, 4), {}}};
  EXPECT_NEAR(area_of(free_area(kSize_m, overlapping)), 200 - (16 + 16 - 4), 1e-12);
  const std::vector<Polygon> twice{{box(2, 2, 4, 4), {}}, {box(2, 2, 4, 4), {}}};
  EXPECT_NEAR(area_of(free_area(kSize_m, twice)), 200 - 16, 1e-12);
}

TEST(FreeArea, LosesOnlyWhatIsInside) {
  EXPECT_NEAR(area_of(free_area(kSize_m, std::vector<Polygon>{{box(-5, -5, 10, 10), {}}})),
              200 - 25, 1e-12);
  EXPECT_NEAR(area_of(free_area(kSize_m, std::vector<Polygon>{{box(-100, 50, 10, 10), {}}})), 200,
              1e-12);
  EXPECT_EQ(area_of(free_area(kSize_m, std::vector<Polygon>{{box(-10, -10, 40, 40), {}}})), 0);
}

TEST(FreeArea, HasHolesOfKeepOutsAndNotTheirIslands) {
  const Polygon ring{box(2, 2, 6, 6), {box(4, 4, 2, 2)}};
  const Polygon turned{box(2, 2, 6, 6), {Ring{{4, 4}, {4, 6}, {6, 6}, {6, 4}}}};
  for (const Polygon& keep_out : {ring, turned}) {
    EXPECT_NEAR(area_of(free_area(kSize_m, std::vector<Polygon>{keep_out})), 200 - 36 + 4, 1e-12);
  }
}

TEST(FreeAreaWithin, ARegionIsWhatTheKeepOutsAndTheEdgeLeave) {
  const Polygon region{{{10, 0}, {25, 0}, {10, 15}}, {}};  // cut by two edges of the domain
  // Inside the domain: the box of 10 × 10 without the corner beyond x + y = const, 5 × 5 / 2.
  EXPECT_NEAR(area_of(free_area_within(region, kSize_m, {})), 100 - 12.5, 1e-12);
  const std::vector<Polygon> keep_outs{{box(11, 1, 2, 2), {}}, {box(12, 2, 2, 2), {}}};
  EXPECT_NEAR(area_of(free_area_within(region, kSize_m, keep_outs)), 100 - 12.5 - 7, 1e-12);
}

TEST(FreeArea, OfStarsThatCrossAgreesWithPointsWhereverOneLooks) {
  std::vector<Polygon> stars;
  for (int k = 0; k < 5; ++k) {
    Ring star;
    for (int i = 0; i < 14; ++i) {
      const double radius = i % 2 == 0 ? 4.1 : 1.3, angle = 0.1 + k + i * std::acos(-1.0) / 7;
      star.emplace_back(4.3 + 2.7 * k + radius * std::cos(angle), 4.8 + radius * std::sin(angle));
    }
    stars.push_back({star, {}});
  }
  const std::vector<Trapezoid> pieces = free_area(kSize_m, stars);
  int free_points = 0;
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 100; ++j) {
      const Eigen::Vector2d x_m(0.05 + 0.1 * i, 0.05 + 0.1 * j);
      bool kept_out = false;
      for (const Polygon& star : stars) kept_out = kept_out || contains(star, x_m);
      ASSERT_EQ(pieces_around(pieces, x_m), kept_out ? 0 : 1) << x_m.transpose();
      free_points += kept_out ? 0 : 1;
    }
  }
  // Points of 0.1 × 0.1 give the area up to the cells that edges cut: 70 edges of about 3.2.
  EXPECT_NEAR(area_of(pieces), 0.01 * free_points, 0.5);
}

}  // namespace
}  // namespace ergocast
