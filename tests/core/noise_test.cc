// SPDX-License-Identifier: BSD-3-Clause
// Noise as a function: the generator against its published vectors, its numbers against the moments
// and the distribution of a standard normal.
//
// The seeds are fixed, so a bound of z standard errors does not make a test fail at times. It shows
// how unlikely such numbers are if the claim is true: z = 5 is one in 1.7 million, two-sided.
#include "core/base/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ergocast {
namespace {

constexpr int kDraws = 100000;
constexpr double kErrors = 5;

std::vector<Eigen::Vector2d> normal_draws(std::uint64_t seed, std::uint32_t who) {
  std::vector<Eigen::Vector2d> draws;
  for (int i = 0; i < kDraws; ++i) {
    draws.push_back(normal_pair(seed, Purpose::kPerturbation, who, static_cast<std::uint64_t>(i)));
  }
  return draws;
}

RandomBits words_of(std::uint64_t step, std::uint32_t who, std::uint32_t purpose,
                    std::uint64_t seed) {
  return random_words(seed, static_cast<Purpose>(purpose), who, step);
}

TEST(Noise, RepeatsThePublishedVectorsOfPhilox) {
  // philox4x32-10 of the Random123 distribution: counter words (step low, step high, agent,
  // purpose).
  RandomBits words = words_of(0, 0, 0, 0);
  EXPECT_EQ(words.first, 0x6627e8d5e169c58du);
  EXPECT_EQ(words.second, 0xbc57ac4c9b00dbd8u);
  words = words_of(~0ull, ~0u, ~0u, ~0ull);
  EXPECT_EQ(words.first, 0x408f276d41c83b0eu);
  EXPECT_EQ(words.second, 0xa20bc7c66d5451fdu);
  words = words_of(0x85a308d3243f6a88, 0x13198a2e, 0x03707344, 0x299f31d0a4093822);
  EXPECT_EQ(words.first, 0xd16cfe0994fdccebu);
  EXPECT_EQ(words.second, 0x5001e42024126ea1u);
}

TEST(Noise, IsAFunctionOfItsArgumentsAndOfEachOfThem) {
  const auto value = normal_pair(1, Purpose::kPerturbation, 2, 3);
  EXPECT_EQ(value, normal_pair(1, Purpose::kPerturbation, 2, 3));
  EXPECT_NE(value, normal_pair(9, Purpose::kPerturbation, 2, 3));
  EXPECT_NE(value, normal_pair(1, Purpose::kDisturbance, 2, 3));
  EXPECT_NE(value, normal_pair(1, Purpose::kPerturbation, 9, 3));
  EXPECT_NE(value, normal_pair(1, Purpose::kPerturbation, 2, 9));
  EXPECT_NE(value, normal_pair(1ull << 32, Purpose::kPerturbation, 2, 3)) << "all bits of the seed";
  EXPECT_NE(value, normal_pair(1, Purpose::kPerturbation, 2, 3 + (1ull << 32)))
      << "and of the step";
}

TEST(Noise, UniformNumbersStayInsideTheOpenInterval) {
  double low = 1, high = 0, sum = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const Eigen::Vector2d u = uniform_pair(3, Purpose::kStart, 0, i);
    low = std::min({low, u.x(), u.y()});
    high = std::max({high, u.x(), u.y()});
    sum += u.x() + u.y();
  }
  EXPECT_GT(low, 0);
  EXPECT_LT(high, 1);
  // The standard error of a mean of 2e5 uniform numbers.
  EXPECT_NEAR(sum / (2 * kDraws), 0.5, kErrors * std::sqrt(1.0 / 12 / (2 * kDraws)));
}

