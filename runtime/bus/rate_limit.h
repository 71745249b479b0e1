// SPDX-License-Identifier: BSD-3-Clause
// Limits the messages of each agent, so that one faulty agent does not block the others.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// The rate budget of one agent on all buses together: messages a second, and messages a tick.
/// `most` limits the unused budget; it is large enough for the backlog of a delayed process.
struct RateBudget {
  double per_second = 0, per_tick = 0, most = 0;
};

/// Eight times the most that the mission needs of an agent. These are its blocks when they are due
/// and when a tick is repeated, and its commands, relayed blocks, digests and statuses. Ticks count
/// separately, because lockstep has as many a second as the machine can compute.
/// @param members  entries of the roster, former members included
RateBudget rate_budget_of(const Mission& mission, std::size_t members);

/// One budget for each agent, refilled by time and ticks.
class RateLimit {
 public:
  /// @param tick  the newest tick that the world is known to have reached
  void allow(const RateBudget& rate_budget, Tick tick) { rate_budget_ = rate_budget, tick_ = tick; }

  /// Takes one message off a budget of `from`; false if the budget is empty. Repeats have a
  /// separate budget, because other processes may send them. Processes other than agents have no
  /// limit, and before allow() there is none.
  bool admit(AgentId from, bool is_new, Instant now);

 private:
  struct Budget {
    double left = 0;
    Instant at{};
    Tick tick = 0;
    bool begun = false;
  };
  RateBudget rate_budget_;
  Tick tick_ = 0;
  std::array<std::array<Budget, kMaxAgents>, 2> budgets_{};
};

}  // namespace ergocast
