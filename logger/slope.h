// SPDX-License-Identifier: BSD-3-Clause
// The rate at which φ² falls: the power of t that fits its last decade.
#pragma once

#include <optional>
#include <span>

namespace ergocast {

/// A straight line in log–log coordinates: value ≈ at(t) ∝ t^slope, fitted over [from_s, to_s].
struct PowerLaw {
  double slope = 0;
  double center_log_t = 0, center_log_value = 0;  ///< a point on the line
  double from_s = 0, to_s = 0;

  double at(double t_s) const;
};

/// Least squares of log value against log t over the last decade of time, with equal weight for
/// equal lengths of log t. Uses rows with t > 0, t ≥ t_end/10 and value > 0, where t_end is the
/// last row's time. Nothing if fewer than three rows remain. Nothing also if they cover less than a
/// factor of 2 in time, because noise then looks like a slope.
/// @pre t_s is ascending and as long as values.
std::optional<PowerLaw> fit_last_decade(std::span<const double> t_s,
                                        std::span<const double> values);

/// The slope of fit_last_decade().
std::optional<double> log_log_slope(std::span<const double> t_s, std::span<const double> values);

}  // namespace ergocast
