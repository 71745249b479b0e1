// SPDX-License-Identifier: BSD-3-Clause
// The basis of a free domain: values, field and weights, compared with cosines where they are
// equal.
#include "core/basis/free_modes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/basis/basis.h"
#include "core/law/look_ahead.h"
#include "tests/modes/rooms.h"

namespace ergocast {
namespace {

Basis free_basis(const ModesTable& table) {
  Basis basis;
  basis.modes_x = table->mode_count;
  basis.free_domain = true;
  basis.table_hash = table->hash;
  basis.table = table;
  return basis;
}

Box oblong() {
  Box domain;
  domain.origin_m = {-300, 70, 0};
  domain.size_m = {2000, 1430, 0};
  return domain;
}

const ModesTable& open_table() {
  static const ModesTable table = test::table_of(test::grid_of(oblong(), test::sees_all), 10);
  return table;
}

const ModesTable& rooms_table() {
  static const ModesTable table = test::two_rooms(60);
  return table;
}

TEST(FreeModes, InterpolateBetweenFourCells) {
  const FreeModes& modes = *open_table();
  const Basis basis = free_basis(open_table());
  // Some way to the right of a middle, and up.
  const int cell = modes.rows * 20 + 30;
  const Eigen::Vector2d x_m =
      modes.center_m(cell) + modes.cell_m().cwiseProduct(Eigen::Vector2d(0.25, 0.4));
  const Coefficients f = basis_values({x_m.x(), x_m.y(), 0}, oblong(), basis);
  for (int k = 0; k < modes.mode_count; ++k) {
    const auto value = [&](int number) { return static_cast<double>(modes.values_of(number)[k]); };
    const double low = 0.75 * value(cell) + 0.25 * value(cell + modes.rows);
    const double high = 0.75 * value(cell + 1) + 0.25 * value(cell + 1 + modes.rows);
    EXPECT_NEAR(f[k], 0.6 * low + 0.4 * high, 1e-12) << k;
  }
}

TEST(FreeModes, AreCosinesWhereNothingStands) {
  const Basis basis = free_basis(open_table());
  const Eigen::Vector3d x_m(411, 893, 0);
  const Coefficients f = basis_values(x_m, oblong(), basis);
  const double x = std::numbers::pi * (411 + 300) / 2000, y = std::numbers::pi * (893 - 70) / 1430;
  EXPECT_NEAR(f[1], std::cos(x), 0.002);
  EXPECT_NEAR(f[2], std::cos(y), 0.002);
  EXPECT_NEAR(f[3], std::cos(x) * std::cos(y), 0.002);
}

TEST(FreeModes, NeverExceedOneNorAreNotANumberAnywhere) {
  const Basis basis = free_basis(rooms_table());
  for (double x = -500; x < 2600; x += 37) {
    for (double y = -500; y < 2600; y += 41) {
      const Coefficients f = basis_values({x, y, 0}, test::square(), basis);
      ASSERT_LE(f.cwiseAbs().maxCoeff(), 1 + 1e-12);
      ASSERT_NEAR(f[0], 1, 1e-12);
    }
  }
}

// The lowest mode of two rooms changes its sign across the wall.
TEST(FreeModes, JumpAtAWallAndNotAtADoor) {
  const Basis basis = free_basis(rooms_table());
  const auto lowest = [&](double x, double y) {
    return basis_values({x, y, 0}, test::square(), basis)[1];
  };
  EXPECT_GT(lowest(test::kWall_m - 7, 300), 0.5);
  EXPECT_LT(lowest(test::kWall_m + 7, 300), -0.5);
  double before = lowest(900, 1000);
  for (double x = 900; x < 1100; x += 2) {
    EXPECT_NEAR(lowest(x, 1000), before, 0.03) << x;
    before = lowest(x, 1000);
  }
}

Coefficients uneven_weights(int count) {
  Coefficients weights(count);
  for (int k = 0; k < count; ++k) weights[k] = std::cos(3.0 * k) / (k + 1);
  return weights;
}

TEST(FreeModes, FieldIsTheSlopeAndTheBendOfTheWeightedCosines) {
  const Basis basis = free_basis(open_table());
  const Box domain = oblong();
  Coefficients weights = Coefficients::Zero(10);
  weights[3] = 2;
  const Eigen::Vector3d x_m(411, 893, 0);
  const BasisAt at(x_m, domain, basis);
  const FieldAt field = weighted_field(at, basis, domain, weights.data());
  EXPECT_EQ(field.gradient, weighted_gradient(at, basis, weights.data()));
  Basis cosines;
  cosines.modes_x = cosines.modes_y = 2;
  Coefficients same = Coefficients::Zero(4);
  same[3] = 2;
  const FieldAt exact = weighted_field(BasisAt(x_m, domain, cosines), cosines, domain, same.data());
  EXPECT_LT((field.gradient - exact.gradient).norm(), 0.01 * exact.gradient.norm());
  EXPECT_LT((field.hessian - exact.hessian).norm(), 0.02 * exact.hessian.norm());
}

TEST(FreeModes, FieldIsTheSlopeOfEachMode) {
  const Basis basis = free_basis(open_table());
  const Box domain = oblong();
  for (int k = 1; k < 10; ++k) {
    const Coefficients one = Coefficients::Unit(10, k);
    const auto value = [&](double dx, double dy) {
      return basis_values({411 + dx, 893 + dy, 0}, domain, basis)[k];
    };
    const Eigen::Vector3d slope =
        weighted_gradient(BasisAt({411, 893, 0}, domain, basis), basis, one.data());
    EXPECT_NEAR(slope.x(), (value(30, 0) - value(-30, 0)) / 60, 1e-4) << k;
    EXPECT_NEAR(slope.y(), (value(0, 30) - value(0, -30)) / 60, 1e-4) << k;
    EXPECT_GT(slope.norm(), 5e-4) << k;
  }
}

TEST(FreeModes, FieldHasTheBendThatItsSlopesShow) {
  const Basis basis = free_basis(rooms_table());
  const Box domain = test::square();
  const Coefficients weights = uneven_weights(60);
  const Eigen::Vector3d x_m(640, 1311, 0);
  const auto field = [&](double dx, double dy) {
    const BasisAt at(x_m + Eigen::Vector3d(dx, dy, 0), domain, basis);
    return weighted_field(at, basis, domain, weights.data());
  };
  const Eigen::Matrix3d hessian = field(0, 0).hessian;
  const Eigen::Vector3d along_x = (field(1, 0).gradient - field(-1, 0).gradient) / 2;
  const Eigen::Vector3d along_y = (field(0, 1).gradient - field(0, -1).gradient) / 2;
  EXPECT_LT((along_x - hessian.col(0)).norm(), 1e-9 * (1 + hessian.norm()));
  EXPECT_LT((along_y - hessian.col(1)).norm(), 1e-9 * (1 + hessian.norm()));
}

TEST(FreeModes, FieldHasNoSlopeAcrossWallsAndSides) {
  const Basis basis = free_basis(rooms_table());
  const Box domain = test::square();
  const Coefficients weights = uneven_weights(60);
  const auto slope = [&](double x, double y) {
    return weighted_gradient(BasisAt({x, y, 0}, domain, basis), basis, weights.data());
  };
  const double usual = slope(500, 700).norm();
  EXPECT_NEAR(slope(0, 700).x(), 0, 1e-12 * usual);
  EXPECT_NEAR(slope(500, 2000).y(), 0, 1e-12 * usual);
  // The field has its wall at the cells' nearest side.
  EXPECT_NEAR(slope(1000 - 1e-9, 300).x(), 0, 1e-9 * usual);
  EXPECT_NEAR(slope(1003, 300).x(), 0, 1e-12 * usual) << "beyond it, and still before the wall";
  EXPECT_GT(std::abs(slope(1000, 1000).x()), 1e-3 * usual) << "in the door";
}

// f_k = e_k · max |f_k| has the mean square ¼, and weights compensate for it.
TEST(FreeModes, WeightsAreThoseOfTheUnscaledModes) {
  const FreeModes& modes = *rooms_table();
  const Eigen::VectorXd weights = free_weights(modes, true, 1.5, false);
  EXPECT_EQ(weights[0], 1);
  for (int k = 1; k < modes.mode_count; ++k) {
    double mean_square = 0;
    for (int cell = 0; cell < modes.cell_count; ++cell)
      mean_square += std::pow(static_cast<double>(modes.values_of(cell)[k]), 2) / modes.cell_count;
    const double squared = modes.eigenvalues_per_m2[static_cast<std::size_t>(k)] *
                           std::pow(test::kSide_m / std::numbers::pi, 2);
    const double lambda = std::pow(1 + squared, -1.5);
    EXPECT_NEAR(weights[k] / (lambda * 0.25 / mean_square), 1, 1e-9) << k;
    EXPECT_NEAR(free_weights(modes, false, 2, false)[k],
                std::pow(1 + std::sqrt(squared), -2) * 0.25 / mean_square, 1e-9);
    EXPECT_NEAR(free_weights(modes, true, 1.5, true)[k] / weights[k] * 0.25 * modes.free_area_m2(),
                1, 1e-9);
  }
}

// Modes along one axis have the mean square ½ as cosines and ¼ here; all others ¼.
TEST(FreeModes, WeighAnOpenSquareAsCosinesDo) {
  const ModesTable table = test::table_of(test::grid_of(test::square(), test::sees_all), 5);
  const Eigen::VectorXd weights = free_weights(*table, true, 1.5, false);
  EXPECT_NEAR(weights[3], std::pow(3, -1.5), 0.01) << "of cos cos";
}

TEST(FreeModes, EnergiesAreThoseOfTheField) {
  const FreeModes& modes = *rooms_table();
  const Basis basis = free_basis(rooms_table());
  const Coefficients weights = uneven_weights(60).head(12).eval();
  Coefficients all = Coefficients::Zero(60);
  all.head(12) = weights;
  double mean = 0;
  for (int cell = 0; cell < modes.cell_count; ++cell) {
    const Eigen::Vector2d x_m = modes.center_m(cell);
    const BasisAt at({x_m.x(), x_m.y(), 0}, test::square(), basis);
    mean += weighted_gradient(at, basis, all.data()).squaredNorm() / modes.cell_count;
  }
  const double parseval =
      (all.array().square() * gradient_energies(basis, test::square()).array()).sum();
  EXPECT_NEAR(mean / parseval, 1, 0.05);
}

TEST(FreeModes, SpreadIsThatOfTheMass) {
  const FreeModes& modes = *rooms_table();
  const Basis basis = free_basis(rooms_table());
  // A round mass in the left room.
  Coefficients target = Coefficients::Zero(60);
  double mass = 0;
  for (int cell = 0; cell < modes.cell_count; ++cell) {
    const Eigen::Vector2d away = (modes.center_m(cell) - Eigen::Vector2d(500, 1200)) / 150;
    const double density = std::exp(-away.squaredNorm() / 2);
    mass += density;
    for (int k = 0; k < 60; ++k)
      target[k] += density * static_cast<double>(modes.values_of(cell)[k]);
  }
  target /= mass;
  EXPECT_NEAR(target_spread_m(target_covariance_m2(target, basis, test::square())),
              150 * std::sqrt(2), 15);
  EXPECT_NEAR(
      target_spread_m(target_covariance_m2(Coefficients::Unit(60, 0), basis, test::square())),
      test::kSide_m / std::sqrt(6), 5);
}

}  // namespace
}  // namespace ergocast
