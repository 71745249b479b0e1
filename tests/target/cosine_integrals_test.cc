// SPDX-License-Identifier: BSD-3-Clause
// Closed forms against quadrature, also where terms could cancel.
#include "target/cosine_integrals.h"

#include <gtest/gtest.h>

#include "tests/target/polygon_reference.h"

namespace ergocast {
namespace {

using namespace test;

const Rectangle kDomain{{0, 0}, {20, 12}};
const Basis kBasis{.modes_x = 14, .modes_y = 11};
/// The reference's own sums of 60 000 terms are good to 1e-13 of an area of at most 240.
constexpr double kTolerance = 240e-13;

PlaneCoefficients closed_form(const Ring& ring, double density = 1) {
  PlaneCoefficients sums = PlaneCoefficients::Zero(kBasis.modes_x, kBasis.modes_y);
  add_polygon(ring, density, kDomain.size_m, sums);
  return sums;
}

TEST(CosineIntegrals, AlongAnIntervalAreThePrimitivesDifferences) {
  const Eigen::VectorXd integrals = cosine_integrals(3, 4.5, 20, 64);
  EXPECT_DOUBLE_EQ(integrals[0], 1.5);
  for (int m = 1; m < 64; ++m) {
    const double a = m * std::numbers::pi / 20;
    EXPECT_NEAR(integrals[m], (std::sin(a * 4.5) - std::sin(a * 3)) / a, 1e-14) << m;
  }
}

TEST(CosineIntegrals, OfAShortIntervalKeepAllTheirDigits) {
  // Over such a short interval, cos is the value in its middle up to (a·length)²/24 < 1e-18. A
  // difference of sines would keep only six digits.
  const double low = 7, length = 1e-9;
  const Eigen::VectorXd integrals = cosine_integrals(low, low + length, 20, 8);
  const double exact_length = (low + length) - low;
  for (int m = 0; m < 8; ++m) {
    const double expected = exact_length * std::cos(m * std::numbers::pi * (low + length / 2) / 20);
    EXPECT_NEAR(integrals[m], expected, 1e-15 * length) << m;
  }
}

TEST(PolygonIntegrals, AreThoseOfQuadrature) {
  const Ring rings[] = {
      {{2, 1}, {18, 3}, {11, 10}},
      {{0, 0}, {20, 0}, {20, 12}, {0, 12}},
      {{1, 1}, {12, 1}, {12, 11}, {9, 11}, {9, 4}, {1, 4}},  // an L
      {{1, 6}, {10, 5}, {19, 6}, {10, 5.5}},                 // a dart, not convex
      {{3, 3}, {3 + 12.0 / 7 * 4, 3 + 4}, {3, 8}},
  };
  for (const Ring& ring : rings) {
    const PlaneCoefficients expected = over_ring(ring, one, kDomain, kBasis, 50);
    EXPECT_LE(largest_difference(closed_form(ring), expected), kTolerance);
    EXPECT_LE(largest_difference(closed_form(ring, 3), 3 * expected), 3 * kTolerance);
  }
}

// Along an edge with m/Lx · dx = ± n/Ly · dy one of the two phases is constant: 0/0 without sinc.
TEST(PolygonIntegrals, HaveNoPoleWhereAnEdgeFollowsAWave) {
  const double slope = kDomain.size_m.y() / kDomain.size_m.x();
  for (const double off : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1e-2}) {
    const Ring ring{{1, 1}, {11, 1}, {11, 1 + 10 * slope * (1 + off)}};
    EXPECT_LE(largest_difference(closed_form(ring), over_ring(ring, one, kDomain, kBasis, 50)),
              kTolerance)
        << off;
  }
}

TEST(PolygonIntegrals, OfASmallPolygonAreWithinTheirStatedError) {
  const Ring ring{{10, 6}, {10.001, 6}, {10.0005, 6.0008}};
  PlaneCoefficients sums = PlaneCoefficients::Zero(kBasis.modes_x, kBasis.modes_y);
  const double bound = add_polygon(ring, 1, kDomain.size_m, sums);
  EXPECT_LE(largest_difference(sums, over_ring(ring, one, kDomain, kBasis, 1)), bound);
  EXPECT_LE(bound, 1e-15 * 1000);  // of an area of 4e-7
}

}  // namespace
}  // namespace ergocast
