// SPDX-License-Identifier: BSD-3-Clause
// The cosine basis (2): values against the cosines themselves, the gradient against differences of
// the values, the weights against their definition, Parseval against a mean over the domain.
#include "core/basis/basis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ergocast {
namespace {

constexpr double kRounding = 0x1p-53;

/// Rounding of cos(mπx/L) by recurrence. Per mode: at most 4 roundings in the complex product, the
/// first cosine and sine off by 2, and the first angle ≤ π off by 3 relative roundings: 3π < 10.
double cosine_bound(int mode) { return 16 * (mode + 1) * kRounding; }

const Box kDomain{{-30, 500, 0}, {200, 70, 0}};

Basis basis_of(int modes_x, int modes_y) {
  Basis basis;
  basis.modes_x = modes_x;
  basis.modes_y = modes_y;
  return basis;
}

/// cos(mode·π·x/length) with the longer long double, so that its own rounding does not count.
double exact_cosine(int mode, double x, double length) {
  return static_cast<double>(
      std::cos(mode * std::numbers::pi_v<long double> * x / static_cast<long double>(length)));
}

/// Points in the middle, on edges, in corners and next to them.
std::vector<Eigen::Vector3d> telling_points() {
  return {{-30, 500, 0},  {170, 570, 0},           {-30, 570, 0},
          {70, 535, 0},   {-12.34, 501.5, 0},      {169.99, 500, 0},
          {0, 569.25, 0}, {-30 + 1e-12, 569.9, 0}, {103.25, 544.5, 0}};
}

/// Weights without any pattern, of order 1.
Coefficients uneven_weights(int modes_x, int modes_y) {
  PlaneCoefficients weights(modes_x, modes_y);
  for (int m = 0; m < modes_x; ++m) {
    for (int n = 0; n < modes_y; ++n) weights(m, n) = std::sin(1.0 + 3.7 * m + 1.3 * n * n);
  }
  return in_basis_order(weights);
}

TEST(Basis, ValuesAreProductsOfCosinesUpToTheErrorOfTheRecurrence) {
  const Basis basis = basis_of(64, 64);
  for (const Eigen::Vector3d& x_m : telling_points()) {
    const Eigen::Vector3d inside = x_m - kDomain.origin_m;
    const Coefficients values = basis_values(x_m, kDomain, basis);
    for (int m = 0; m < 64; ++m) {
      for (int n = 0; n < 64; ++n) {
        const double exact = exact_cosine(m, inside.x(), 200) * exact_cosine(n, inside.y(), 70);
        EXPECT_NEAR(values[64 * m + n], exact, cosine_bound(m) + cosine_bound(n))
            << m << "," << n << " at " << x_m.transpose();
      }
    }
  }
}

TEST(Basis, SlopesAreTheDerivativesOfTheCosines) {
  const BasisAt at({-12.34, 501.5, 0}, kDomain, basis_of(64, 64));
  const double x = -12.34 - -30.0, k = std::numbers::pi / 200;
  for (int m = 0; m < 64; ++m) {
    EXPECT_NEAR(at.slope_x[m], -m * k * std::sin(m * k * x), 2 * m * k * cosine_bound(m)) << m;
  }
}

TEST(Basis, ExceedsOneByFarLessThanContributionsAreAllowedTo) {
  // CoverageTable::merge allows 1e-9; cosine_bound(63) is 1.1e-13.
  for (const Eigen::Vector3d& x_m : telling_points()) {
    const Coefficients values = basis_values(x_m, kDomain, basis_of(64, 64));
    EXPECT_LE(values.cwiseAbs().maxCoeff(), 1 + 2 * cosine_bound(63));
  }
}

TEST(Basis, HasNoSlopeAcrossTheLowEdgeAndOnlyRoundingAcrossTheHighOne) {
  const BasisAt low(kDomain.origin_m, kDomain, basis_of(15, 15));
  const BasisAt high(kDomain.origin_m + kDomain.size_m, kDomain, basis_of(15, 15));
  for (int m = 0; m < 15; ++m) {
    EXPECT_EQ(low.slope_x[m], 0);
    EXPECT_EQ(low.slope_y[m], 0);
    EXPECT_NEAR(high.slope_x[m], 0, m * std::numbers::pi / 200 * cosine_bound(m));
    EXPECT_NEAR(high.slope_y[m], 0, m * std::numbers::pi / 70 * cosine_bound(m));
  }
}

TEST(Basis, AccumulatesTheIntegralOfEveryMode) {
  const Basis basis = basis_of(7, 5);
  Coefficients sums = Coefficients::Zero(35), expected = Coefficients::Zero(35);
  for (const Eigen::Vector3d& x_m : telling_points()) {
    accumulate_basis(BasisAt(x_m, kDomain, basis), basis, 0.25, sums.data());
    expected += 0.25 * basis_values(x_m, kDomain, basis);
  }
  // dt is a power of two, so only the additions round: 9 of them, on sums of at most 9/4.
  EXPECT_LE((sums - expected).cwiseAbs().maxCoeff(), 9 * 2.25 * kRounding);
  EXPECT_EQ(sums[0], 9 * 0.25) << "f_00 = 1, so S_00 is the time covered";
}

/// Bounds |central difference − weighted_gradient| along an axis with wave numbers k = mode·π/L:
/// h²/6 of the third derivative, the values' rounding over h, the gradient's own rounding.
double difference_bound(const PlaneCoefficients& weights, double unit_x, double unit_y,
                        bool along_x, double h) {
  double bound = 0;
  for (int m = 0; m < weights.rows(); ++m) {
    for (int n = 0; n < weights.cols(); ++n) {
      const double k = along_x ? m * unit_x : n * unit_y;
      const double value_error = cosine_bound(m) + cosine_bound(n);
      bound +=
          std::abs(weights(m, n)) * (k * k * k * h * h / 6 + value_error / h + 4 * k * value_error);
    }
  }
  // Adding up K products of at most |w| rounds at most K times more.
  return bound + static_cast<double>(weights.size()) * weights.cwiseAbs().sum() * kRounding / h;
}

TEST(Basis, WeightedGradientIsTheSlopeOfTheWeightedSum) {
  const Basis basis = basis_of(15, 12);
  const Coefficients weights = uneven_weights(15, 12);
  const double h = 0x1p-12, unit_x = std::numbers::pi / 200, unit_y = std::numbers::pi / 70;
  const auto sum_at = [&](double x, double y) {
    return basis_values({x, y, 0}, kDomain, basis).cwiseProduct(weights).sum();
  };
  // Dyadic points, so that x ± h is exact.
  for (const Eigen::Vector3d& x :
       {Eigen::Vector3d{-12.375, 501.5, 0}, {103.25, 544.5, 0}, {1, 569.5, 0}}) {
    const Eigen::Vector3d gradient =
        weighted_gradient(BasisAt(x, kDomain, basis), basis, weights.data());
    const double bound_x = difference_bound(in_plane(weights, basis), unit_x, unit_y, true, h);
    const double bound_y = difference_bound(in_plane(weights, basis), unit_x, unit_y, false, h);
    ASSERT_LT(bound_x, 1e-3 * gradient.cwiseAbs().maxCoeff()) << "the comparison is worth it";
    ASSERT_LT(bound_y, 1e-3 * gradient.cwiseAbs().maxCoeff());
    EXPECT_NEAR(gradient.x(), (sum_at(x.x() + h, x.y()) - sum_at(x.x() - h, x.y())) / (2 * h),
                bound_x);
    EXPECT_NEAR(gradient.y(), (sum_at(x.x(), x.y() + h) - sum_at(x.x(), x.y() - h)) / (2 * h),
                bound_y);
  }
}

TEST(SobolevWeights, FollowTheirTwoForms) {
  Basis basis = basis_of(3, 4);
  EXPECT_DOUBLE_EQ(sobolev_weights(basis, kDomain)[0], 1);
  EXPECT_DOUBLE_EQ(sobolev_weights(basis, kDomain)[6], std::pow(6.0, -1.5));
  EXPECT_DOUBLE_EQ(sobolev_weights(basis, kDomain)[8], std::pow(5.0, -1.5));
  basis.sobolev_form = SobolevForm::kNorm;
  basis.sobolev_exponent = 2;
  EXPECT_DOUBLE_EQ(sobolev_weights(basis, kDomain)[0], 1);
  EXPECT_DOUBLE_EQ(sobolev_weights(basis, kDomain)[6], std::pow(1 + std::sqrt(5.0), -2));
}

TEST(SobolevWeights, CarryTheNormOfEachModeWhereTheBasisIsNormalized) {
  Basis basis = basis_of(2, 2);
  const Coefficients plain = sobolev_weights(basis, kDomain);
  basis.normalized = true;
  const Coefficients normalized = sobolev_weights(basis, kDomain);
  const double area_m2 = 200 * 70;
  EXPECT_DOUBLE_EQ(normalized[0], plain[0] / area_m2);
  EXPECT_DOUBLE_EQ(normalized[2], plain[2] / (area_m2 / 2));
  EXPECT_DOUBLE_EQ(normalized[1], plain[1] / (area_m2 / 2));
  EXPECT_DOUBLE_EQ(normalized[3], plain[3] / (area_m2 / 4));
}

TEST(SobolevWeights, NormAgreesWithTheMeanSquareOfTheMode) {
  // The midpoint rule with more points than twice the highest mode is exact for these products.
  const Basis basis = basis_of(4, 3);
  Basis normalized = basis;
  normalized.normalized = true;
  const Coefficients squared_norm =
      sobolev_weights(basis, kDomain).cwiseQuotient(sobolev_weights(normalized, kDomain));
  Coefficients mean = Coefficients::Zero(12);
  constexpr int kPoints = 16;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const Eigen::Vector3d x_m{-30 + 200 * (i + 0.5) / kPoints, 500 + 70 * (j + 0.5) / kPoints, 0};
      mean += basis_values(x_m, kDomain, basis).cwiseAbs2() / (kPoints * kPoints);
    }
  }
  // 256 terms of at most 1, each within 2 · cosine_bound(3) and one rounding of the sum.
  EXPECT_LE((squared_norm / (200 * 70) - mean).cwiseAbs().maxCoeff(),
            4 * cosine_bound(3) + 256 * kRounding);
}

