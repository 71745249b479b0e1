// SPDX-License-Identifier: BSD-3-Clause
// μ_k, (3), against integrals by other methods: Romberg's rule in extended precision for Gaussians
// that are products, the characteristic function for those well inside, another Gauss rule for the
// rest.
#include "target/target.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/target/plane_target.h"

namespace ergocast {
namespace {

const Rectangle kDomain{{-300, 50}, {2000, 1200}};

Basis basis_of(int modes_x, int modes_y) {
  Basis basis;
  basis.modes_x = modes_x;
  basis.modes_y = modes_y;
  return basis;
}

Gaussian bell(double weight, double x_m, double y_m, double deviation_x_m, double deviation_y_m,
              double correlation = 0) {
  const double covariance = correlation * deviation_x_m * deviation_y_m;
  Eigen::Matrix2d covariance_m2;
  covariance_m2 << deviation_x_m * deviation_x_m, covariance, covariance,
      deviation_y_m * deviation_y_m;
  return plane_gaussian(weight, {x_m, y_m}, covariance_m2);
}

// ---- references ----

/// ∫ cos(mode·π(x − low)/length) N(x; mean, deviation²) dx over [low, low + length]: Romberg's
/// rule.
double axis_integral(int mode, double mean, double deviation, double low, double length) {
  const long double a = std::max<long double>(low, mean - 13.0L * deviation);
  const long double b = std::min<long double>(low + length, mean + 13.0L * deviation);
  const auto integrand = [&](long double x) {
    const long double z = (x - mean) / deviation;
    return std::cos(mode * std::numbers::pi_v<long double> * (x - low) / length) *
           std::exp(-z * z / 2) / (deviation * std::sqrt(2 * std::numbers::pi_v<long double>));
  };
  std::vector<long double> row{(b - a) / 2 * (integrand(a) + integrand(b))};
  for (int level = 1; level <= 12; ++level) {
    const int intervals = 1 << level;
    long double sum = 0;
    for (int i = 1; i < intervals; i += 2) sum += integrand(a + (b - a) * i / intervals);
    std::vector<long double> finer{row[0] / 2 + (b - a) / intervals * sum};
    long double factor = 1;
    for (const long double coarser : row) {
      factor *= 4;
      finer.push_back(finer.back() + (finer.back() - coarser) / (factor - 1));
      if (finer.size() > 8) break;
    }
    row = std::move(finer);
  }
  return static_cast<double>(row.back());
}

PlaneCoefficients separable_reference(const TargetDensity& target, const Basis& basis) {
  PlaneCoefficients sum = PlaneCoefficients::Zero(basis.modes_x, basis.modes_y);
  sum(0, 0) = target.uniform_weight;
  for (const Gaussian& g : target.gaussians) {
    Eigen::VectorXd along_x(basis.modes_x), along_y(basis.modes_y);
    for (int m = 0; m < basis.modes_x; ++m) {
      along_x[m] = axis_integral(m, g.mean_m.x(), std::sqrt(g.covariance_m2(0, 0)),
                                 kDomain.origin_m.x(), kDomain.size_m.x());
    }
    for (int n = 0; n < basis.modes_y; ++n) {
      along_y[n] = axis_integral(n, g.mean_m.y(), std::sqrt(g.covariance_m2(1, 1)),
                                 kDomain.origin_m.y(), kDomain.size_m.y());
    }
    sum += g.weight * along_x * along_y.transpose();
  }
  return sum / sum(0, 0);
}

/// For a Gaussian far from the edges: E cos(aX)cos(bY) by the characteristic function.
PlaneCoefficients unbounded_reference(const Gaussian& g, const Basis& basis) {
  PlaneCoefficients mu(basis.modes_x, basis.modes_y);
  const Eigen::Vector2d mean = g.mean_m.head<2>() - kDomain.origin_m;
  for (int m = 0; m < basis.modes_x; ++m) {
    for (int n = 0; n < basis.modes_y; ++n) {
      double sum = 0;
      for (const double sign : {1.0, -1.0}) {
        const Eigen::Vector2d k(m * std::numbers::pi / kDomain.size_m.x(),
                                sign * n * std::numbers::pi / kDomain.size_m.y());
        sum += std::exp(-0.5 * k.dot(g.covariance_m2.topLeftCorner<2, 2>() * k)) *
               std::cos(k.dot(mean)) / 2;
      }
      mu(m, n) = sum;
    }
  }
  return mu;
}

/// Nodes and weights of the five-point Gauss rule on `panels` panels of [low, low + length].
void gauss5(double low, double length, int panels, Eigen::VectorXd& x, Eigen::VectorXd& weight) {
  constexpr double kNode[] = {-0.906179845938664, -0.5384693101056831, 0, 0.5384693101056831,
                              0.906179845938664};
  constexpr double kWeight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                0.4786286704993665, 0.2369268850561891};
  x.resize(5 * panels);
  weight.resize(5 * panels);
  const double half = length / panels / 2;
  for (int i = 0; i < 5 * panels; ++i) {
    x[i] = low + half * (2 * (i / 5) + 1 + kNode[i % 5]);
    weight[i] = half * kWeight[i % 5];
  }
}

/// ∫ f_mn ρ over the domain by brute force over density_unscaled(); not divided by the mass.
PlaneCoefficients brute_force(const TargetDensity& target, const Basis& basis, int panels) {
  Eigen::VectorXd x, y, weight_x, weight_y;
  gauss5(kDomain.origin_m.x(), kDomain.size_m.x(), panels, x, weight_x);
  gauss5(kDomain.origin_m.y(), kDomain.size_m.y(), panels, y, weight_y);
  Eigen::MatrixXd cos_x(basis.modes_x, x.size()), cos_y(basis.modes_y, y.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    for (int m = 0; m < basis.modes_x; ++m) {
      cos_x(m, i) =
          std::cos(m * std::numbers::pi * (x[i] - kDomain.origin_m.x()) / kDomain.size_m.x());
    }
    for (int n = 0; n < basis.modes_y; ++n) {
      cos_y(n, i) =
          std::cos(n * std::numbers::pi * (y[i] - kDomain.origin_m.y()) / kDomain.size_m.y());
    }
  }
  Eigen::MatrixXd mass(x.size(), y.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    for (Eigen::Index j = 0; j < y.size(); ++j) {
      mass(i, j) = weight_x[i] * weight_y[j] * density_unscaled(target, kDomain, {x[i], y[j]});
    }
  }
  return cos_x * mass * cos_y.transpose();
}

double largest_error(const PlaneCoefficients& a, const PlaneCoefficients& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

// ---- products of two bells ----

TEST(TargetCoefficients, OfSeparableBellsAreExact) {
  const Basis basis = basis_of(40, 32);
  const std::vector<TargetDensity> targets = {
      {{bell(1, 700, 650, 100, 100)}, 0},    // in the middle
      {{bell(1, -300, 50, 100, 60)}, 0},     // on a corner
      {{bell(1, 1690, 1240, 150, 300)}, 0},  // cut by two edges
      {{bell(1, 200, 300, 4, 2)}, 0},        // narrower than any wave
      {{bell(1, 0, 0, 5000, 8000)}, 0},      // nearly flat
      {{bell(2, 100, 150, 100, 90), bell(0.5, 1500, 1100, 30, 200)}, 0.7},
  };
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const PlaneIntegrals ours = target_coefficients(targets[i], kDomain, basis);
    const double error = largest_error(ours.values, separable_reference(targets[i], basis));
    EXPECT_LE(error, 1e-12) << "target " << i;
    EXPECT_LE(error, ours.error_bound) << "target " << i;
    EXPECT_LE(ours.error_bound, 1e-11) << "target " << i;
  }
}

TEST(TargetCoefficients, OfATailThatReachesInFromOutsideAreRenormalised) {
  // The mean lies 3 deviations outside; 0.13 % of the mass is inside.
  const TargetDensity tail{{bell(1, -600, 650, 100, 100)}, 0};
  const Basis basis = basis_of(15, 15);
  const PlaneIntegrals ours = target_coefficients(tail, kDomain, basis);
  EXPECT_EQ(ours.values(0, 0), 1);
  const double error = largest_error(ours.values, separable_reference(tail, basis));
  EXPECT_LE(error, 1e-12);
  EXPECT_LE(error, ours.error_bound);
}

TEST(TargetCoefficients, OfAUniformTargetAreZeroButTheFirst) {
  PlaneCoefficients expected = PlaneCoefficients::Zero(6, 7);
  expected(0, 0) = 1;
  EXPECT_EQ(target_coefficients({{}, 0.3}, kDomain, basis_of(6, 7)).values, expected);
}

TEST(TargetCoefficients, OfAMirroredTargetHaveNoOddModes) {
  // A density sampled at cell corners but transformed as cell centres would be off by half a cell.
  const TargetDensity mirrored{{bell(1, 700 - 321, 650, 80, 90), bell(1, 700 + 321, 650, 80, 90)},
                               0};
  const PlaneCoefficients mu = target_coefficients(mirrored, kDomain, basis_of(15, 15)).values;
  for (int m = 0; m < 15; ++m) {
    for (int n = 0; n < 15; ++n) {
      if (m % 2 == 1 || n % 2 == 1) {
        EXPECT_NEAR(mu(m, n), 0, 1e-13) << m << "," << n;
      }
    }
  }
}

TEST(TargetCoefficients, DependOnTheRatiosOfTheWeightsOnly) {
  const auto with_scale = [](double scale) {
    return target_coefficients(
               {{bell(2 * scale, 100, 150, 100, 90), bell(scale, 900, 700, 50, 60)}, 3 * scale},
               kDomain, basis_of(8, 8))
        .values;
  };
  EXPECT_LE(largest_error(with_scale(1), with_scale(1e6)), 1e-14);
  EXPECT_LE(largest_error(with_scale(1), with_scale(1e-6)), 1e-14);
}

TEST(TargetCoefficients, WeighEachBellByItsWeightAndWhatTheDomainLeavesOfIt) {
  // Half of the first bell is inside.
  const Gaussian halved = bell(1, -300, 650, 100, 100), whole = bell(1, 900, 650, 50, 60);
  const Basis basis = basis_of(8, 8);
  const PlaneCoefficients first = target_coefficients({{halved}, 0}, kDomain, basis).values;
  const PlaneCoefficients second = target_coefficients({{whole}, 0}, kDomain, basis).values;
  const PlaneCoefficients both = target_coefficients({{halved, whole}, 0}, kDomain, basis).values;
  // The whole Gaussian loses less than 1e-14 beyond 6 deviations; 650 is 6 of 100 from the edges.
  EXPECT_LE(largest_error(both, (0.5 * first + second) / 1.5), 1e-8);
  EXPECT_GT(largest_error(both, (first + second) / 2), 1e-2);
}

// ---- correlated bells ----

TEST(TargetCoefficients, OfACorrelatedBellAreWithinTheirStatedError) {
  const Basis basis = basis_of(15, 15);
  for (const double correlation : {0.3, -0.6, 0.9, -0.99, 0.999, 0.99999}) {
    const Gaussian g = bell(1, 700, 650, 100, 60, correlation);
    const PlaneIntegrals ours = target_coefficients({{g}, 0}, kDomain, basis);
    const double error = largest_error(ours.values, unbounded_reference(g, basis));
    EXPECT_LE(error, ours.error_bound + 1e-13) << "correlation " << correlation;
    if (std::abs(correlation) < 0.995) {
      EXPECT_LE(ours.error_bound, 1e-11) << "correlation " << correlation;
    }
  }
}

TEST(TargetCoefficients, AHopelesslyNarrowRidgeStatesThatItIsNotExact) {
  // Its width is 1e-5 of its length: no rule on these panels can resolve it, and the stated error
  // shows that.
  const Gaussian ridge = bell(1, 700, 650, 100, 60, 1 - 5e-11);
  EXPECT_GT(target_coefficients({{ridge}, 0}, kDomain, basis_of(15, 15)).error_bound, 1e-3);
}

TEST(TargetCoefficients, OfACorrelatedBellCutByTheEdgesAgreeWithBruteForce) {
  const Basis basis = basis_of(10, 12);
  const TargetDensity target{
      {bell(1, -250, 100, 200, 150, 0.7), bell(0.5, 1600, 900, 120, 260, -0.8)}, 0.25};
  const PlaneIntegrals ours = target_coefficients(target, kDomain, basis);
  const PlaneCoefficients brute = brute_force(target, basis, 160);
  // Panels of a fifth of the narrowest width: the five-point rule is exact to rounding there.
  EXPECT_LE(largest_error(ours.values, brute / brute(0, 0)), ours.error_bound + 1e-13);
  EXPECT_LE(ours.error_bound, 1e-11);
}

TEST(TargetCoefficients, OfASlightlyCorrelatedBellAreThoseOfTheSeparableOne) {
  const Basis basis = basis_of(15, 15);
  const auto with = [&](double correlation) {
    return target_coefficients({{bell(1, 900, 300, 100, 60, correlation)}, 0}, kDomain, basis)
        .values;
  };
  // ∂μ/∂(covariance) is at most the product of the highest wave numbers.
  const double slope = 14 * std::numbers::pi / 2000 * 14 * std::numbers::pi / 1200 * 100 * 60;
  EXPECT_LE(largest_error(with(1e-12), with(0)), 1e-12 * slope + 4e-12);
}

// ---- mass and density ----

TEST(MassInside, IsTheShareThatTheEdgesLeave) {
  EXPECT_NEAR(mass_inside({{bell(1, 700, 650, 50, 50)}, 0}, kDomain), 1, 1e-13);
  EXPECT_NEAR(mass_inside({{bell(1, -300, 50, 50, 50)}, 0}, kDomain), 0.25, 1e-13);
  EXPECT_NEAR(mass_inside({{bell(4, -300, 50, 50, 50)}, 2}, kDomain), 3, 1e-12);
  EXPECT_EQ(mass_inside({{bell(1, -5000, 650, 50, 50)}, 0}, kDomain), 0);
  const double cut = 0.5 * std::erfc(-100 / (std::sqrt(2.0) * 80));  // the mean is 100 m inside
  EXPECT_NEAR(mass_inside({{bell(1, -200, 650, 80, 50)}, 0}, kDomain), cut, 1e-13);
}

TEST(Density, IntegratesToTheMassInside) {
  const TargetDensity target{{bell(1, -250, 100, 200, 150, 0.7), bell(0.5, 1600, 900, 120, 260)},
                             0.25};
  EXPECT_NEAR(brute_force(target, basis_of(1, 1), 100)(0, 0), mass_inside(target, kDomain), 1e-12);
}

TEST(Density, IsTheMixture) {
  const TargetDensity target{{bell(2, 100, 200, 30, 40)}, 0.6};
  const double peak = 2 / (2 * std::numbers::pi * 30 * 40), floor = 0.6 / (2000 * 1200);
  EXPECT_DOUBLE_EQ(density_unscaled(target, kDomain, {100, 200}), peak + floor);
  EXPECT_DOUBLE_EQ(density_unscaled(target, kDomain, {130, 200}), peak * std::exp(-0.5) + floor);
  EXPECT_DOUBLE_EQ(density_unscaled(target, kDomain, {100, 280}), peak * std::exp(-2) + floor);
  EXPECT_DOUBLE_EQ(density_unscaled(target, kDomain, {1600, 1200}), floor);
}

TEST(TargetDeathTest, StopsACallerWhoseTargetIsNotInTheDomain) {
  EXPECT_DEATH(target_coefficients({{bell(1, -5000, 650, 50, 50)}, 0}, kDomain, basis_of(2, 2)),
               "broken precondition");
}

}  // namespace
}  // namespace ergocast
