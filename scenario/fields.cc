// SPDX-License-Identifier: BSD-3-Clause
// The table has one row for each number, found by the full name of the field.
#include "scenario/fields.h"

#include <algorithm>
#include <iterator>

#include "core/ids.h"
#include "scenario/findings.h"

namespace ergocast {
namespace {

using enum Absence;

constexpr Range between(double low, double high) { return {low, high, false}; }
constexpr Range above(double low, double high) { return {low, high, true}; }

/// Far beyond any domain: keeps sums and squares of coordinates finite and exact enough.
constexpr Range kCoordinate = {-1e13, 1e13, false, true};
constexpr Range kModes = between(1, kMaxModesPerAxis);
constexpr Range kIntensity = between(0, 1e6);
/// A variance; the limits that matter follow from the domain.
constexpr Range kVariance = above(0, 1e22);
constexpr double kMaxWallTime_s = 86400;

constexpr FieldRule kRules[] = {
    {"Domain", "origin_x_m", kCoordinate, kDefaulted, 0},
    {"Domain", "origin_y_m", kCoordinate, kDefaulted, 0},
    {"Domain", "size_x_m", between(1e-3, 1e7), kRefused},
    {"Domain", "size_y_m", between(1e-3, 1e7), kRefused},

    {"Target", "uniform_weight", between(0, 1e9), kDefaulted, 0},
    {"Gaussian", "weight", above(0, 1e9), kDefaulted, 1},
    {"Gaussian", "mean_x_m", kCoordinate, kRefused},
    {"Gaussian", "mean_y_m", kCoordinate, kRefused},
    {"Gaussian", "sigma_m", above(0, 1e11), kLeft},
    {"Covariance", "xx_m2", kVariance, kRefused},
    {"Covariance", "yy_m2", kVariance, kRefused},
    {"Covariance", "xy_m2", between(-1e22, 1e22), kDefaulted, 0},

    {"Map", "weight", above(0, 1e9), kDefaulted, 1},
    {"Map", "origin_x_m", kCoordinate, kLeft},
    {"Map", "origin_y_m", kCoordinate, kLeft},
    {"Map", "size_x_m", between(1e-3, 1e9), kLeft},
    {"Map", "size_y_m", between(1e-3, 1e9), kLeft},
    {"Region", "weight", above(0, 1e9), kDefaulted, 1},
    {"Vertex", "x_m", kCoordinate, kRefused},
    {"Vertex", "y_m", kCoordinate, kRefused},

    {"Basis", "modes_x", kModes, kDefaulted, 16},
    {"Basis", "modes_y", kModes, kDefaulted, 16},
    {"Basis", "sobolev_exponent", above(0, 10), kDefaulted, 1.5},

    {"Law", "u_max_mps", above(0, 1e6), kRefused},
    {"Law", "epsilon", kIntensity, kLeft},
    {"Law", "noise_intensity", kIntensity, kLeft},
    {"Law", "noise_ceiling", kIntensity, kLeft},
    {"Law", "contraction_gain_per_s", between(0, 1e6), kLeft},
    {"Law", "contraction_x_m", kCoordinate, kLeft},
    {"Law", "contraction_y_m", kCoordinate, kLeft},
    {"Law", "anticipation", between(0, 100), kLeft},

    {"Time", "dt_s", between(1e-6, 3600), kDefaulted, 0.1},
    {"Time", "duration_s", above(0, 1e7), kRefused},
    {"Time", "broadcast_period_ticks", between(1, 1000), kLeft},
    {"Time", "realtime_factor", between(0.01, 1000), kDefaulted, 1},
    {"Time", "lockstep_timeout_s", above(0, kMaxWallTime_s), kDefaulted, 10},
    {"Time", "command_hold_s", between(0, 1e6), kDefaulted, 0.5},
    {"Time", "admission_timeout_s", above(0, kMaxWallTime_s), kDefaulted, 30},
    {"Time", "catch_up_limit_ticks", between(0, 1000), kDefaulted, 5},

    {"Agents", "random_count", between(0, kMaxAgents), kDefaulted, 0},
    {"Agents", "quorum", between(1, kMaxAgents), kLeft},
    {"Agents", "forget_silent_after_s", between(0, 1e6), kDefaulted, 0},
    {"Start", "x_m", kCoordinate, kRefused},
    {"Start", "y_m", kCoordinate, kRefused},

    {"World", "disturbance_intensity", kIntensity, kDefaulted, 0},
    {"World", "radio_range_m", between(0, 1e13), kDefaulted, 0},
    {"World", "speed_limit_mps", above(0, 1e9), kLeft},

    {"Scenario", "goal_ergodic_metric", above(0, 1e9), kLeft},
};

}  // namespace

bool Range::contains(double value) const {
  return (low_excluded ? value > low : value >= low) && value <= high;
}

std::string Range::text() const {
  if (low_excluded) return "above " + shortest(low) + ", at most " + shortest(high);
  return shortest(low) + " to " + shortest(high);
}

const FieldRule* rule_of(const google::protobuf::FieldDescriptor& field) {
  const auto* found =
      std::find_if(std::begin(kRules), std::end(kRules), [&](const FieldRule& rule) {
        return rule.field == field.name() && rule.message == field.containing_type()->name();
      });
  return found == std::end(kRules) ? nullptr : found;
}

}  // namespace ergocast
