// SPDX-License-Identifier: BSD-3-Clause
// Limits that are exceeded no more often than stated: tested with a visible error.
#include "studies/theorems/confidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/noise.h"

namespace ergocast::studies {
namespace {

constexpr double kError = 0.05;
constexpr std::uint32_t kTrials = 400;
constexpr std::size_t kCount = 200;
/// 5 % of 400, and four standard deviations of it.
constexpr int kMost = 20 + 18;

double uniform(std::uint32_t trial, std::size_t i) {
  return uniform_pair(1, Purpose::kFault, trial, i).x();
}

TEST(Confidence, DistributionsAreNearerThanTheDistance) {
  int farther = 0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    std::vector<double> draws;
    for (std::size_t i = 0; i < kCount; ++i) draws.push_back(uniform(trial, i));
    std::sort(draws.begin(), draws.end());
    double distance = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      distance = std::max({distance, std::abs(draws[i] - static_cast<double>(i) / kCount),
                           std::abs(draws[i] - static_cast<double>(i + 1) / kCount)});
    }
    if (distance > dkw_distance(kCount, kError)) ++farther;
  }
  EXPECT_LE(farther, kMost);
  EXPECT_GT(farther, 0) << "the distance is far too large";
}

TEST(Confidence, AllSuccessesAreThatUnlikelyUnderTheLeastProbability) {
  EXPECT_NEAR(std::pow(least_probability(kCount, kError), kCount), kError, 1e-12);
}

TEST(Confidence, MeansStayUnderTheirUpperLimit) {
  int above = 0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    std::vector<double> draws;
    for (std::size_t i = 0; i < kCount; ++i) draws.push_back(uniform(trial, i));
    const double upper = upper_mean(draws, 1, kError);
    if (upper < 0.5) ++above;
    EXPECT_LT(upper, 0.75);
  }
  EXPECT_LE(above, kMost);
}

TEST(Confidence, ShiftedSquaresStayWithinTheirLimits) {
  constexpr double kShift = 3;  // of each of the normal numbers, squared
  const Limits limits = chi_square_limits(2 * kCount, 2 * kCount * kShift, kError);
  int outside = 0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    double sum = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      sum += (normal_pair(1, Purpose::kFault, trial, i).array() + std::sqrt(kShift)).square().sum();
    }
    if (sum < limits.low || sum > limits.high) ++outside;
  }
  EXPECT_LE(outside, 2 * kMost);
  EXPECT_GT(limits.low, 0.8 * 2 * kCount * (1 + kShift));
  EXPECT_LT(limits.high, 1.2 * 2 * kCount * (1 + kShift));
}

}  // namespace
}  // namespace ergocast::studies