TEST(GradientEnergies, GiveTheMeanSquareOfTheGradientByParseval) {
  const Basis basis = basis_of(6, 5);
  const Coefficients weights = uneven_weights(6, 5);
  // Products of two modes have frequencies up to 10; 16 midpoints integrate them exactly.
  constexpr int kPoints = 16;
  double mean = 0;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const Eigen::Vector3d x_m{-30 + 200 * (i + 0.5) / kPoints, 500 + 70 * (j + 0.5) / kPoints, 0};
      mean += weighted_gradient(BasisAt(x_m, kDomain, basis), basis, weights.data()).squaredNorm();
    }
  }
  mean /= kPoints * kPoints;
  const double parseval = weights.cwiseAbs2().cwiseProduct(gradient_energies(basis, kDomain)).sum();
  // Each of the 256 squares is of 30 products with 2 · cosine_bound relative error, added up.
  EXPECT_NEAR(mean / parseval, 1, 30 * 4 * cosine_bound(5) + 256 * kRounding);
}

TEST(ErgodicMetric, IsTheWeightedSquareOfTheDifference) {
  const Coefficients coverage{{1, 0.5, -0.25, 0}}, target{{1, 0, 0.25, 0.5}};
  const Coefficients weights{{1, 2, 4, 8}};
  EXPECT_DOUBLE_EQ(ergodic_metric(coverage, target, weights), 2 * 0.25 + 4 * 0.25 + 8 * 0.25);
  EXPECT_EQ(ergodic_metric(target, target, weights), 0);
}

