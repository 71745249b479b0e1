// SPDX-License-Identifier: BSD-3-Clause
// Statistics over many seeds: medians and ratios with their confidence intervals.
#pragma once

#include <cstdint>
#include <vector>

namespace ergocast {

/// A value with its confidence interval of 95 %.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// exp of the mean of log(numerator_i / denominator_i), pair by pair (i is the seed); the interval
/// is by bootstrap: the 2.5 % and 97.5 % quantiles of 2000 resamples of the pairs, drawn with
/// `seed`.
/// @pre equally many of each, at least one, all above 0
Estimate ratio_of(const std::vector<double>& numerators, const std::vector<double>& denominators,
                  std::uint64_t seed = 1);

/// The median; the interval by order statistics, which assumes no distribution: from the r-th
/// smallest value to the r-th largest. r is the greatest number for which a binomial of n and 1/2
/// is below r with a probability of at most 2.5 %. Five values or fewer do not reach that
/// confidence; then the interval goes from the smallest to the largest.
/// @pre at least one value, none of them nan
Estimate median_of(std::vector<double> values);

/// The quantile `p` of the values, linear between neighbours.
/// @pre ascending, at least one value; infinite ones are allowed
double quantile(const std::vector<double>& ascending, double p);

}  // namespace ergocast
