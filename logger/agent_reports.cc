// SPDX-License-Identifier: BSD-3-Clause
// Keeps the newest status of each incarnation, and sums up their blocks.
#include "logger/agent_reports.h"

#include <algorithm>

namespace ergocast {

void AgentReports::take(const AgentStatus& status) {
  AgentStatus& latest = statuses_[{status.header.sender, status.header.incarnation}];
  const double worst_lag_s = std::max(latest.loop_lag_s, status.loop_lag_s);
  latest = status;
  latest.loop_lag_s = worst_lag_s;
}

bool AgentReports::finished(const Author& author) const {
  const auto status = statuses_.find(author);
  return status != statuses_.end() && status->second.phase == AgentPhase::kFinished;
}

Blocks AgentReports::blocks(const MissionFollower& follower) const {
  std::int64_t blocked = 0, answered = 0;
  Blocks blocks;
  for (const auto& [author, status] : statuses_) {
    const RosterEntry* entry = follower.entry_of(author.incarnation);
    const Tick from = entry == nullptr ? 0 : entry->active_from;
    answered += std::max<std::int64_t>(0, status.answered_tick + 1 - from);
    blocked += status.blocked_ticks;
    blocks.longest_ticks = std::max(blocks.longest_ticks, status.longest_block_ticks);
  }
  if (answered > 0) blocks.share = static_cast<double>(blocked) / static_cast<double>(answered);
  return blocks;
}

}  // namespace ergocast
