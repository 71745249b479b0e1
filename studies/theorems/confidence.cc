// SPDX-License-Identifier: BSD-3-Clause
// Closed forms of the inequalities: Dvoretzky-Kiefer-Wolfowitz, empirical Bernstein, and tails
// of chi-square.
#include "studies/theorems/confidence.h"

#include <cmath>

#include "core/base/require.h"

namespace ergocast::studies {

double dkw_distance(std::size_t count, double error) {
  return std::sqrt(std::log(2 / error) / (2 * static_cast<double>(count)));
}

double least_probability(std::size_t count, double error) {
  return std::pow(error, 1 / static_cast<double>(count));
}

double upper_mean(const std::vector<double>& draws, double limit, double error) {
  ERGOCAST_REQUIRE(draws.size() > 1);
  const auto count = static_cast<double>(draws.size());
  double mean = 0, variance = 0;
  for (const double draw : draws) mean += draw / count;
  for (const double draw : draws) variance += (draw - mean) * (draw - mean) / (count - 1);
  const double exponent = std::log(2 / error);
  return mean + std::sqrt(2 * variance * exponent / count) +
         7 * limit * exponent / (3 * (count - 1));
}

Limits chi_square_limits(double freedom, double shift, double error) {
  const double exponent = -std::log(error),
               spread = 2 * std::sqrt((freedom + 2 * shift) * exponent);
  return {freedom + shift - spread, freedom + shift + spread + 2 * exponent};
}

}  // namespace ergocast::studies