TEST(Basis, HessianIsTheSlopeOfTheGradient) {
  const Basis basis = basis_of(9, 6);
  const Coefficients weights = uneven_weights(9, 6);
  constexpr double kStep_m = 1e-3;
  const auto gradient = [&](const Eigen::Vector3d& x_m) {
    return weighted_gradient(BasisAt(x_m, kDomain, basis), basis, weights.data());
  };
  for (const Eigen::Vector3d& x_m :
       {Eigen::Vector3d(-12.34, 501.5, 0), {70, 535, 0}, {103.25, 544.5, 0}}) {
    const auto [at, hessian] =
        weighted_field(BasisAt(x_m, kDomain, basis), basis, kDomain, weights.data());
    EXPECT_EQ(at, gradient(x_m)) << "bit for bit";
    for (const int axis : {0, 1}) {
      const Eigen::Vector3d step_m = kStep_m * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d slope =
          (gradient(x_m + step_m) - gradient(x_m - step_m)) / (2 * kStep_m);
      EXPECT_LT((hessian.col(axis) - slope).norm(), 1e-6 * hessian.norm()) << x_m.transpose();
    }
  }
}

TEST(Basis, OutsideTheDomainItIsEvenAndPeriodic) {
  const Basis basis = basis_of(9, 6);
  const Coefficients inside = basis_values({0, 520, 0}, kDomain, basis);
  EXPECT_LT((basis_values({-60, 480, 0}, kDomain, basis) - inside).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((basis_values({400, 660, 0}, kDomain, basis) - inside).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(BasisDeathTest, StopsACallerThatIsNowhere) {
  EXPECT_DEATH(BasisAt({std::nan(""), 510, 0}, kDomain, basis_of(2, 2)), "broken precondition");
}

}  // namespace
}  // namespace ergocast
