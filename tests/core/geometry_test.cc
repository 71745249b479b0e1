// SPDX-License-Identifier: BSD-3-Clause
// Reflection at the edges: a point never ends outside, and one that is inside is not touched.
#include "core/geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/noise.h"

namespace ergocast {
namespace {

const Rectangle kUnit{{0, 0}, {2000, 2000}};
const Rectangle kMoved{{-37.3, 1e4}, {0.7, 333.3}};

TEST(Rectangle, ContainsItsEdgesAndNothingBeyond) {
  EXPECT_TRUE(kUnit.contains({0, 0}));
  EXPECT_TRUE(kUnit.contains({2000, 2000}));
  EXPECT_TRUE(kUnit.contains({-0.0, 5}));
  EXPECT_FALSE(kUnit.contains({std::nextafter(2000.0, 3000.0), 5}));
  EXPECT_FALSE(kUnit.contains({5, -std::numeric_limits<double>::denorm_min()}));
  EXPECT_FALSE(kUnit.contains({std::numeric_limits<double>::quiet_NaN(), 5}));
}

TEST(Rectangle, FarthestPointIsACorner) {
  EXPECT_DOUBLE_EQ(kUnit.farthest_distance_m({0, 0}), std::hypot(2000, 2000));
  EXPECT_DOUBLE_EQ(kUnit.farthest_distance_m({1500, 400}), std::hypot(1500, 1600));
  EXPECT_DOUBLE_EQ(kUnit.farthest_distance_m({-100, 2500}), std::hypot(2100, 2500));
}

TEST(Reflect, ReturnsPointsInsideBitForBit) {
  for (const double x : {0.0, -0.0, 5e-324, 1e-14, 1.0, 1999.9999999999998, 2000.0}) {
    const Eigen::Vector2d reflected = reflect({x, 1000}, kUnit);
    EXPECT_EQ(reflected.x(), x);
    EXPECT_EQ(std::signbit(reflected.x()), std::signbit(x));
  }
}

TEST(Reflect, FoldsAtBothEdges) {
  EXPECT_EQ(reflect({-3, 2007}, kUnit), Eigen::Vector2d(3, 1993));
  EXPECT_EQ(reflect({2000.5, -0.25}, kUnit), Eigen::Vector2d(1999.5, 0.25));
}

TEST(Reflect, KeepsTheSmallestStepAwayFromAnEdge) {
  // An agent that lands a rounding error outside is not set onto the edge, which it would not leave.
  for (const double tiny : {1e-13, 1e-14, 1e-17, 1e-300, 5e-324}) {
    EXPECT_EQ(reflect({-tiny, 1000}, kUnit).x(), tiny);
  }
}

TEST(Reflect, FoldsStepsLongerThanTheDomain) {
  EXPECT_EQ(reflect({-2100, 4100}, kUnit), Eigen::Vector2d(1900, 100));
  // 4000 is a period: 100 003 of them and −7, and half a period more and 7.
  EXPECT_EQ(reflect({100003 * 4000.0 - 7, 100003 * 4000.0 + 2007}, kUnit),
            Eigen::Vector2d(7, 1993));
}

TEST(Reflect, NeverLeavesThePointOutside) {
  for (const Rectangle& domain : {kUnit, kMoved}) {
    for (std::uint64_t i = 0; i < 100000; ++i) {
      // From a rounding error to 10^15 times the size, either side.
      const Eigen::Vector2d u = uniform_pair(1, Purpose::kFault, 0, i);
      const double reach = std::pow(10, 31 * u.x() - 16) * (i % 2 == 0 ? 1 : -1);
      const Eigen::Vector2d x_m = domain.origin_m + (i % 3 == 0 ? domain.size_m : domain.size_m * 0) +
                                  reach * Eigen::Vector2d(domain.size_m.x(), -domain.size_m.y());
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
    EXPECT_NEAR(reflect({x, 1}, kUnit).x(), folded, 4 * 29200 * 0x1p-53);
  }
}

TEST(ReflectDeathTest, StopsACallerWithoutAPosition) {
  EXPECT_DEATH(reflect({std::numeric_limits<double>::quiet_NaN(), 1}, kUnit),
               "broken precondition");
}

}  // namespace
}  // namespace ergocast
