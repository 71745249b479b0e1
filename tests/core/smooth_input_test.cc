// SPDX-License-Identifier: BSD-3-Clause
// The smooth input (8) by itself: its formula, its limit, and gradients that vanish.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/uneven_mission.h"

namespace ergocast {
namespace {

TEST(SmoothInput, IsEquation8) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Eigen::Vector3d b = on_ground(normal_pair(1, Purpose::kStart, 0, i) * 1e-4);
    const double epsilon = 1e-4 * uniform_pair(1, Purpose::kStart, 1, i).x();
    const Eigen::Vector3d expected = -12 * b / std::sqrt(b.squaredNorm() + epsilon * epsilon);
    // Fewer than ten roundings on either side, of numbers of at most 12.
    EXPECT_LE((smooth_input(b, epsilon, 12) - expected).norm(), 20 * 12 * kRounding);
  }
}

TEST(SmoothInput, WithoutEpsilonIsTheClassicalLaw) {
  EXPECT_EQ(smooth_input({3e-5, 0, 0}, 0, 12), Eigen::Vector3d(-12, 0, 0));
  EXPECT_EQ(smooth_input({0, -1e-9, 0}, 0, 12), Eigen::Vector3d(0, 12, 0));
  const Eigen::Vector3d u = smooth_input({3, -4, 0}, 0, 10);
  EXPECT_DOUBLE_EQ(u.x(), -6);
  EXPECT_DOUBLE_EQ(u.y(), 8);
}

TEST(SmoothInput, OfNoGradientIsNoInputAndNeverNan) {
  for (const double epsilon : {0.0, kTiniest, 1e-300, 1e-3}) {
    for (const Eigen::Vector3d& b : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-0.0, 0.0, 0)}) {
      EXPECT_EQ(smooth_input(b, epsilon, 12), Eigen::Vector3d(0, 0, 0)) << epsilon;
    }
  }
}

TEST(SmoothInput, OfNextToNoGradientIsADirectionAndNeverInfinite) {
  // An agent 1e-308 m off an edge has a gradient like that.
  for (const double tiny : {1e-150, 1e-300, 1e-307, 1e-310, 1e-320, kTiniest}) {
    EXPECT_EQ(smooth_input({tiny, 0, 0}, 0, 12), Eigen::Vector3d(-12, 0, 0)) << tiny;
    EXPECT_EQ(smooth_input({0, -tiny, 0}, 0, 12), Eigen::Vector3d(0, 12, 0)) << tiny;
    EXPECT_LE(smooth_input({tiny, tiny, 0}, 1e-3, 12).norm(), 12 * 2 * tiny / 1e-3) << tiny;
  }
}

TEST(SmoothInput, NeverExceedsItsLimit) {
  for (std::uint64_t i = 0; i < 100000; ++i) {
    // Every magnitude from 1e-300 to 1e+300, and ε as well.
    const Eigen::Vector2d u = uniform_pair(2, Purpose::kStart, 0, i);
    const Eigen::Vector3d b =
        on_ground(normal_pair(2, Purpose::kStart, 1, i) * std::pow(10, 600 * u.x() - 300));
    const double epsilon = i % 4 == 0 ? 0 : std::pow(10, 600 * u.y() - 300);
    const Eigen::Vector3d input = smooth_input(b, epsilon, 12);
    ASSERT_TRUE(input.allFinite()) << b.transpose() << ", " << epsilon;
    // A square root and two divisions round.
    ASSERT_LE(input.norm(), 12 * (1 + 8 * kRounding)) << b.transpose() << ", " << epsilon;
  }
}

}  // namespace
}  // namespace ergocast
