// SPDX-License-Identifier: BSD-3-Clause
// The members of the team, and from which tick on their coverage counts.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

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
  /// The operator has sent it home, and it rests there once the world uses this revision or a later
  /// one; −1: it was not sent home.
  std::int64_t recall_revision = -1;
  bool leaves = false;  ///< it was sent out of the mission; then it is also recalled
  bool active_at(Tick tick) const {
    return tick >= active_from && (active_until < 0 || tick < active_until);
  }
  bool recalled() const { return recall_revision >= 0; }
  /// Whether it rests at a tick for which the world uses roster `revision`: it covers and
  /// broadcasts no more, and no teammate forecasts it. Its coverage still counts.
  bool recalled_at(std::int64_t revision) const {
    return recalled() && revision >= recall_revision;
  }
  /// Whether its coverage does not count at a tick for which the world uses roster `revision`. All
  /// agents that receive the world's messages agree on it, even if some know a newer roster.
  bool forgotten_at(Tick tick, std::int64_t revision) const {
    return forgotten == (tick >= since_tick && revision >= since_revision);
  }
};

/// The entries of all incarnations under a number.
/// @param roster  in ascending order of authors
inline std::span<const RosterEntry> entries_of(AgentId id, std::span<const RosterEntry> roster) {
  const auto is_before = [](const RosterEntry& entry, AgentId number) {
    return entry.author.agent < number;
  };
  const auto first = std::lower_bound(roster.begin(), roster.end(), id, is_before);
  const auto last = std::upper_bound(
      first, roster.end(), id,
      [](AgentId number, const RosterEntry& entry) { return number < entry.author.agent; });
  return roster.subspan(static_cast<std::size_t>(first - roster.begin()),
                        static_cast<std::size_t>(last - first));
}

}  // namespace ergocast
