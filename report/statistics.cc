// SPDX-License-Identifier: BSD-3-Clause
// Takes intervals of medians from order statistics, and intervals of ratios from a bootstrap
// with fixed seeds.
#include "report/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/noise.h"
#include "core/base/require.h"

namespace ergocast {
namespace {

constexpr int kResamples = 2000;

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The mean of a resample, which draws n of the n values with replacement.
double resampled_mean(const std::vector<double>& values, std::uint64_t seed,
                      std::uint32_t resample) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); i += 2) {
    const RandomBits words = random_words(seed, Purpose::kFault, resample, i);
    sum += values[words.first % values.size()];
    if (i + 1 < values.size()) sum += values[words.second % values.size()];
  }
  return sum / static_cast<double>(values.size());
}

/// r − 1 of median_of().
std::size_t values_below_interval(std::size_t n) {
  const auto count = static_cast<double>(n);
  double tail = 0;
  for (std::size_t k = 0; 2 * k < n; ++k) {
    const auto chosen = static_cast<double>(k);
    tail += std::exp(std::lgamma(count + 1) - std::lgamma(chosen + 1) -
                     std::lgamma(count - chosen + 1) - count * std::numbers::ln2);
    if (tail > 0.025) return k == 0 ? 0 : k - 1;
  }
  return 0;
}

}  // namespace

Estimate ratio_of(const std::vector<double>& numerators, const std::vector<double>& denominators,
                  std::uint64_t seed) {
  ERGOCAST_REQUIRE(!numerators.empty() && numerators.size() == denominators.size());
  std::vector<double> logs(numerators.size());
  for (std::size_t i = 0; i < logs.size(); ++i) logs[i] = std::log(numerators[i] / denominators[i]);
  std::vector<double> means;
  for (std::uint32_t r = 0; r < kResamples; ++r) means.push_back(resampled_mean(logs, seed, r));
  std::sort(means.begin(), means.end());
  return {std::exp(mean(logs)), std::exp(means[kResamples / 40]),
          std::exp(means[kResamples - 1 - kResamples / 40])};
}

Estimate median_of(std::vector<double> values) {
  ERGOCAST_REQUIRE(!values.empty());
  std::sort(values.begin(), values.end());
  const std::size_t below = values_below_interval(values.size());
  return {quantile(values, 0.5), values[below], values[values.size() - 1 - below]};
}

double quantile(const std::vector<double>& ascending, double p) {
  ERGOCAST_REQUIRE(!ascending.empty());
  const double place = p * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(below);
  // No interpolation between two infinite values.
  if (share == 0 || ascending[below] == ascending[below + 1]) return ascending[below];
  return ascending[below] + share * (ascending[below + 1] - ascending[below]);
}

}  // namespace ergocast
