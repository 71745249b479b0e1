// SPDX-License-Identifier: BSD-3-Clause
// Portable functions against a longer type, at the ends of their ranges, and by a hash of their
// bits that every processor must give.
#include "core/base/portable_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "core/base/noise.h"

namespace ergocast {
namespace {

using Function = std::function<double(double)>;
using Wide = std::function<long double(long double)>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kArguments = 20000;

double uniform(int i) {
  return uniform_pair(7, Purpose::kStart, 0, static_cast<std::uint64_t>(i)).x();
}

/// The greatest error over [low, high], in units in the last place of the result.
double worst_ulp(const Function& function, const Wide& wide, double low, double high) {
  double worst = 0;
  for (int i = 0; i < kArguments; ++i) {
    const double x = low + (high - low) * uniform(i);
    const long double exact = wide(x);
    const double unit = std::ldexp(1.0, std::ilogb(static_cast<double>(exact)) - 52);
    const double error = static_cast<double>(std::abs(function(x) - exact)) / unit;
    worst = std::max(worst, error);
  }
  return worst;
}

TEST(PortableMath, HasTheStatedErrors) {
  const auto sine = [](long double x) { return std::sin(x); };
  const auto cosine = [](long double x) { return std::cos(x); };
  for (const double high : {1.0, 7.0, 1000.0, 0x1p20}) {
    EXPECT_LT(worst_ulp(portable::sin, sine, -high, high), 0.90) << high;
    EXPECT_LT(worst_ulp(portable::cos, cosine, -high, high), 0.90) << high;
  }
  const auto minus_1 = [](long double x) { return std::expm1(x); };
  const auto of_1_plus = [](long double x) { return std::log1p(x); };
  const auto logarithm = [](long double x) { return std::log(x); };
  EXPECT_LT(worst_ulp(
                portable::exp, [](long double x) { return std::exp(x); }, -700, 700),
            0.53);
  for (const double high : {1e-9, 0.5, 3.0, 30.0}) {
    EXPECT_LT(worst_ulp(portable::expm1, minus_1, -high, high), 0.80) << high;
    EXPECT_LT(worst_ulp(portable::log1p, of_1_plus, 0, high), 0.52) << high;
    EXPECT_LT(worst_ulp(portable::log, logarithm, 1e-12, high), 0.52) << high;
  }
  EXPECT_LT(worst_ulp(portable::log1p, of_1_plus, -1, 0), 0.52);
  EXPECT_LT(worst_ulp(portable::log, logarithm, 0.5, 1.5), 0.52);
  EXPECT_LT(worst_ulp(
                portable::erf, [](long double x) { return std::erf(x); }, -6, 6),
            1.9);
  for (const double y : {-3.5, -1.5, 0.5, 2.0, 7.25}) {
    EXPECT_LT(worst_ulp([y](double x) { return portable::pow(x, y); },
                        [y](long double x) { return std::pow(x, static_cast<long double>(y)); },
                        1e-3, 2000),
              0.53)
        << y;
  }
}

TEST(PortableMath, HasTheStatedErrorsOfHypot) {
  for (const double unit : {1e-300, 1e-5, 1.0, 1e300}) {
    const double y = 0.7 * unit, z = 0.3 * unit;
    const auto wide = [&](long double x) { return std::hypot(x, static_cast<long double>(y)); };
    EXPECT_LT(worst_ulp([&](double x) { return portable::hypot(x, y); }, wide, 0, unit), 1.2);
    const auto in_space = [&](long double x) {
      return std::hypot(x, static_cast<long double>(y), static_cast<long double>(z));
    };
    EXPECT_LT(worst_ulp([&](double x) { return portable::hypot(x, y, z); }, in_space, 0, unit),
              1.5);
  }
}

TEST(PortableMath, IsExactWhereTheResultIs) {
  EXPECT_EQ(portable::sin(0), 0);
  EXPECT_EQ(portable::cos(0), 1);
  EXPECT_EQ(portable::exp(0), 1);
  EXPECT_EQ(portable::expm1(0), 0);
  EXPECT_EQ(portable::log(1), 0);
  EXPECT_EQ(portable::log1p(0), 0);
  EXPECT_EQ(portable::erf(0), 0);
  EXPECT_EQ(portable::hypot(3, 4), 5);
  EXPECT_EQ(portable::hypot(0, 0), 0);
  EXPECT_EQ(portable::hypot(2, 3, 6), 7);
  EXPECT_EQ(portable::pow(4, 0.5), 2);
  EXPECT_EQ(portable::pow(8, 1.0 / 3), 2);
  EXPECT_EQ(portable::pow(3, 4), 81);
  for (int halvings = 0; halvings < 900; ++halvings)
    EXPECT_EQ(portable::pow(0.5, halvings), std::ldexp(1.0, -halvings));
}

TEST(PortableMath, HasLimits) {
  EXPECT_EQ(portable::exp(1000), kInfinity);
  EXPECT_EQ(portable::exp(-1000), 0);
  EXPECT_GT(portable::exp(-745), 0);
  EXPECT_EQ(portable::expm1(1000), kInfinity);
  EXPECT_EQ(portable::expm1(-1000), -1);
  EXPECT_EQ(portable::log(0), -kInfinity);
  EXPECT_EQ(portable::log(kInfinity), kInfinity);
  EXPECT_EQ(portable::log1p(-1), -kInfinity);
  EXPECT_NEAR(portable::log(std::numeric_limits<double>::denorm_min()), -744.44, 0.01);
  EXPECT_EQ(portable::pow(0, 2), 0);
  EXPECT_EQ(portable::pow(0, 0), 1);
  EXPECT_EQ(portable::pow(2, 2000), kInfinity);
  EXPECT_EQ(portable::pow(2, -2000), 0);
  EXPECT_EQ(portable::erf(-7), -1);
  EXPECT_EQ(portable::hypot(-kInfinity, 1), kInfinity);
  EXPECT_NEAR(portable::sin(1e9), std::sin(1e9), 1e-6);
}

TEST(PortableMath, OfNoNumberIsNoNumber) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const Function& function :
       {Function(portable::sin), Function(portable::cos), Function(portable::exp),
        Function(portable::expm1), Function(portable::log), Function(portable::log1p),
        Function(portable::erf)}) {
    EXPECT_TRUE(std::isnan(function(none)));
  }
  EXPECT_TRUE(std::isnan(portable::sin(kInfinity)));
  EXPECT_TRUE(std::isnan(portable::log(-1)));
  EXPECT_TRUE(std::isnan(portable::log1p(-2)));
  EXPECT_TRUE(std::isnan(portable::pow(-1, 2)));
  EXPECT_TRUE(std::isnan(portable::pow(none, 2)));
  EXPECT_TRUE(std::isnan(portable::hypot(none, 1)));
}

