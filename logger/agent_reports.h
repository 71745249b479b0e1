// SPDX-License-Identifier: BSD-3-Clause
// What the agents report of themselves, as the record uses it.
#pragma once

#include <map>

#include "core/base/ids.h"
#include "team/messages.h"
#include "team/mission_follower.h"

namespace ergocast {

/// The cost of the distance that bodies keep, from the newest status of each incarnation.
struct Blocks {
  double share = 0;        ///< the blocked part of all agents' answered ticks
  Tick longest_ticks = 0;  ///< in a row
};

class AgentReports {
 public:
  /// @pre no later status of its sender has arrived
  void take(const AgentStatus& status);

  /// The newest status of each incarnation, with the worst loop lag of all its statuses.
  const std::map<Author, AgentStatus>& statuses() const { return statuses_; }
  /// Whether an incarnation has reported that it has finished.
  bool finished(const Author& author) const;
  Blocks blocks(const MissionFollower& follower) const;

 private:
  std::map<Author, AgentStatus> statuses_;
};

}  // namespace ergocast
