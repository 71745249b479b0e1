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

using limits::above;
using limits::between;

constexpr Range kCoordinate = {limits::kCoordinate_m, true};
/// A variance; its effective limits follow from the domain.
constexpr Limits kVariance = above(0, 1e22);
constexpr Limits kWeight = above(0, 1e9);

constexpr FieldRule kRules[] = {
    {"Domain", "origin_x_m", kCoordinate, kDefaulted, 0},
    {"Domain", "origin_y_m", kCoordinate, kDefaulted, 0},
    {"Domain", "size_x_m", limits::kSize_m, kRefused},
    {"Domain", "size_y_m", limits::kSize_m, kRefused},

    {"Target", "uniform_weight", between(0, 1e9), kDefaulted, 0},
    {"Gaussian", "weight", kWeight, kDefaulted, 1},
    {"Gaussian", "mean_x_m", kCoordinate, kRefused},
    {"Gaussian", "mean_y_m", kCoordinate, kRefused},
    {"Gaussian", "sigma_m", above(0, 1e11), kLeft},
    {"Covariance", "xx_m2", kVariance, kRefused},
    {"Covariance", "yy_m2", kVariance, kRefused},
    {"Covariance", "xy_m2", between(-1e22, 1e22), kDefaulted, 0},

    {"Map", "weight", kWeight, kDefaulted, 1},
    {"Map", "origin_x_m", kCoordinate, kLeft},
    {"Map", "origin_y_m", kCoordinate, kLeft},
    {"Map", "size_x_m", between(1e-3, 1e9), kLeft},
    {"Map", "size_y_m", between(1e-3, 1e9), kLeft},
    {"Region", "weight", kWeight, kDefaulted, 1},
    {"Vertex", "x_m", kCoordinate, kRefused},
    {"Vertex", "y_m", kCoordinate, kRefused},

    {"Basis", "modes_x", limits::kModes, kDefaulted, 16},
    {"Basis", "modes_y", limits::kModes, kDefaulted, 16},
    {"Basis", "sobolev_exponent", limits::kSobolevExponent, kDefaulted, 1.5},

    {"Law", "u_max_mps", limits::kSpeed_mps, kRefused},
    {"Law", "epsilon", limits::kEpsilon, kLeft},
    {"Law", "noise_intensity", limits::kIntensity, kLeft},
    {"Law", "noise_ceiling", limits::kIntensity, kLeft},
    {"Law", "contraction_gain_per_s", limits::kContractionGain_per_s, kLeft},
    {"Law", "contraction_x_m", kCoordinate, kLeft},
    {"Law", "contraction_y_m", kCoordinate, kLeft},
    {"Law", "anticipation", limits::kAnticipation, kLeft},

    {"Time", "dt_s", limits::kStep_s, kDefaulted, 0.1},
    {"Time", "duration_s", limits::kDuration_s, kRefused},
    {"Time", "broadcast_period_ticks", limits::kBroadcastPeriod_ticks, kLeft},
    {"Time", "realtime_factor", limits::kRealtimeFactor, kDefaulted, 1},
    {"Time", "lockstep_timeout_s", limits::kTimeout_s, kDefaulted, 10},
    {"Time", "command_hold_s", limits::kCommandHold_s, kDefaulted, 0.5},
    {"Time", "admission_timeout_s", limits::kTimeout_s, kDefaulted, 30},
    {"Time", "catch_up_limit_ticks", limits::kCatchUp_ticks, kDefaulted, 5},

    {"Agents", "random_count", between(0, kMaxAgents), kDefaulted, 0},
    {"Agents", "quorum", limits::kTeam, kLeft},
    {"Agents", "forget_silent_after_s", limits::kForgetting_s, kDefaulted, 0},
    {"Start", "x_m", kCoordinate, kRefused},
    {"Start", "y_m", kCoordinate, kRefused},

    {"World", "disturbance_intensity", limits::kIntensity, kDefaulted, 0},
    {"World", "radio_range_m", limits::kRadioRange_m, kDefaulted, 0},
    {"World", "speed_limit_mps", limits::kSpeedLimit_mps, kLeft},

    {"Scenario", "goal_ergodic_metric", limits::kGoal, kLeft},
};

}  // namespace

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
