// SPDX-License-Identifier: BSD-3-Clause
// The members of the team, and from which tick on their coverage counts.
#pragma once

#include <cstdint>

#include "core/base/ids.h"

namespace ergocast {

struct RosterEntry {
  Author author;
  Tick active_from = 0;
  Tick active_until = -1;           ///< first tick without it; −1 while it is a member
  bool forgotten = false;           ///< whether its coverage stops counting, or counts again, …
  Tick since_tick = 0;              ///< … from this tick on, …
  std::int64_t since_revision = 0;  ///< … once the world uses this revision or a later one
  int kind = 0;                     ///< of core/mission/kinds.h
  bool active_at(Tick tick) const {
    return tick >= active_from && (active_until < 0 || tick < active_until);
  }
  /// Whether its coverage does not count at a tick for which the world uses roster `revision`. All
  /// agents that receive the world's messages agree on it, even if some know a newer roster.
  bool forgotten_at(Tick tick, std::int64_t revision) const {
    return forgotten == (tick >= since_tick && revision >= since_revision);
  }
};

}  // namespace ergocast