/// A hash of the bits of a function's results.
std::uint64_t hash_of(const Function& function, double low, double high) {
  std::uint64_t hash = 0;
  for (int i = 0; i < kArguments; ++i) {
    const double result = function(low + (high - low) * uniform(i));
    hash = (hash ^ std::bit_cast<std::uint64_t>(result)) * 0x9e3779b97f4a7c15;
  }
  return hash;
}

TEST(PortableMath, HasTheSameBitsOnEveryProcessor) {
  EXPECT_EQ(hash_of(portable::sin, -10, 10), 0x59ba40257e8602c3u);
  EXPECT_EQ(hash_of(portable::cos, -10, 10), 0x4578ee72737645a3u);
  EXPECT_EQ(hash_of(portable::sin, -0x1p21, 0x1p21), 0xad682f5f91413037u);
  EXPECT_EQ(hash_of(portable::exp, -750, 710), 0x549d80085f181948u);
  EXPECT_EQ(hash_of(portable::expm1, -3, 3), 0x29b680e33f1a0463u);
  EXPECT_EQ(hash_of(portable::log, 0, 3), 0x6d1a4b3d99874132u);
  EXPECT_EQ(hash_of(portable::log1p, -1, 3), 0x87a75477de3918b5u);
  EXPECT_EQ(hash_of(portable::erf, -6, 6), 0xc641ca48591e69ecu);
  EXPECT_EQ(hash_of([](double x) { return portable::pow(x, -1.5); }, 0, 900), 0xa03905fa00bea753u);
  EXPECT_EQ(hash_of([](double x) { return portable::hypot(x, 0.7); }, 0, 3), 0x5ff22f648c76bfcau);
}

}  // namespace
}  // namespace ergocast
