// SPDX-License-Identifier: BSD-3-Clause
// What a finite number of seeds proves, with a stated probability of being wrong.
#pragma once

#include <cstddef>
#include <vector>

namespace ergocast::studies {

/// Dvoretzky, Kiefer, Wolfowitz and Massart: the empirical distribution of `count` draws is nowhere
/// farther from the true one than this, except with probability `error`.
double dkw_distance(std::size_t count, double error);

/// Clopper and Pearson: if all of `count` draws succeed, the probability of success is at least
/// this, except with probability `error`.
double least_probability(std::size_t count, double error);

/// Maurer and Pontil's empirical Bernstein inequality: the mean of a quantity between 0 and `limit`
/// is at most this, except with probability `error`, given independent draws of it.
double upper_mean(const std::vector<double>& draws, double limit, double error);

/// Birgé: a noncentral χ² of `freedom` degrees and noncentrality `shift` is within these limits;
/// each holds except with probability `error`.
struct Limits {
  double low, high;
};
Limits chi_square_limits(double freedom, double shift, double error);

}  // namespace ergocast::studies
