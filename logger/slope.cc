#include "logger/slope.h"

#include <cmath>
#include <vector>

#include "core/require.h"

namespace ergocast {
namespace {

constexpr std::size_t kFewestRows = 3;
constexpr double kShortestSpan = 2;

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

double PowerLaw::at(double t_s) const {
  return std::exp(center_log_value + slope * (std::log(t_s) - center_log_t));
}

std::optional<PowerLaw> fit_last_decade(std::span<const double> t_s,
                                        std::span<const double> values) {
  ERGOCAST_REQUIRE(t_s.size() == values.size());
  std::vector<double> log_t, log_value;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    if (!(t_s[i] > 0 && t_s[i] >= t_s.back() / 10 && values[i] > 0)) continue;
    log_t.push_back(std::log(t_s[i]));
    log_value.push_back(std::log(values[i]));
  }
  if (log_t.size() < kFewestRows || log_t.back() - log_t.front() < std::log(kShortestSpan)) return {};

  PowerLaw law;
  law.center_log_t = mean(log_t);
  law.center_log_value = mean(log_value);
  law.from_s = std::exp(log_t.front());
  law.to_s = std::exp(log_t.back());
  // Sums about the means: the textbook formula n·Σxy − Σx·Σy would cancel most digits.
  double square = 0, product = 0;
  for (std::size_t i = 0; i < log_t.size(); ++i) {
    const double x = log_t[i] - law.center_log_t;
    square += x * x;
    product += x * (log_value[i] - law.center_log_value);
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
