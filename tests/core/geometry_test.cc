// SPDX-License-Identifier: BSD-3-Clause
// Reflection at the edges: a point never ends outside, and one that is inside is not touched.
#include "core/base/geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/noise.h"

namespace ergocast {
namespace {

const Box kUnit{{0, 0, 0}, {2000, 2000, 0}};
const Box kMoved{{-37.3, 1e4, 0}, {0.7, 333.3, 0}};

TEST(Box, ContainsItsEdgesAndNothingBeyond) {
  EXPECT_TRUE(kUnit.contains({0, 0, 0}));
  EXPECT_TRUE(kUnit.contains({2000, 2000, 0}));
  EXPECT_TRUE(kUnit.contains({-0.0, 5, 0}));
  EXPECT_FALSE(kUnit.contains({std::nextafter(2000.0, 3000.0), 5, 0}));
  EXPECT_FALSE(kUnit.contains({5, -std::numeric_limits<double>::denorm_min(), 0}));
  EXPECT_FALSE(kUnit.contains({std::numeric_limits<double>::quiet_NaN(), 5, 0}));
}

TEST(Box, OfHeight0DoesNotLookAtZ) {
  EXPECT_TRUE(kUnit.planar());
  EXPECT_TRUE(kUnit.contains({5, 5, 77}));
  EXPECT_EQ(reflect({5, -6, 77}, kUnit), Eigen::Vector3d(5, 6, 0));
  EXPECT_EQ(kUnit.farthest_distance_m({0, 2000, 77}), std::hypot(2000, 2000));
  EXPECT_EQ(kUnit.shortest_side_m(), 2000);
  EXPECT_EQ(kMoved.content(), 0.7 * 333.3);
}

TEST(Box, InSpaceHasThreeSides) {
  const Box box{{0, 10, -4}, {20, 30, 8}};
  EXPECT_FALSE(box.planar());
  EXPECT_TRUE(box.contains({20, 10, 4}));
  EXPECT_FALSE(box.contains({5, 15, 4.1}));
  EXPECT_FALSE(box.contains({5, 15, -4.1}));
  EXPECT_EQ(reflect({-1, 41, 6}, box), Eigen::Vector3d(1, 39, 2));
  EXPECT_EQ(reflect({5, 15, -21}, box), Eigen::Vector3d(5, 15, -3)) << "over both sides";
  EXPECT_DOUBLE_EQ(box.farthest_distance_m({0, 10, -4}), std::sqrt(400 + 900 + 64));
  EXPECT_EQ(box.center_m(), Eigen::Vector3d(10, 25, 0));
  EXPECT_EQ(box.shortest_side_m(), 8);
  EXPECT_EQ(box.content(), 4800);
}

TEST(Box, FarthestPointIsACorner) {
  EXPECT_DOUBLE_EQ(kUnit.farthest_distance_m({0, 0, 0}), std::hypot(2000, 2000));
  EXPECT_DOUBLE_EQ(kUnit.farthest_distance_m({1500, 400, 0}), std::hypot(1500, 1600));
  EXPECT_DOUBLE_EQ(kUnit.farthest_distance_m({-100, 2500, 0}), std::hypot(2100, 2500));
}

TEST(Reflect, ReturnsPointsInsideBitForBit) {
  for (const double x : {0.0, -0.0, 5e-324, 1e-14, 1.0, 1999.9999999999998, 2000.0}) {
    const Eigen::Vector3d reflected = reflect({x, 1000, 0}, kUnit);
    EXPECT_EQ(reflected.x(), x);
    EXPECT_EQ(std::signbit(reflected.x()), std::signbit(x));
  }
}

TEST(Reflect, FoldsAtBothEdges) {
  EXPECT_EQ(reflect({-3, 2007, 0}, kUnit), Eigen::Vector3d(3, 1993, 0));
  EXPECT_EQ(reflect({2000.5, -0.25, 0}, kUnit), Eigen::Vector3d(1999.5, 0.25, 0));
}

TEST(Reflect, KeepsTheSmallestStepAwayFromAnEdge) {
  // An agent that is outside by a rounding error is not set onto the edge, which it would not
  // leave.
  for (const double tiny : {1e-13, 1e-14, 1e-17, 1e-300, 5e-324}) {
    EXPECT_EQ(reflect({-tiny, 1000, 0}, kUnit).x(), tiny);
  }
}

TEST(Reflect, FoldsStepsLongerThanTheDomain) {
  EXPECT_EQ(reflect({-2100, 4100, 0}, kUnit), Eigen::Vector3d(1900, 100, 0));
  // 4000 is a period: 100 003 of them and −7, and half a period more and 7.
  EXPECT_EQ(reflect({100003 * 4000.0 - 7, 100003 * 4000.0 + 2007, 0}, kUnit),
            Eigen::Vector3d(7, 1993, 0));
}

TEST(Reflect, NeverLeavesThePointOutside) {
  for (const Box& domain : {kUnit, kMoved}) {
    for (std::uint64_t i = 0; i < 100000; ++i) {
      // Distances from a rounding error to 10^15 times the size, on either side.
      const Eigen::Vector2d u = uniform_pair(1, Purpose::kFault, 0, i);
      const double reach = std::pow(10, 31 * u.x() - 16) * (i % 2 == 0 ? 1 : -1);
      const Eigen::Vector3d x_m = domain.origin_m +
                                  (i % 3 == 0 ? domain.size_m : domain.size_m * 0) +
                                  reach * Eigen::Vector3d(domain.size_m.x(), -domain.size_m.y(), 0);
      ASSERT_TRUE(domain.contains(reflect(x_m, domain))) << x_m.transpose();
    }
  }
}

TEST(Reflect, AgreesWithUnfoldingTheDomain) {
  // The distance to the nearest even multiple of the length, by the library's exact remainder.
  for (int i = -4000; i <= 4000; ++i) {
    const double x = 7.3 * i;
    const double folded = std::abs(std::remainder(x, 4000.0));
    // Two subtractions of numbers up to 29 200 at most.
    EXPECT_NEAR(reflect({x, 1, 0}, kUnit).x(), folded, 4 * 29200 * 0x1p-53);
  }
}

TEST(ReflectDeathTest, StopsACallerWithoutAPosition) {
  EXPECT_DEATH(reflect({std::numeric_limits<double>::quiet_NaN(), 1, 0}, kUnit),
               "broken precondition");
}

}  // namespace
}  // namespace ergocast
