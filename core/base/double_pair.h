// SPDX-License-Identifier: BSD-3-Clause
// Sums and products of doubles together with what their rounding lost, on every processor alike: a
// long double has 64 bits on one, and 113 on another.
#pragma once

namespace ergocast {

/// high + low; |low| is at most half of the last bit of high.
struct DoublePair {
  double high, low;
};

/// a + b, exactly. [Knuth]
inline DoublePair exact_sum(double a, double b) {
  const double sum = a + b, b_in_sum = sum - a;
  return {sum, (a - (sum - b_in_sum)) + (b - b_in_sum)};
}

/// Parts of at most 26 bits, for |a| < 2⁹⁹⁵. [Veltkamp]
inline DoublePair halves_of(double a) {
  const double scaled = 0x1.0000002p27 * a;
  const double high = scaled - (scaled - a);
  return {high, a - high};
}

/// a · b, exactly unless its last bits underflow. [Dekker]
inline DoublePair exact_product(double a, double b) {
  const double product = a * b;
  const DoublePair x = halves_of(a), y = halves_of(b);
  const double rest = ((x.high * y.high - product) + x.high * y.low) + x.low * y.high;
  return {product, rest + x.low * y.low};
}

}  // namespace ergocast
