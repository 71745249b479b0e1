// SPDX-License-Identifier: BSD-3-Clause
// One mission under faults, held against all invariants.
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

/// What a trial was like, in numbers only: it passes between processes as it is.
struct TrialFigures : SimulationCounts {
  std::uint64_t seed = 0;
  double virtual_s = 0;
  double ergodic_metric = 0;  ///< φ² at the end, by the observer
  double view_error = 0;      ///< max_a √(Σ λ (c_a − c_true)²) at the end
  std::int64_t agent_steps = 0, evictions = 0, held_ticks = 0;
  /// From the restart of an agent until it holds again all that its predecessors had told anybody.
  double recovery_mean_s = 0, recovery_max_s = 0;
  std::int64_t recoveries = 0;
};

struct TrialResult {
  TrialFigures figures;
  std::optional<Violation> violation;
  /// Lockstep: the mission was ended by the coordinator because a process was away for longer than
  /// lockstep_timeout_s. No violation: that is what a time-out is for.
  bool timed_out = false;
};

/// Simulates `options` with a latency of its own.
/// @param trajectory, metrics  what the recorder writes
/// @pre options.plan decodes, and both streams are good.
TrialResult run_trial(SimulationOptions options, std::ostream& trajectory, std::ostream& metrics);

}  // namespace ergocast::lab
