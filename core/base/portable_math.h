// SPDX-License-Identifier: BSD-3-Clause
// Elementary functions with the same bits on every processor, for all code whose results must
// agree.
//
// A C library's sine, exponential and logarithm differ in the last bit between processors with and
// without fused multiply-add, and between versions. These functions use + − × ÷ √ on doubles, and
// integers. Errors are in units in the last place (ulp) of a normal result, greatest ones measured
// against correctly rounded values (tests/core/portable_math_test.cc); a correct rounding has 0.5.
// Arguments that are not numbers give results that are not numbers.
#pragma once

#include <cmath>

namespace ergocast::portable {

struct SinCos {
  double sin, cos;
};

/// sin x and cos x for |x| ≤ 2²⁰; 0.90 ulp. Beyond, the error of the argument is |x|·2⁻⁵³ and its
/// functions are as exact. ±∞ gives no number.
SinCos sin_cos(double x);
inline double sin(double x) { return sin_cos(x).sin; }
inline double cos(double x) { return sin_cos(x).cos; }

/// eˣ; 0.53 ulp. ∞ above 709.78, 0 below −745.13.
double exp(double x);
/// eˣ − 1, also for small x; 0.80 ulp.
double expm1(double x);
/// ln x; 0.52 ulp. −∞ at 0, no number below.
double log(double x);
/// ln(1 + x), also for small x; 0.52 ulp. −∞ at −1, no number below.
double log1p(double x);
/// xʸ for x ≥ 0; 0.53 ulp where |y| ≤ 8 and |y ln x| ≤ 700. No number for other x.
double pow(double x, double y);
inline double square(double x) { return x * x; }
/// 2/√π ∫₀ˣ exp(−t²) dt; 1.9 ulp.
double erf(double x);

/// hypot for arguments whose squares or their sum leave the range of doubles.
double scaled_hypot(double x, double y, double z);

/// √(x² + y² + z²) without overflow or underflow; 1.5 ulp.
inline double hypot(double x, double y, double z) {
  const double square = x * x + y * y + z * z;
  if (square > 0x1p-900 && square < 0x1p1000) return std::sqrt(square);
  return scaled_hypot(x, y, z);
}
/// √(x² + y²); 1.2 ulp.
inline double hypot(double x, double y) { return hypot(x, y, 0); }

}  // namespace ergocast::portable
