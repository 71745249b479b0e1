#include "studies/statistics.h"

#include <algorithm>
#include <cmath>

#include "core/noise.h"
#include "core/require.h"

namespace ergocast::studies {
namespace {

constexpr int kResamples = 2000;

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The mean of as many values as there are, each drawn anew.
double resampled_mean(const std::vector<double>& values, std::uint64_t seed, std::uint32_t resample) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); i += 2) {
    const Words words = random_words(seed, Purpose::kFault, resample, i);
    sum += values[words.first % values.size()];
    if (i + 1 < values.size()) sum += values[words.second % values.size()];
  }
  return sum / static_cast<double>(values.size());
}

}  // namespace

Ratio ratio_of(const std::vector<double>& numerators, const std::vector<double>& denominators,
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

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace ergocast::studies
