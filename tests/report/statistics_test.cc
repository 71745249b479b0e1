// SPDX-License-Identifier: BSD-3-Clause
// Medians and ratios with their confidence.
#include "report/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/noise.h"

namespace ergocast {
namespace {

/// Numbers whose logarithms are normal about log(center) with deviation `spread`.
std::vector<double> scattered(std::uint32_t stream, std::size_t count, double center,
                              double spread) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(center * std::exp(spread * normal_pair(7, Purpose::kFault, stream, i).x()));
  }
  return values;
}

TEST(RatioOf, EqualPairsIsOneWithoutDoubt) {
  const std::vector<double> values = scattered(1, 50, 2, 0.5);
  const Estimate ratio = ratio_of(values, values);
  EXPECT_EQ(ratio.value, 1);
  EXPECT_EQ(ratio.low, 1);
  EXPECT_EQ(ratio.high, 1);
}

TEST(RatioOf, HasTheIntervalOfTheStandardError) {
  constexpr std::size_t kPairs = 2000;
  const Estimate ratio = ratio_of(scattered(1, kPairs, 3, 0.5), scattered(2, kPairs, 2, 0.5));
  const double half = 1.96 * 0.5 * std::sqrt(2.0 / kPairs);
  EXPECT_NEAR(std::log(ratio.value), std::log(1.5), 3 * half);
  EXPECT_NEAR(std::log(ratio.high / ratio.value), half, 0.15 * half);
  EXPECT_NEAR(std::log(ratio.value / ratio.low), half, 0.15 * half);
}

TEST(RatioOf, IsTheSameForTheSameSeed) {
  const auto a = scattered(1, 101, 3, 0.5), b = scattered(2, 101, 2, 0.5);
  EXPECT_EQ(ratio_of(a, b, 5).low, ratio_of(a, b, 5).low);
  EXPECT_NE(ratio_of(a, b, 5).low, ratio_of(a, b, 6).low);
}

TEST(MedianOf, IsTheMiddleAndTheMeanOfTwo) {
  EXPECT_EQ(median_of({5, 1, 9}).value, 5);
  EXPECT_EQ(median_of({5, 1, 9, 6}).value, 5.5);
}

/// 0, 1 … n − 1, the greatest first.
std::vector<double> countdown(int n) {
  std::vector<double> values;
  while (n-- > 0) values.push_back(n);
  return values;
}

// The ranks come from tables of the sign test.
TEST(MedianOf, HasTheIntervalOfTheSignTest) {
  EXPECT_EQ(median_of(countdown(5)).low, 0);
  EXPECT_EQ(median_of(countdown(6)).low, 0);
  EXPECT_EQ(median_of(countdown(9)).low, 1);
  EXPECT_EQ(median_of(countdown(20)).low, 5);
  EXPECT_EQ(median_of(countdown(20)).high, 14);
  EXPECT_EQ(median_of(countdown(100)).low, 39);
  EXPECT_EQ(median_of(countdown(100)).high, 60);
  // √n · 1.96 / 2 on either side
  EXPECT_NEAR(median_of(countdown(100000)).low, 50000 - 310, 2);
}

TEST(MedianOf, IntervalHoldsTheTruthInNineteenOfTwentyCases) {
  int held = 0;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Estimate median = median_of(scattered(i, 25, 1, 0.5));
    held += median.low <= 1 && 1 <= median.high;
  }
  EXPECT_GT(held, 940);
  EXPECT_LT(held, 980);
}

TEST(Quantile, IsLinearBetweenNeighboursAndKnowsInfinity) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(quantile({1, 2, 3}, 0.25), 1.5);
  EXPECT_EQ(quantile({1, 2, 3}, 1), 3);
  EXPECT_EQ(quantile({1, 2, inf, inf}, 0.9), inf);
  EXPECT_EQ(quantile({1, 2, inf}, 0.5), 2);
}

}  // namespace
}  // namespace ergocast
