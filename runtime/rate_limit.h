// SPDX-License-Identifier: BSD-3-Clause
// How much one agent may say, so that one that babbles does not drown the others.
#pragma once

#include <array>
#include <cstddef>

#include "core/ids.h"
#include "core/mission.h"

namespace ergocast {

/// Messages that one agent may send on all buses together: so many a second and so many a tick, and
/// no more at once than `most`, the backlog of whoever was held up.
struct Allowance {
  double per_second = 0, per_tick = 0, most = 0;
};

/// What the mission asks of an agent at the very most, eight times: its blocks whenever they are due
/// and whenever a tick is repeated, its commands, what it repeats of others, its digests and
/// statuses. Ticks count by themselves, since lockstep has as many a second as the machine can do.
/// @param members  entries of the roster, former members included
Allowance allowance_of(const Mission& mission, std::size_t members);

/// One budget for each agent, that fills as time and ticks go by.
class RateLimit {
 public:
  /// @param tick  the newest that the world is known to have reached
  void allow(const Allowance& allowance, Tick tick) { allowance_ = allowance, tick_ = tick; }

  /// Takes one message off a budget of `from`; false if there is none left. What has been heard
  /// before has a budget of its own: others may repeat it, and not at the cost of who has said it.
  /// Who is no agent has no budget, nor has anybody before allow() was called: all is admitted.
  bool admit(AgentId from, bool is_news, Instant now);

 private:
  struct Budget {
    double left = 0;
    Instant at{};
    Tick tick = 0;
    bool begun = false;
  };
  Allowance allowance_;
  Tick tick_ = 0;
  std::array<std::array<Budget, kMaxAgents>, 2> budgets_{};
};

}  // namespace ergocast
