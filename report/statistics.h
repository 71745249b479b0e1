// SPDX-License-Identifier: BSD-3-Clause
// What many seeds say: medians, ratios, and how sure one can be of them.
#pragma once

#include <cstdint>
#include <vector>

namespace ergocast {

/// A value, and between which values it lies with a confidence of 95 %.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// exp of the mean of log(numerator_i / denominator_i), pair by pair (i is the seed); the interval
/// by bootstrap: the 2.5 % and 97.5 % quantiles of 2000 resamples of the pairs, drawn from `seed`.
/// @pre as many of each, at least one, all above 0
Estimate ratio_of(const std::vector<double>& numerators, const std::vector<double>& denominators,
                  std::uint64_t seed = 1);

/// The median; the interval by order statistics, which assumes nothing about the distribution: from
/// the r-th smallest value to the r-th largest with the greatest r for which a binomial of n and
/// 1/2 is below r with a probability of at most 2.5 %. Five values and fewer cannot give that
/// confidence: then from the smallest to the largest.
/// @pre at least one value, none of them nan
Estimate median_of(std::vector<double> values);

/// The value that a share `p` of the values lies below, linear between neighbours.
/// @pre ascending, at least one value; infinite ones are allowed
double quantile(const std::vector<double>& ascending, double p);

}  // namespace ergocast
