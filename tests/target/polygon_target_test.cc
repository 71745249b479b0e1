// SPDX-License-Identifier: BSD-3-Clause
// Targets with regions and keep-outs: exact against quadrature over triangles, Gaussians within
// their stated error.
#include <gtest/gtest.h>

#include "target/density_picture.h"
#include "tests/target/plane_target.h"
#include "tests/target/polygon_reference.h"

namespace ergocast {
namespace {

using namespace test;

const Rectangle kDomain{{-300, 50}, {2000, 1200}};
const Basis kBasis{.modes_x = 12, .modes_y = 9};

Ring box(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

Gaussian bell(double x_m, double y_m, double deviation_x_m, double deviation_y_m,
              double correlation = 0) {
  const double covariance = correlation * deviation_x_m * deviation_y_m;
  Eigen::Matrix2d covariance_m2;
  covariance_m2 << deviation_x_m * deviation_x_m, covariance, covariance,
      deviation_y_m * deviation_y_m;
  return plane_gaussian(1, {x_m, y_m}, covariance_m2);
}

PlaneCoefficients area_reference(const Ring& ring) {
  return over_ring(ring, one, kDomain, kBasis, 40);
}

TEST(Regions, WithHolesAreUniformInside) {
  const Ring outline{{0, 100}, {900, 200}, {1100, 900}, {400, 600}, {-100, 1000}};
  const Ring hole{{300, 300}, {500, 320}, {420, 480}};
  for (const bool clockwise : {false, true}) {
    Polygon polygon{outline, {hole}};
    if (clockwise) std::reverse(polygon.holes[0].begin(), polygon.holes[0].end());
    if (clockwise) std::reverse(polygon.outline.begin(), polygon.outline.end());
    const PlaneIntegrals ours = target_coefficients({{}, 0, {{3, polygon}}}, kDomain, kBasis);
    const PlaneCoefficients expected = area_reference(outline) - area_reference(hole);
    EXPECT_LE(largest_difference(ours.values, expected / expected(0, 0)), 1e-12);
    EXPECT_LE(ours.error_bound, 1e-10);
  }
}

TEST(Regions, WeighTheirWholeMassAlsoWhatIsOutside) {
  const Polygon half{box(-400, 100, 200, 50), {}}, whole{box(500, 500, 100, 100), {}};
  const TargetDensity target{{}, 0.25, {{1, half}, {2, whole}}};
  EXPECT_NEAR(mass_inside(target, kDomain), 0.5 + 2 + 0.25, 1e-13);
  const PlaneCoefficients mu = target_coefficients(target, kDomain, kBasis).values;
  PlaneCoefficients expected = area_reference(box(-300, 100, 100, 50)) / 10000 +
                               2 * area_reference(box(500, 500, 100, 100)) / 10000;
  expected(0, 0) += 0.25;
  EXPECT_LE(largest_difference(mu, expected / 2.75), 1e-12);
}

TEST(Regions, OfTheWholeDomainAreTheUniformTarget) {
  const Polygon domain{box(-300, 50, 2000, 1200), {}};
  PlaneCoefficients expected = PlaneCoefficients::Zero(12, 9);
  expected(0, 0) = 1;
  EXPECT_LE(largest_difference(target_coefficients({{}, 0, {{1, domain}}}, kDomain, kBasis).values,
                               expected),
            1e-14);
}

// Inclusion and exclusion by hand: the two share a box of 100 × 100.
TEST(KeepOuts, ThatOverlapTakeAwayTheirUnion) {
  const Ring first = box(200, 300, 300, 300), second = box(400, 500, 300, 300);
  const TargetDensity target{{}, 1, {}, {{{first, {}}}, {{second, {}}}}};
  PlaneCoefficients expected = PlaneCoefficients::Zero(12, 9);
  expected(0, 0) = 2000 * 1200;
  expected +=
      area_reference(box(400, 500, 100, 100)) - area_reference(first) - area_reference(second);
  const PlaneIntegrals ours = target_coefficients(target, kDomain, kBasis);
  EXPECT_LE(largest_difference(ours.values, expected / expected(0, 0)), 1e-12);
  EXPECT_LE(ours.error_bound, 1e-11);
}

TEST(KeepOuts, CutRegionsToo) {
  const Ring region = box(0, 100, 1000, 500), keep_out{{500, 50}, {800, 350}, {200, 350}};
  const TargetDensity target{{}, 0, {{1, {region, {}}}}, {{{keep_out, {}}}}};
  // The triangle's tip lies below the region, which takes away what is above y = 100.
  const Ring inside{{450, 100}, {550, 100}, {800, 350}, {200, 350}};
  const PlaneCoefficients expected = area_reference(region) - area_reference(inside);
  EXPECT_LE(largest_difference(target_coefficients(target, kDomain, kBasis).values,
                               expected / expected(0, 0)),
            1e-12);
}

// The part that a triangle takes from a Gaussian, by quadrature on 60 × 60 panels of five nodes
// each.
TEST(KeepOuts, OverGaussiansAreWithinTheStatedError) {
  const Ring triangle{{600, 400}, {1000, 700}, {500, 900}};
  for (const Gaussian& g : {bell(700, 650, 150, 100), bell(700, 650, 120, 150, 0.9),
                            bell(700, 650, 120, 150, -0.99), bell(640, 700, 15, 25, 0.5)}) {
    const TargetDensity alone{{g}, 0};
    const PlaneCoefficients whole = target_integrals(alone, kDomain, kBasis).values;
    const PlaneCoefficients taken = over_ring(
        triangle, [&](const Eigen::Vector2d& x_m) { return density_unscaled(alone, kDomain, x_m); },
        kDomain, kBasis, 60);
    const PlaneIntegrals ours = target_integrals({{g}, 0, {}, {{{triangle, {}}}}}, kDomain, kBasis);
    EXPECT_LE(largest_difference(ours.values, whole - taken), ours.error_bound + 1e-12);
    EXPECT_LE(ours.error_bound, 1e-11);
    EXPECT_LT(ours.values(0, 0), 0.9 * whole(0, 0));
  }
}

TEST(KeepOuts, ThatTouchNothingChangeNothing) {
  const TargetDensity without{{bell(1000, 600, 90, 60), bell(900, 700, 80, 90, 0.6)}, 0.5};
  TargetDensity with = without;
  with.keep_outs = {{{box(5000, 5000, 10, 10), {}}}};
  EXPECT_LE(largest_difference(target_coefficients(with, kDomain, kBasis).values,
                               target_coefficients(without, kDomain, kBasis).values),
            1e-13);
}

TEST(KeepOuts, OverEverythingLeaveNoMass) {
  const TargetDensity target{{bell(500, 500, 50, 50)}, 1, {}, {{{box(-400, 0, 3000, 3000), {}}}}};
  EXPECT_EQ(mass_inside(target, kDomain), 0);
}

TEST(Density, IsZeroInKeepOutsAndUniformInRegions) {
  const TargetDensity target{{},
                             1.2,
                             {{2, {box(0, 100, 100, 100), {}}}},
                             {{{box(50, 150, 100, 100), {box(60, 160, 10, 10)}}}}};
  const double floor = 1.2 / (2000 * 1200), inside = 2.0 / 10000;
  EXPECT_DOUBLE_EQ(density_unscaled(target, kDomain, {1000, 600}), floor);
  EXPECT_DOUBLE_EQ(density_unscaled(target, kDomain, {10, 110}), floor + inside);
  EXPECT_EQ(density_unscaled(target, kDomain, {55, 155}), 0);
  EXPECT_DOUBLE_EQ(density_unscaled(target, kDomain, {65, 165}), floor + inside);
}

TEST(DensityPicture, HasTheMassOfTheTarget) {
  const TargetDensity target{{bell(700, 650, 150, 100)},
                             0.5,
                             {{1, {{{0, 100}, {900, 200}, {400, 800}}, {}}}},
                             {{{{{600, 400}, {1000, 700}, {500, 900}}, {}}}}};
  const DensityGrid picture = picture_of(target, plane_of(kDomain), 256, 154);
  EXPECT_NEAR(picture.mean() * 2000 * 1200, mass_inside(target, kDomain), 2e-3);
  EXPECT_EQ(picture(128, 77), 0);  // (700, 650), inside the keep-out
}

}  // namespace
}  // namespace ergocast
