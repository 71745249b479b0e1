// SPDX-License-Identifier: BSD-3-Clause
// The limits of a mission, which docs/reference/scenario.md prints. plan/mission_fields.h gives
// each field its own. scenario/ checks what people write against them and names what breaks them;
// plan/plan.cc checks what comes from the network.
#pragma once

#include <string_view>

#include "core/base/ids.h"
#include "core/mission/law_change.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Numbers allowed for a field; nan never is.
struct Limits {
  double low, high;
  bool low_excluded = false;

  constexpr bool contain(double value) const {
    return (low_excluded ? value > low : value >= low) && value <= high;
  }
};

namespace limits {

constexpr Limits between(double low, double high) { return {low, high, false}; }
constexpr Limits above(double low, double high) { return {low, high, true}; }

/// Far beyond any domain: keeps sums and squares of coordinates finite and exact enough.
inline constexpr Limits kCoordinate_m = between(-1e13, 1e13);
inline constexpr Limits kSize_m = between(1e-3, 1e7);
/// How far from 0 the domain may begin, as a multiple of its size.
/// Limit (Scenario): distance of the domain from 0 along an axis, `Domain.origin_x_m`,
/// `Domain.origin_y_m`, `Domain.origin_z_m` [times its size]. Beyond it: the scenario is refused.
inline constexpr double kMaxOriginPerSize = 1e5;
inline constexpr Limits kModes = between(1, kMaxModesPerAxis);
inline constexpr Limits kIntensity = between(0, 1e6);  ///< of any noise [m/√s]
inline constexpr Limits kTimeout_s = above(0, 86400);
inline constexpr Limits kDuration_s = above(0, 1e7);
/// Limit (Time): steps of a mission. Beyond it: the scenario is refused.
inline constexpr double kMaxTicks = 1e8;
/// The least law.memory_half_life_s other than 0 [steps].
inline constexpr double kLeastHalfLife_ticks = 10;
/// Ticks between two broadcasts of any block.
inline constexpr Limits kPeriod_ticks = between(1, 1000);
/// In real time, the least wall time of a step.
/// Limit (Time): length of a step by the wall clock in real time, at least [s]. Below it: the
/// scenario is refused.
inline constexpr double kMinWallStep_s = 1e-4;
/// Without sites at most kMaxAgents.
inline constexpr Limits kTeam = between(1, kMostAgentsOfSites);
inline constexpr Limits kWaveNumber = between(0, 1000);  ///< |k|, a band's ends

}  // namespace limits

/// Limit (Scenario): length of a name, `Scenario.name` [characters]. Beyond it: the scenario is
/// refused.
inline constexpr int kMaxNameLength = 64;
/// Limit (Scenario): length of the name of a kind, `Kind.name` [characters]. Beyond it: the
/// scenario is refused.
inline constexpr int kMaxKindNameLength = 31;
/// Limit (Scenario): kinds of agents, `Agents.kind`. Beyond it: the scenario is refused.
inline constexpr int kMaxKinds = 16;

/// Whether `name` is 1 to kMaxNameLength letters, digits, '_', '-' or '.', the first of them not
/// '-' or '.': missions' names become names of folders.
bool is_name(std::string_view name);

/// Whether `name` is such a name of at most kMaxKindNameLength characters.
bool is_kind_name(std::string_view name);

/// Whether a mission with these steps can have so many ticks.
bool is_tick_count(Tick tick_count, Timing timing);

/// Whether a mission can have another law: bounded_by_plan(), and a scenario with these numbers in
/// the place of its own would be within limits.
bool is_law(const LawChange& change, const Mission& mission);

/// How long the mission lasts: tick_count · dt_s, but no more than a scenario may set [s].
double duration_s(const Timing& timing);

/// Whether a scenario can describe `mission`: each number is within its limits, and related numbers
/// fit together. μ is finite, |μ| ≤ 1 up to rounding, and μ_00 = 1.
bool within_limits(const Mission& mission);

}  // namespace ergocast
