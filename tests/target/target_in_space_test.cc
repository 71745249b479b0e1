// SPDX-License-Identifier: BSD-3-Clause
// μ in a box: each part against direct sums over a fine grid of the density itself.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/target/plane_target.h"

namespace ergocast {
namespace {

const Box kBox{{-30, 5, -80}, {200, 120, 60}};
const Basis kModesInSpace{.modes_x = 4, .modes_y = 3, .modes_z = 5};

/// ∫ f_lmn ρ by the midpoint rule on `cells` cells along each axis, not divided by the mass.
Coefficients brute_force(const TargetDensity& target, int cells) {
  Coefficients sum = Coefficients::Zero(kModesInSpace.mode_count());
  const double cell_m3 = kBox.content() / std::pow(cells, 3);
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      for (int k = 0; k < cells; ++k) {
        const Eigen::Vector3d share = (Eigen::Vector3d(i, j, k).array() + 0.5) / cells;
        const Eigen::Vector3d x_m = kBox.origin_m + share.cwiseProduct(kBox.size_m);
        const double density = density_unscaled(target, kBox, x_m);
        if (density > 0) sum += cell_m3 * density * basis_values(x_m, kBox, kModesInSpace);
      }
    }
  }
  return sum;
}

double largest_difference(const Coefficients& a, const Coefficients& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

Gaussian bell(const Eigen::Vector3d& mean_m, const Eigen::Matrix3d& covariance_m2) {
  return {0.7, mean_m, covariance_m2};
}

/// Deviations of 30, 20 and 12 m with these correlations.
Eigen::Matrix3d covariance(double xy, double xz, double yz) {
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Identity();
  correlation(0, 1) = correlation(1, 0) = xy;
  correlation(0, 2) = correlation(2, 0) = xz;
  correlation(1, 2) = correlation(2, 1) = yz;
  const Eigen::Vector3d deviation_m(30, 20, 12);
  return deviation_m.asDiagonal() * correlation * deviation_m.asDiagonal();
}

// Where the domain's sides do not cut them, Gaussians are smooth, and the midpoint rule is exact up
// to rounding. A side adds the square of a cell.
TEST(TargetInSpace, OfGaussiansIsThatOfTheirDensity) {
  for (const auto& [xy, xz, yz] :
       {std::array{0.0, 0.0, 0.0}, {0.8, 0.0, 0.0}, {0.0, 0.7, 0.0}, {0.3, -0.5, 0.6}}) {
    const TargetDensity target{{bell({60, 70, -45}, covariance(xy, xz, yz))}, 0.2};
    const TargetCoefficients ours = target_integrals(target, kBox, kModesInSpace);
    EXPECT_LE(largest_difference(ours.values, brute_force(target, 60)), 4e-4) << xz;
    EXPECT_LE(ours.error_bound, 1e-9) << xz;
  }
}

// A Gaussian well inside has its characteristic function, E Π cos(k_i X_i), up to rounding.
TEST(TargetInSpace, OfAnObliqueGaussianIsItsCharacteristicFunction) {
  const Gaussian g{1, {70, 65, -50}, 0.04 * covariance(0.3, -0.5, 0.6)};
  const TargetCoefficients ours = target_coefficients({{g}, 0}, kBox, kModesInSpace);
  const Eigen::Vector3d mean_m = g.mean_m - kBox.origin_m;
  for (int l = 0; l < kModesInSpace.modes_z; ++l) {
    for (int m = 0; m < kModesInSpace.modes_x; ++m) {
      for (int n = 0; n < kModesInSpace.modes_y; ++n) {
        double sum = 0;
        for (const double sign_y : {1.0, -1.0}) {
          for (const double sign_z : {1.0, -1.0}) {
            const Eigen::Vector3d k =
                std::numbers::pi *
                Eigen::Vector3d(m, sign_y * n, sign_z * l).cwiseQuotient(kBox.size_m);
            sum += std::exp(-0.5 * k.dot(g.covariance_m2 * k)) * std::cos(k.dot(mean_m)) / 4;
          }
        }
        EXPECT_NEAR(ours.values[(l * kModesInSpace.modes_x + m) * kModesInSpace.modes_y + n], sum,
                    1e-11);
      }
    }
  }
}

/// Edges on the brute force's grid, so that its cells are whole.
Polygon square(double x_m, double y_m, double side_m) {
  return {{{x_m, y_m}, {x_m + side_m, y_m}, {x_m + side_m, y_m + side_m}, {x_m, y_m + side_m}}, {}};
}

TEST(TargetInSpace, OfPrismsAndKeepOutsAtOtherHeightsIsThatOfTheirDensity) {
  const Region region{1.5, square(-10, 25, 60), {-60, -35}};
  const TargetDensity target{
      {}, 0.4, {region}, {{square(10, 45, 40), {-50, -20}}, {square(90, 5, 40), {-80, -65}}}};
  const Coefficients ours = target_integrals(target, kBox, kModesInSpace).values;
  // The midpoint rule of a cosine over whole cells is off by the square of a cell.
  EXPECT_LE(largest_difference(ours, brute_force(target, 120)), 2e-4);
  const double volume = 200 * 120 * 60, free = volume - 1600 * 30 - 1600 * 15;
  const double covered = 1 - 1600.0 * 15 / (3600 * 25);
  EXPECT_NEAR(ours[0], 0.4 * free / volume + 1.5 * covered, 1e-12);
  EXPECT_NEAR(free_share(region, target, kBox), covered, 1e-12);
}

// Keep-outs cut a Gaussian whose mean moves with the height.
TEST(TargetInSpace, OfAnObliqueGaussianBesideAKeepOutIsThatOfItsDensity) {
  const TargetDensity target{
      {bell({60, 70, -45}, covariance(0.2, 0.6, -0.4))}, 0, {}, {{square(50, 65, 40), {-50, -20}}}};
  const TargetCoefficients ours = target_integrals(target, kBox, kModesInSpace);
  EXPECT_LE(largest_difference(ours.values, brute_force(target, 120)), 2e-3);
  EXPECT_LE(ours.error_bound, 1e-9);
}

TEST(TargetInSpace, OfAUniformTargetIsTheFirstModeAlone) {
  const Coefficients mu = target_coefficients({{}, 2}, kBox, kModesInSpace).values;
  EXPECT_EQ(mu, Coefficients::Unit(kModesInSpace.mode_count(), 0));
}

TEST(TargetInSpace, FromAboveHasTheMassOfTheTarget) {
  const TargetDensity target{{bell({60, 70, -45}, covariance(0.2, 0.6, -0.4))},
                             0.4,
                             {{1.5, square(-10, 25, 60), {-60, -35}}},
                             {{square(10, 45, 40), {-50, -20}}}};
  const DensityGrid picture = picture_of(target, kBox, 100, 60);
  EXPECT_NEAR(picture.mean() * 200 * 120, mass_inside(target, kBox), 2e-3);
}

}  // namespace
}  // namespace ergocast
