// SPDX-License-Identifier: BSD-3-Clause
// The results of one mission in numbers.
//
// The mission's ticks are n = 0 … tick_count − 1, at t = n·dt; φ² at tick n counts the samples of
// ticks 0 … n, as in metrics.csv. Positions are those at the ticks. φ² is in cosines, also for a
// mission that steers by the modes of its free domain. So all missions of a study can be compared.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/base/ids.h"
#include "core/law/law.h"
#include "core/mission/mission.h"
#include "team/mission_follower.h"

namespace ergocast::studies {

/// Limit (Studies): columns of φ² over time in `study.csv`, ten in a decade from 1 s on. Beyond
/// it: later times have none.
inline constexpr std::size_t kLadderTimes = 71;
/// Ten a decade (Renard's R10: 1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.3, 8, 10 …) up to 10⁷.
constexpr std::array<double, kLadderTimes> times_to_note_s() {
  constexpr double kDecade[] = {1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.3, 8};
  std::array<double, kLadderTimes> times{};
  double power = 1;
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = kDecade[i % 10] * power;
    if (i % 10 == 9) power *= 10;
  }
  return times;
}

/// Times at which φ² is noted, as far as a mission goes.
inline constexpr std::array<double, kLadderTimes> kLadder_s = times_to_note_s();

/// Closer to an edge than this share of the domain's shorter side counts as at the edge.
inline constexpr double kAtEdgeShare = 1e-3;

/// The figures of one mission, which pass between processes as they are. What does not exist is
/// nan.
struct StudyFigures {
  std::uint64_t seed = 0;
  std::int32_t agents = 0;
  bool complete = false;                           ///< the mission came to its last tick
  std::array<double, kLadder_s.size()> metric_at;  ///< φ² at the first tick with t ≥ kLadder_s
  double metric = 0;                               ///< φ² at the last tick
  /// The power of t that fits φ² over the last decade of time (logger/slope.h), by 21 ticks
  /// evenly spaced in log t.
  double slope = 0;
  /// When each agent was first farther than escape_distance_m() from the manifold_at() its start:
  /// infinite if it never was, nan if the start lies on none.
  std::array<double, kMaxAgents> escape_time_s;
  /// ‖x − centre of contraction‖², over all agents and ticks.
  double offset2_mean_m2 = 0, offset2_max_m2 = 0;
  // What users ask for, core/measure/team_measures.h. A time that never came is infinite.
  double detection_probability = 0, half_time_s = 0, four_fifths_time_s = 0;
  double greatest_age_s = 0, wasserstein_m = 0, path_m = 0;
  /// Figures of the mission's objects; nan if it has none. The time is infinite if none was found.
  double objects_found = 0, first_find_time_s = 0;
  double wrong_confirmations = 0;  ///< core/search/confirmations.h; nan without false alarms
  double edge_share = 0;           ///< share of all agents' ticks at an edge
  double speed_mean_mps = 0;       ///< of the vehicles: their commands within the speed limit
  std::int64_t messages = 0;       ///< contributions sent, including those repeated for others
};

/// Runs the mission of a compiled plan. It runs without messages where the result is the same
/// (IdealTeam), else with the real cores and codec in virtual time (Simulation), for either pace.
/// @param laws  makes the agents' laws
/// @pre the plan decodes
StudyFigures run_study_mission(std::span<const std::byte> plan);
StudyFigures run_study_mission(std::span<const std::byte> plan, const LawMaker& laws);

/// The two ways to run a mission. They agree on every mission that IdealTeam stands for.
StudyFigures run_without_messages(const Mission& mission, const LawMaker& laws = make_law);
StudyFigures run_with_messages(std::span<const std::byte> plan, const LawMaker& laws = make_law);

/// Why no law in Python can steer the mission, with the remedy; nothing if one can. Every agent has
/// to receive the places of all others at each tick.
std::optional<std::string> why_not_in_python(const Mission& mission);

}  // namespace ergocast::studies