TEST(Noise, HasTheMomentsOfTwoIndependentStandardNormals) {
  Eigen::Vector2d mean{0, 0};
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  Eigen::Vector2d third{0, 0}, fourth{0, 0};
  for (const Eigen::Vector2d& xi : normal_draws(42, 0)) {
    mean += xi / kDraws;
    second += xi * xi.transpose() / kDraws;
    third += xi.array().cube().matrix() / kDraws;
    fourth += xi.array().pow(4).matrix() / kDraws;
  }
  // Variances of ξ, ξ², ξ₁ξ₂, ξ³, ξ⁴ of a standard normal: 1, 2, 1, 15, 96.
  const double error = kErrors / std::sqrt(static_cast<double>(kDraws));
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(mean[axis], 0, error);
    EXPECT_NEAR(second(axis, axis), 1, error * std::sqrt(2.0));
    EXPECT_NEAR(third[axis], 0, error * std::sqrt(15.0));
    EXPECT_NEAR(fourth[axis], 3, error * std::sqrt(96.0));
  }
  EXPECT_NEAR(second(0, 1), 0, error);
}

TEST(Noise, FollowsTheNormalDistribution) {
  std::vector<double> values;
  for (const Eigen::Vector2d& xi : normal_draws(7, 3)) {
    values.insert(values.end(), {xi.x(), xi.y()});
  }
  std::sort(values.begin(), values.end());
  double distance = 0;
  const auto count = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = 0.5 * std::erfc(-values[i] / std::sqrt(2.0));
    distance = std::max({distance, std::abs(static_cast<double>(i) / count - expected),
                         std::abs(static_cast<double>(i + 1) / count - expected)});
  }
  // Kolmogorov: P(√n D > z) ≈ 2 exp(−2z²), 6e-7 at z = 2.74.
  EXPECT_LT(distance * std::sqrt(count), 2.74);
}

TEST(Noise, IsUncorrelatedBetweenStepsAgentsSeedsAndPurposes) {
  const auto own = normal_draws(42, 0), teammate = normal_draws(42, 1), other = normal_draws(43, 0);
  double steps = 0, agents = 0, seeds = 0, purposes = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto at = static_cast<std::size_t>(i);
    steps += own[at].x() * own[(at + 1) % own.size()].x() / kDraws;
    agents += own[at].x() * teammate[at].x() / kDraws;
    seeds += own[at].x() * other[at].x() / kDraws;
    purposes += own[at].x() * normal_pair(42, Purpose::kDisturbance, 0, at).x() / kDraws;
  }
  // The product of two independent standard normals has variance 1.
  const double error = kErrors / std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(steps, 0, error);
  EXPECT_NEAR(agents, 0, error);
  EXPECT_NEAR(seeds, 0, error);
  EXPECT_NEAR(purposes, 0, error);
}

const Box kPlane{{-3, 4, 0}, {20, 10, 0}}, kSpace{{-3, 4, 50}, {20, 10, 8}};

TEST(Noise, OfAPlaneIsThePairAndNothingAlongZ) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Eigen::Vector2d pair = normal_pair(5, Purpose::kPush, 3, i);
    EXPECT_EQ(normal_in(kPlane, 5, Purpose::kPush, 3, i), on_ground(pair));
    EXPECT_EQ(normal_in(kSpace, 5, Purpose::kPush, 3, i).head<2>(), pair) << "the same in space";
    const Eigen::Vector3d flat = uniform_in(kPlane, 5, Purpose::kStart, 3, i);
    EXPECT_EQ(flat.z(), 0);
    EXPECT_EQ(uniform_in(kSpace, 5, Purpose::kStart, 3, i).head<2>(), flat.head<2>());
    EXPECT_TRUE(kSpace.contains(uniform_in(kSpace, 5, Purpose::kStart, 3, i)));
  }
}

TEST(Noise, AlongZIsAThirdIndependentStandardNormal) {
  Eigen::Vector3d mean(0, 0, 0);
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double uniform = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const Eigen::Vector3d xi = normal_in(kSpace, 42, Purpose::kPerturbation, 0, i);
    mean += xi / kDraws;
    second += xi * xi.transpose() / kDraws;
    uniform += (uniform_in(kSpace, 42, Purpose::kStart, 0, i).z() - 50) / 8 / kDraws;
  }
  const double error = kErrors / std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(mean.z(), 0, error);
  EXPECT_NEAR(second(2, 2), 1, error * std::sqrt(2.0));
  EXPECT_NEAR(second(0, 2), 0, error);
  EXPECT_NEAR(second(1, 2), 0, error);
  EXPECT_NEAR(uniform, 0.5, error / std::sqrt(12.0));
}

}  // namespace
}  // namespace ergocast
