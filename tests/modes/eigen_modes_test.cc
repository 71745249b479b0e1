// SPDX-License-Identifier: BSD-3-Clause
// Without walls the modes are the cosines, and with walls they have no slope across them.
#include "modes/eigen_modes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/modes/rooms.h"

namespace ergocast {
namespace {

using std::numbers::pi;

struct Cosine {
  double nu_per_m2;
  int m, n;
};

/// The lowest of them, by ascending eigenvalue.
std::vector<Cosine> cosines(const Box& domain, std::size_t count) {
  std::vector<Cosine> all;
  for (int m = 0; m < 12; ++m) {
    for (int n = 0; n < 12; ++n) {
      all.push_back(
          {std::pow(m * pi / domain.size_m.x(), 2) + std::pow(n * pi / domain.size_m.y(), 2), m,
           n});
    }
  }
  std::ranges::sort(all, {}, &Cosine::nu_per_m2);
  all.resize(count);
  return all;
}

TEST(EigenModes, OfARectangleAreItsCosines) {
  Box domain;
  domain.origin_m = {-300, 70, 0};
  domain.size_m = {2000, 1430, 0};
  const FreeGrid grid = test::grid_of(domain, test::sees_all);
  const auto modes = eigen_modes(grid, 20);
  ASSERT_TRUE(modes);
  const auto expected = cosines(domain, 20);
  for (int k = 1; k < 20; ++k) {
    const auto& [nu_per_m2, m, n] = expected[static_cast<std::size_t>(k)];
    EXPECT_NEAR(modes->eigenvalues_per_m2[k] / nu_per_m2, 1, 0.005) << k;
    for (int cell = 0; cell < grid.cell_count(); cell += 97) {
      const int at = grid.place[static_cast<std::size_t>(cell)];
      const double cosine = std::cos(m * pi * (at / grid.rows + 0.5) / grid.columns) *
                            std::cos(n * pi * (at % grid.rows + 0.5) / grid.rows);
      ASSERT_NEAR(modes->values(cell, k), cosine, 0.01) << k;
    }
  }
}

// Its cells are not square.
TEST(EigenModes, OfANarrowStripAreWavesAlongIt) {
  Box domain;
  domain.size_m = {3000, 20, 0};
  const auto modes = eigen_modes(test::grid_of(domain, test::sees_all), 10);
  ASSERT_TRUE(modes);
  for (int k = 1; k < 10; ++k)
    EXPECT_NEAR(modes->eigenvalues_per_m2[k] / std::pow(k * pi / 3000, 2), 1, 0.001) << k;
}

TEST(EigenModes, AreOrthogonalAndBegunByTheConstant) {
  const FreeGrid grid = test::grid_of(test::square(), test::sees_through_the_door);
  const auto modes = eigen_modes(grid, 60);
  ASSERT_TRUE(modes);
  EXPECT_EQ(modes->eigenvalues_per_m2[0], 0);
  EXPECT_TRUE((modes->values.col(0).array() == 1).all());
  EXPECT_DOUBLE_EQ(modes->values.cwiseAbs().maxCoeff(), 1);
  Eigen::MatrixXd products = modes->values.transpose() * modes->values / grid.cell_count();
  products.diagonal().setZero();
  EXPECT_LT(products.cwiseAbs().maxCoeff(), 1e-8);
  for (int k = 1; k < 60; ++k)
    EXPECT_GE(modes->eigenvalues_per_m2[k], modes->eigenvalues_per_m2[k - 1]);
}

// The lowest mode distinguishes the two rooms, and is almost constant in each.
TEST(EigenModes, DistinguishRoomsFirst) {
  const FreeGrid grid = test::grid_of(test::square(), test::sees_through_the_door);
  const auto modes = eigen_modes(grid, 4);
  ASSERT_TRUE(modes);
  EXPECT_LT(modes->eigenvalues_per_m2[1], 0.3 * std::pow(pi / test::kSide_m, 2));
  EXPECT_GT(modes->values(0, 1), 0.8);
  EXPECT_LT(modes->values(grid.cell_count() - 1, 1), -0.8);
}

TEST(EigenModes, RepeatBitForBit) {
  const FreeGrid grid = test::grid_of(test::square(), test::sees_all);  // with degenerate pairs
  const auto one = eigen_modes(grid, 30), other = eigen_modes(grid, 30);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->values, other->values);
  EXPECT_EQ(one->eigenvalues_per_m2, other->eigenvalues_per_m2);
}

}  // namespace
}  // namespace ergocast
