// SPDX-License-Identifier: BSD-3-Clause
// Fits a line to log φ² over log t, with weights that make equal parts of the logarithmic axis
// count equally.
#include "logger/slope.h"

#include <vector>

#include "core/base/portable_math.h"
#include "core/base/require.h"

namespace ergocast {
namespace {

constexpr std::size_t kFewestRows = 3;
constexpr double kShortestSpan = 2;

/// The share of the axis that each point represents. Rows at equal times are dense where log t is
/// large, and would outweigh the others.
std::vector<double> shares(const std::vector<double>& x) {
  std::vector<double> share;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double left = i == 0 ? x.front() : x[i - 1];
    const double right = i + 1 == x.size() ? x.back() : x[i + 1];
    share.push_back((right - left) / 2 / (x.back() - x.front()));
  }
  return share;
}

double mean(const std::vector<double>& values, const std::vector<double>& share) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += share[i] * values[i];
  return sum;
}

}  // namespace

double PowerLaw::at(double t_s) const {
  return portable::exp(center_log_value + slope * (portable::log(t_s) - center_log_t));
}

std::optional<PowerLaw> fit_last_decade(std::span<const double> t_s,
                                        std::span<const double> values) {
  ERGOCAST_REQUIRE(t_s.size() == values.size());
  std::vector<double> log_t, log_value;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    if (!(t_s[i] > 0 && t_s[i] >= t_s.back() / 10 && values[i] > 0)) continue;
    log_t.push_back(portable::log(t_s[i]));
    log_value.push_back(portable::log(values[i]));
  }
  if (log_t.size() < kFewestRows || log_t.back() - log_t.front() < portable::log(kShortestSpan))
    return {};

  PowerLaw law;
  const std::vector<double> share = shares(log_t);
  law.center_log_t = mean(log_t, share);
  law.center_log_value = mean(log_value, share);
  law.from_s = portable::exp(log_t.front());
  law.to_s = portable::exp(log_t.back());
  // Sums about the means: the textbook formula n·Σxy − Σx·Σy would cancel most digits.
  double square = 0, product = 0;
  for (std::size_t i = 0; i < log_t.size(); ++i) {
    const double x = log_t[i] - law.center_log_t;
    square += share[i] * x * x;
    product += share[i] * x * (log_value[i] - law.center_log_value);
  }
  law.slope = product / square;
  return law;
}

std::optional<double> log_log_slope(std::span<const double> t_s, std::span<const double> values) {
  const std::optional<PowerLaw> law = fit_last_decade(t_s, values);
  if (!law) return {};
  return law->slope;
}

}  // namespace ergocast
