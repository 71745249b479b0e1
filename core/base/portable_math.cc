// SPDX-License-Identifier: BSD-3-Clause
// Reduces each argument to a short interval, where a polynomial with the least greatest error is
// exact enough.
#include "core/base/portable_math.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "core/base/double_pair.h"
#include "core/base/portable_tables.h"

namespace ergocast::portable {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Added to a smaller number, it leaves the nearest integer in the last bits of the sum.
constexpr double kRounder = 0x1.8p52;

// ---- sine and cosine ----

/// π/2 = Σ kHalfPi; the first three have 33 bits, so that their products with 20 bits are exact.
constexpr double kHalfPi[] = {0x1.921fb544p0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69,
                              0x1.b839a252049c1p-104};
constexpr double kMostQuarters = 0x1p20;
/// In a smaller rest of the angle, or after more quarters, the third part of π/2 is not small.
constexpr double kNearQuarter = 0x1p-10, kFewQuarters = 0x1p8;

/// x − quarters·π/2, where the third part counts.
DoublePair rest_with_third(const DoublePair& rest, double quarters) {
  const DoublePair sum = exact_sum(rest.high, -quarters * kHalfPi[2]);
  const double low = (sum.low + rest.low) - quarters * kHalfPi[3];
  const double high = sum.high + low;
  return {high, (sum.high - high) + low};
}

/// x − quarters·π/2 for the nearest number of quarters.
DoublePair rest_of(double x, double quarters) {
  const DoublePair rest = exact_sum(x - quarters * kHalfPi[0], -quarters * kHalfPi[1]);
  const bool third_counts =
      (std::abs(rest.high) < kNearQuarter && quarters != 0) || std::abs(quarters) > kFewQuarters;
  if (third_counts) return rest_with_third(rest, quarters);
  return {rest.high, rest.low - quarters * kHalfPi[2]};
}

/// For |r| ≤ π/4. [Cody and Waite]
double sine_of(const DoublePair& r, double z) {
  const double zz = z * z;
  const double p = (-0x1.555555555554dp-3 + z * 0x1.111111110fb5p-7) +
                   zz * ((-0x1.a01a019c30bb9p-13 + z * 0x1.71de356f7467bp-19) +
                         zz * (-0x1.ae5e4c5861426p-26 + z * 0x1.5d8773bdffac2p-33));
  return r.high + (r.high * z * p + r.low * (1 - 0.5 * z));
}

double cosine_of(const DoublePair& r, double z) {
  const double zz = z * z;
  const double p = (0x1.5555555555553p-5 + z * -0x1.6c16c16c16134p-10) +
                   zz * ((0x1.a01a019e24eeep-16 + z * -0x1.27e4f9040acc9p-22) +
                         zz * (0x1.1eea895c62ccap-29 + z * -0x1.8ff9dc3bd0b16p-37));
  const double half = 0.5 * z, first = 1 - half;
  return first + (((1 - first) - half) + (zz * p - r.high * r.low));
}

// ---- exponential ----

/// 2^exponent, for |exponent| ≤ 1000.
double power_of_2(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}

/// power·(1 + rest)·2^exponent.
struct Exponential {
  double power, rest;
  int exponent;
  double value() const {
    if (std::abs(exponent) > 1000) return std::ldexp(power + power * rest, exponent);
    const double scaled = power * power_of_2(exponent);
    return scaled + scaled * rest;
  }
};

/// exp(x − less) for |x| ≤ 746 and a number that is small against the last bit of x. [Tang]
inline Exponential exponential_of(double x, double less) {
  const double rounded = x * 0x1.71547652b82fep5 + kRounder, steps = rounded - kRounder;
  const auto k = static_cast<std::int32_t>(std::bit_cast<std::uint64_t>(rounded));
  const double r = (x - steps * 0x1.62e42feep-6) - (steps * 0x1.a39ef35793c76p-38 + less);
  const double rr = r * r;
  const double p =
      rr * (0.5 + r * 0x1.5555555548ecp-3) +
      (rr * rr) * ((0x1.5555555545d2bp-5 + r * 0x1.11115b9e10839p-7) + rr * 0x1.6c1728c58718cp-10);
  const Power& power = kPowers[static_cast<std::size_t>(k & 31)];
  return {power.value, r + (power.rest + p), k >> 5};
}

// ---- logarithm ----

/// The bits of √½: mantissas from there to √2 have logarithms around 0.
constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcd;
/// Added to a number below 2, it leaves the nearest multiple of 1/128 in the last bits of the sum.
constexpr double kPlacer = 0x1.8p45;
constexpr double kSmallestNormal = std::numeric_limits<double>::min();

/// ln x − less for a finite x > 0 and a number that is small against the last bits of x; its parts
/// may overlap. With x = 2^k m and m·inverse = 1 + r, ln x = k ln 2 − ln(inverse) + ln(1 + r).
inline DoublePair logarithm_of(double x, double less) {
  const bool tiny = x < kSmallestNormal;
  const auto bits = std::bit_cast<std::uint64_t>(tiny ? x * 0x1p54 : x);
  const auto exponent = static_cast<std::int64_t>(bits - kRootOfHalf) >> 52;
  const std::uint64_t mantissa = bits - (static_cast<std::uint64_t>(exponent) << 52);
  const double m = std::bit_cast<double>(mantissa), k = static_cast<double>(exponent) - 54 * tiny;
  const auto place = static_cast<std::size_t>(std::bit_cast<std::uint64_t>(m + kPlacer) & 255);
  const LogarithmAt& at = kLogarithms[place - kFirstLogarithm];
  // The products of both halves of m are exact.
  const double m_high = std::bit_cast<double>(mantissa & 0xffff'ffff'0000'0000);
  const double a = m_high * at.inverse - 1, b = (m - m_high) * at.inverse, r = a + b;
  const double whole = k * 0x1.62e42fefa38p-1 + at.high, high = whole + r;
  const double lost =
      ((whole - high) + r) + (((a - r) + b) + (k * 0x1.ef35793c7673p-45 + (at.low - less)));
  const double rr = r * r;
  const double p =
      (-0.5 + r * (1.0 / 3)) + rr * ((-0.25 + r * 0.2) + rr * (-1.0 / 6 + r * (1.0 / 7)));
  return {high, lost + rr * p};
}

// ---- error function ----

/// erf(c + h) − erf(c) by Taylor's series: the derivatives of g = 2/√π exp(−x²) follow from
/// g′ = −2 x g.
double erf_beyond(double c, double h) {
  constexpr int kTerms = 14;
  double terms[kTerms];
  double last = 0, g = 0x1.20dd750429b6dp0 * exp(-c * c), power = h;
  for (int n = 0; n < kTerms; ++n) {
    terms[n] = g * power / (n + 1);
    const double next = -2 * (c * g + last) / (n + 1);
    last = g;
    g = next;
    power *= h;
  }
  double sum = 0;
  for (int n = kTerms - 1; n >= 0; --n) sum += terms[n];
  return sum;
}

}  // namespace

SinCos sin_cos(double x) {
  if (!(std::abs(x) <= kMostQuarters)) {
    if (!(std::abs(x) < kInfinity)) return {kNoNumber, kNoNumber};
    x = std::remainder(x, 4 * kHalfPi[0] + 4 * kHalfPi[1]);
  }
  const double rounded = x * 0x1.45f306dc9c883p-1 + kRounder;
  const auto quarter = std::bit_cast<std::uint64_t>(rounded);
  const DoublePair r = rest_of(x, rounded - kRounder);
  const double z = r.high * r.high, sine = sine_of(r, z), cosine = cosine_of(r, z);
  const bool odd = (quarter & 1) != 0;
  const double s = odd ? cosine : sine, c = odd ? sine : cosine;
  return {(quarter & 2) != 0 ? -s : s, ((quarter + 1) & 2) != 0 ? -c : c};
}

double exp(double x) {
  if (!(x <= 710)) return x + kInfinity;
  return x < -746 ? 0 : exponential_of(x, 0).value();
}

double expm1(double x) {
  if (!(x < 40)) return exp(x);
  if (x < -38) return -1;
  if (std::abs(x) > 0.34) {
    const Exponential e = exponential_of(x, 0);
    const DoublePair less = exact_sum(e.power, -power_of_2(-e.exponent));
    return (less.high + (less.low + e.power * e.rest)) * power_of_2(e.exponent);
  }
  const double z = x * x, zz = z * z;
  const double p = (0x1.5555555555559p-3 + x * 0x1.5555555555548p-5) +
                   z * (0x1.111111110f7bap-7 + x * 0x1.6c16c16c1cda0p-10) +
                   zz * ((0x1.a01a01af8cb32p-13 + x * 0x1.a01a0182db42cp-16) +
                         z * (0x1.71ddf912b520ep-19 + x * 0x1.27e52b5bdcd41p-22) +
                         zz * (0x1.af5d9ceac463ap-26 + x * 0x1.1ef5259e6a917p-29));
  return x + (0.5 * z + z * x * p);
}

double log(double x) {
  if (!(x > 0)) return x == 0 ? -kInfinity : kNoNumber;
  if (!(x < kInfinity)) return x;
  const DoublePair l = logarithm_of(x, 0);
  return l.high + l.low;
}

double log1p(double x) {
  if (!(x > -1)) return x == -1 ? -kInfinity : kNoNumber;
  if (std::abs(x) < 0x1p-54 || x == kInfinity) return x;
  const DoublePair sum = exact_sum(1, x), l = logarithm_of(sum.high, -sum.low / sum.high);
  return l.high + l.low;
}

double pow(double x, double y) {
  if (x == 0 && y != 0) return y > 0 ? 0 : y < 0 ? kInfinity : kNoNumber;
  if (y == 0 || x == 1) return 1;
  if (!(x > 0 && x < kInfinity && std::abs(y) < kInfinity)) return kNoNumber;
  const DoublePair l = logarithm_of(x, 0);
  const double logarithm = l.high + l.low, rest = (l.high - logarithm) + l.low;
  const DoublePair power = exact_product(y, logarithm);
  if (!(std::abs(power.high) <= 700)) return exp(power.high);
  return exponential_of(power.high, -(power.low + y * rest)).value();
}

double erf(double x) {
  const double a = std::abs(x);
  if (!(a < 6)) return std::isnan(x) ? x : std::copysign(1.0, x);
  const double nearest = std::floor(a * 8 + 0.5);
  const auto j = static_cast<std::size_t>(nearest);
  if (j >= kErf.size()) return std::copysign(1.0, x);
  const double c = static_cast<double>(j) / 8;
  return std::copysign(kErf[j] + erf_beyond(c, a - c), x);
}

double scaled_hypot(double x, double y, double z) {
  const double a = std::abs(x), b = std::abs(y), c = std::abs(z);
  const double most = std::max({a, b, c});
  if (a == kInfinity || b == kInfinity || c == kInfinity) return kInfinity;
  if (std::isnan(a + b + c)) return kNoNumber;
  if (most == 0) return 0;
  const int exponent = std::ilogb(most);
  const double u = std::ldexp(a, -exponent), v = std::ldexp(b, -exponent),
               w = std::ldexp(c, -exponent);
  return std::ldexp(std::sqrt(u * u + v * v + w * w), exponent);
}

}  // namespace ergocast::portable
