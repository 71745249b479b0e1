// SPDX-License-Identifier: BSD-3-Clause
// Derives the budget of a message rate from the mission, and refills it by seconds and by ticks of
// the world.
#include "runtime/bus/rate_limit.h"

#include <algorithm>
#include <chrono>

#include "core/law/block_layout.h"
#include "team/messages.h"

namespace ergocast {
namespace {

/// Limit (Network): messages of one sender [times what the mission asks for]. Beyond it: they are
/// refused with `rate`.
constexpr double kMargin = 8;
/// How often the world repeats a tick at most. All agents then repeat their messages. In real time
/// the world repeats no tick, but the network may.
constexpr double kLockstepRepeatsPerSecond = 50, kRealtimeRepeatsPerSecond = 5;
/// Statuses, digests and answers to a world, in addition to those of mission time.
constexpr double kOthersPerSecond = 40;
/// The most messages of one agent that may wait for a delayed process; the kernel's buffers hold
/// fewer.
constexpr double kBacklog_s = 10, kBacklogTicks = 100, kBacklogMessages = 2000;

}  // namespace

RateBudget rate_budget_of(const Mission& mission, std::size_t members) {
  const Timing& timing = mission.timing;
  const double blocks = block_count_of(mission);
  const double repeats =
      timing.pace == Pace::kLockstep ? kLockstepRepeatsPerSecond : kRealtimeRepeatsPerSecond;
  const double relayed = static_cast<double>(members) * blocks;
  RateBudget rate_budget;
  rate_budget.per_tick = kMargin * (blocks / timing.broadcast_period_ticks + 1 +
                                    (2 + relayed) * std::min(1.0, timing.dt_s));
  rate_budget.per_second = kMargin * (repeats * (blocks + 1) + relayed + kOthersPerSecond);
  rate_budget.most =
      kBacklog_s * rate_budget.per_second + kBacklogTicks * rate_budget.per_tick + kBacklogMessages;
  return rate_budget;
}

bool RateLimit::admit(AgentId from, bool is_new, Instant now) {
  if (rate_budget_.most == 0 || from < 0 || from >= kMaxAgents) return true;
  Budget& budget = budgets_[is_new ? 1 : 0][static_cast<std::size_t>(from)];
  const double waited_s = std::chrono::duration<double>(now - budget.at).count();
  const auto ticks = static_cast<double>(std::max<Tick>(0, tick_ - budget.tick));
  budget.left = budget.begun
                    ? std::min(rate_budget_.most, budget.left + waited_s * rate_budget_.per_second +
                                                      ticks * rate_budget_.per_tick)
                    : rate_budget_.most;
  budget = {budget.left, now, std::max(budget.tick, tick_), true};
  if (budget.left < 1) return false;
  budget.left -= 1;
  return true;
}

}  // namespace ergocast
