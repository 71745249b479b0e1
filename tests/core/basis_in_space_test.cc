// SPDX-License-Identifier: BSD-3-Clause
// The basis on a box: values against the cosines, the field against differences of the values, the
// weights against means over the box; and a plane is the box with one mode along z, bit for bit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/noise.h"
#include "core/basis/basis.h"

namespace ergocast {
namespace {

using std::numbers::pi;

const Box kBox{{-30, 500, 12}, {200, 70, 40}};
const Box kFlat{{-30, 500, 0}, {200, 70, 0}};

Basis basis_of(int modes_x, int modes_y, int modes_z) {
  return {.modes_x = modes_x, .modes_y = modes_y, .modes_z = modes_z};
}

/// Sizes with and without a rest where modes are added up several at a time.
std::vector<Basis> some_bases() {
  return {basis_of(4, 4, 2), basis_of(5, 3, 4), basis_of(1, 1, 6), basis_of(9, 7, 3),
          basis_of(8, 1, 5)};
}

Coefficients uneven_weights(const Basis& basis) {
  Coefficients weights(basis.mode_count());
  for (int k = 0; k < weights.size(); ++k) weights[k] = std::sin(1.0 + 3.7 * k + 0.13 * k * k);
  return weights;
}

Eigen::Vector3d point(std::uint64_t i, const Box& domain = kBox) {
  return uniform_in(domain, 8, Purpose::kStart, 0, i);
}

/// Calls each(l, m, n, k) in the order of the basis.
template <class Each>
void for_modes(const Basis& basis, const Each& each) {
  for (int l = 0; l < basis.modes_z; ++l) {
    for (int m = 0; m < basis.modes_x; ++m) {
      for (int n = 0; n < basis.modes_y; ++n) {
        each(l, m, n, (l * basis.modes_x + m) * basis.modes_y + n);
      }
    }
  }
}

double cosine(int mode, double x, double length) { return std::cos(mode * pi * x / length); }

/// Σ a f by its definition.
double sum_at(const Eigen::Vector3d& x_m, const Basis& basis, const Coefficients& a) {
  const Eigen::Vector3d x = x_m - kBox.origin_m;
  double sum = 0;
  for_modes(basis, [&](int l, int m, int n, int k) {
    sum += a[k] * cosine(l, x.z(), 40) * cosine(m, x.x(), 200) * cosine(n, x.y(), 70);
  });
  return sum;
}

TEST(BasisInSpace, ValuesAreProductsOfThreeCosinesInTheOrderOfTheWire) {
  for (const Basis& basis : some_bases()) {
    for (std::uint64_t i = 0; i < 20; ++i) {
      const Coefficients values = basis_values(point(i), kBox, basis);
      ASSERT_EQ(values.size(), basis.mode_count());
      for_modes(basis, [&](int l, int m, int n, int k) {
        const Eigen::Vector3d x = point(i) - kBox.origin_m;
        EXPECT_NEAR(values[k], cosine(l, x.z(), 40) * cosine(m, x.x(), 200) * cosine(n, x.y(), 70),
                    1e-13);
      });
    }
  }
}

TEST(BasisInSpace, SumsAndSamplesAreTheValuesTimesTheStep) {
  const Basis basis = basis_of(5, 3, 4);
  const BasisAt at(point(1), kBox, basis);
  Coefficients sums = uneven_weights(basis), set = sums;
  const Coefficients before = sums, values = basis_values(point(1), kBox, basis);
  accumulate_basis(at, basis, 0.25, sums.data());
  set_basis(at, basis, 0.25, set.data());
  EXPECT_LT((sums - before - 0.25 * values).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(set, 0.25 * values) << "a power of two";
}

/// f at points h apart gives slopes to h² and rounding over h; 1e-8 is far from both.
TEST(BasisInSpace, FieldIsTheSlopeAndTheBendOfTheWeightedSum) {
  for (const Basis& basis : some_bases()) {
    const Coefficients a = uneven_weights(basis);
    for (std::uint64_t i = 0; i < 10; ++i) {
      const Eigen::Vector3d x_m = point(i);
      const BasisAt at(x_m, kBox, basis);
      const FieldAt field = weighted_field(at, basis, kBox, a.data());
      EXPECT_EQ(field.gradient, weighted_gradient(at, basis, a.data())) << "bit for bit";
      EXPECT_EQ(field.hessian, field.hessian.transpose());
      for (int axis = 0; axis < 3; ++axis) {
        const double h = 1e-3;
        const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
        // A difference of the fourth order: the error is h⁴/30 of the fifth derivative.
        const double slope =
            (8 * (sum_at(x_m + step, basis, a) - sum_at(x_m - step, basis, a)) -
             (sum_at(x_m + 2 * step, basis, a) - sum_at(x_m - 2 * step, basis, a))) /
            (12 * h);
        EXPECT_NEAR(field.gradient[axis], slope, 1e-8) << i << " axis " << axis;
        const auto gradient = [&](const Eigen::Vector3d& place_m) {
          return weighted_gradient(BasisAt(place_m, kBox, basis), basis, a.data());
        };
        const Eigen::Vector3d bend = (8 * (gradient(x_m + step) - gradient(x_m - step)) -
                                      (gradient(x_m + 2 * step) - gradient(x_m - 2 * step))) /
                                     (12 * h);
        EXPECT_LT((field.hessian.col(axis) - bend).norm(), 1e-8) << i << " axis " << axis;
      }
    }
  }
}

/// The mean of f(x) over the midpoints of a grid, which is exact for products of two of the modes.
template <class Function>
auto mean_over_box(const Function& f) {
  constexpr int kPoints = 12;
  auto sum = f(kBox.origin_m);
  sum *= 0;
  for (int i = 0; i < kPoints * kPoints * kPoints; ++i) {
    const Eigen::Vector3d share(i % kPoints + 0.5, i / kPoints % kPoints + 0.5,
                                i / kPoints / kPoints + 0.5);
    sum += f(kBox.origin_m + share.cwiseProduct(kBox.size_m) / kPoints);
  }
  return decltype(sum)(sum / (kPoints * kPoints * kPoints));
}

TEST(BasisInSpace, ModesAreOrthogonalAndTheirNormsAreThoseOfTheWeights) {
  const Basis basis = basis_of(4, 3, 5);
  Basis normalized = basis;
  normalized.normalized = true;
  const Coefficients squared_norms =
      sobolev_weights(basis, kBox).cwiseQuotient(sobolev_weights(normalized, kBox));
  const Eigen::MatrixXd products =
      mean_over_box([&](const Eigen::Vector3d& x_m) -> Eigen::MatrixXd {
        const Coefficients f = basis_values(x_m, kBox, basis);
        return f * f.transpose();
      });
  const Eigen::MatrixXd expected = (squared_norms / kBox.content()).asDiagonal();
  EXPECT_LT((products - expected).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(BasisInSpace, WeightsFollowAllThreeWaveNumbers) {
  const Basis basis = basis_of(3, 4, 5);
  const Coefficients weights = sobolev_weights(basis, kBox);
  for_modes(basis, [&](int l, int m, int n, int k) {
    EXPECT_DOUBLE_EQ(weights[k], std::pow(1.0 + l * l + m * m + n * n, -1.5));
  });
}

TEST(BasisInSpace, EnergiesGiveTheMeanSquareOfTheGradientByParseval) {
  const Basis basis = basis_of(4, 5, 3);
  const Coefficients a = uneven_weights(basis);
  const double mean = mean_over_box([&](const Eigen::Vector3d& x_m) {
    return weighted_gradient(BasisAt(x_m, kBox, basis), basis, a.data()).squaredNorm();
  });
  EXPECT_NEAR(mean / a.cwiseAbs2().dot(gradient_energies(basis, kBox)), 1, 1e-12);
}

// ---- a plane is a box with one mode along z ----

/// The two-dimensional sums, in the order in which they have always been added up.
struct InThePlane {
  PlaneCoefficients sums;
  Eigen::Vector2d gradient{0, 0};
  double xx = 0, xy = 0, yy = 0;

  InThePlane(const Eigen::Vector3d& x_m, const Basis& basis, const PlaneCoefficients& a,
             double dt_s)
      : sums(a) {
    const BasisAt at(x_m, kFlat, basis);
    const Eigen::Vector2d wave = pi * kFlat.size_m.head<2>().cwiseInverse();
    for (int n = 0; n < basis.modes_y; ++n) {
      double over_cos = 0, over_slope = 0, over_bend = 0;
      for (int m = 0; m < basis.modes_x; ++m) {
        sums(m, n) += at.cos_x[m] * dt_s * at.cos_y[n];
        over_cos += at.cos_x[m] * a(m, n);
        over_slope += at.slope_x[m] * a(m, n);
        over_bend += -(wave.x() * wave.x()) * m * m * at.cos_x[m] * a(m, n);
      }
      gradient.x() += over_slope * at.cos_y[n];
      gradient.y() += over_cos * at.slope_y[n];
      xx += over_bend * at.cos_y[n];
      xy += over_slope * at.slope_y[n];
      yy -= over_cos * (wave.y() * wave.y() * n * n * at.cos_y[n]);
    }
  }
};

TEST(BasisInAPlane, HasTheBitsOfTheTwoDimensionalSums) {
  for (const int modes_x : {1, 2, 7, 16}) {
    for (const int modes_y : {1, 5, 16, 20}) {
      const Basis basis = basis_of(modes_x, modes_y, 1);
      const Coefficients a = uneven_weights(basis);
      for (std::uint64_t i = 0; i < 50; ++i) {
        const Eigen::Vector3d x_m = point(i, kFlat);
        const InThePlane expected(x_m, basis, in_plane(a, basis), 0.1);
        const BasisAt at(x_m, kFlat, basis);
        Coefficients sums = a;
        accumulate_basis(at, basis, 0.1, sums.data());
        ASSERT_EQ(sums, in_basis_order(expected.sums));
        const FieldAt field = weighted_field(at, basis, kFlat, a.data());
        ASSERT_EQ(field.gradient, on_ground(expected.gradient));
        ASSERT_EQ(weighted_gradient(at, basis, a.data()), field.gradient);
        Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
        hessian.topLeftCorner<2, 2>() << expected.xx, expected.xy, expected.xy, expected.yy;
        ASSERT_EQ(field.hessian, hessian);
      }
    }
  }
}

TEST(BasisInAPlane, IsThatOfABoxWithOneModeAlongZBitForBit) {
  const Basis basis = basis_of(9, 6, 1);
  const Coefficients a = uneven_weights(basis);
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Eigen::Vector3d x_m = point(i);
    const Eigen::Vector3d below_m(x_m.x(), x_m.y(), 0);
    EXPECT_EQ(basis_values(x_m, kBox, basis), basis_values(below_m, kFlat, basis));
    const FieldAt high = weighted_field(BasisAt(x_m, kBox, basis), basis, kBox, a.data());
    const FieldAt flat = weighted_field(BasisAt(below_m, kFlat, basis), basis, kFlat, a.data());
    EXPECT_EQ(high.gradient, flat.gradient);
    EXPECT_EQ(high.hessian, flat.hessian);
  }
  EXPECT_EQ(sobolev_weights(basis, kBox), sobolev_weights(basis, kFlat));
  EXPECT_EQ(gradient_energies(basis, kBox), gradient_energies(basis, kFlat));
}

TEST(BasisInAPlaneDeathTest, HasNoSecondModeAlongZ) {
  EXPECT_DEATH(BasisAt({0, 510, 0}, kFlat, basis_of(2, 2, 2)), "broken precondition");
}

}  // namespace
}  // namespace ergocast
