// SPDX-License-Identifier: BSD-3-Clause
// One mission under faults, checked against all invariants.
//
// The first Faults::lasting_share of the mission is the safety half. Then all is healed at once:
// faults off, crashed processes started, links whole (clocks stay skewed); the rest is the liveness
// half.
#pragma once

#include <cstdint>
#include <optional>
#include <ostream>

#include "lab/invariants.h"
#include "lab/simulation.h"

namespace ergocast::lab {

/// The results of a trial in numbers only, because they pass between processes as they are.
struct TrialFigures : SimulationCounts {
  std::uint64_t seed = 0;
  double virtual_s = 0;
  double ergodic_metric = 0;  ///< φ² at the end, by the observer
  double view_error = 0;      ///< max_a √(Σ λ (c_a − c_true)²) at the end
  std::int64_t agent_steps = 0, evictions = 0, held_ticks = 0;
  /// From the restart of an agent until it again holds everything that its predecessors had sent to
  /// any process.
  double recovery_mean_s = 0, recovery_max_s = 0;
  std::int64_t recoveries = 0;
};

struct TrialResult {
  TrialFigures figures;
  std::optional<Violation> violation;
  /// Lockstep: the coordinator ended the mission because a process was away for longer than
  /// lockstep_timeout_s. This is no violation: the time-out has this purpose.
  bool timed_out = false;
};

/// Simulates `options` with a latency of its own.
/// @param trajectory, metrics  what the recorder writes
/// @pre options.plan decodes, and both streams are good.
TrialResult run_trial(SimulationOptions options, std::ostream& trajectory, std::ostream& metrics);

}  // namespace ergocast::lab
