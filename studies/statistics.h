// What many seeds say about a ratio.
#pragma once

#include <cstdint>
#include <vector>

namespace ergocast::studies {

/// A geometric mean of ratios, and between which values it lies with a confidence of 95 %.
struct Ratio {
  double value = 1, low = 1, high = 1;
};

/// exp of the mean of log(numerator_i / denominator_i), pair by pair (i is the seed); the interval
/// by bootstrap: the 2.5 % and 97.5 % quantiles of 2000 resamples of the pairs, drawn from `seed`.
/// @pre as many of each, at least one, all above 0
Ratio ratio_of(const std::vector<double>& numerators, const std::vector<double>& denominators,
               std::uint64_t seed = 1);

/// The value in the middle; 0 if there is none.
double median_of(std::vector<double> values);

}  // namespace ergocast::studies
