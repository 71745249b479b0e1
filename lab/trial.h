// SPDX-License-Identifier: BSD-3-Clause
// One mission under faults: the real cores and the real codec, each process with a clock of its
// own, in virtual time. Everything follows from the plan, the faults and one seed.
//
// The first Faults::lasting_share of the mission is the safety half. Then all is healed at once: faults off,
// crashed processes started, links whole (clocks stay skewed); the rest is the liveness half.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "agent/agent.h"
#include "coordinator/coordinator.h"
#include "team/subscriptions.h"
#include "lab/faults.h"
#include "lab/invariants.h"
#include "lab/network.h"
#include "logger/recorder.h"
#include "sim/world.h"

namespace ergocast::lab {

struct TrialOptions {
  std::vector<std::byte> plan;  ///< compiled; its seed is the trial's
  Faults faults;
  std::string version;
  SubscriptionTable subscriptions = kSubscriptions;  ///< what tests take away is not heard
};

/// What a trial was like, in numbers only: it passes between processes as it is.
struct TrialFigures {
  std::uint64_t seed = 0;
  double virtual_s = 0;
  double ergodic_metric = 0;  ///< φ² at the end, by the observer
  double view_error = 0;      ///< max_a √(Σ λ (c_a − c_true)²) at the end
  std::int64_t agent_steps = 0, messages = 0, contributions = 0, digests = 0, relayed = 0;
  MessageFaults faults;
  std::int64_t splits = 0, one_way_cuts = 0;
  std::int64_t agent_crashes = 0, coordinator_crashes = 0, world_crashes = 0, skewed_clocks = 0;
  std::int64_t evictions = 0;
  /// From the restart of an agent until it holds again all that its predecessors had told anybody.
  double recovery_mean_s = 0, recovery_max_s = 0;
  std::int64_t recoveries = 0;
};

struct TrialResult {
  TrialFigures figures;
  std::optional<Violation> violation;
  /// Lockstep: the mission was ended by the coordinator because somebody was away for longer than
  /// lockstep_timeout_s. No violation: that is what a time-out is for.
  bool timed_out = false;
};

/// @param trajectory, metrics  what the recorder writes
/// @pre options.plan decodes, and both streams are good.
TrialResult fly_trial(const TrialOptions& options, std::ostream& trajectory, std::ostream& metrics);

}  // namespace ergocast::lab
