// SPDX-License-Identifier: BSD-3-Clause
// Counts the ticks outside of all holds.
#include "core/mission/hold.h"

namespace ergocast {

bool are_holds(std::span<const Hold> holds) {
  Tick before = 0;
  for (const Hold& hold : holds) {
    if (hold.from < before || hold.end() <= hold.from) return false;
    before = hold.end();
  }
  return holds.size() <= kMaxHolds;
}

bool is_held(std::span<const Hold> holds, Tick tick) {
  return std::ranges::any_of(
      holds, [tick](const Hold& hold) { return hold.from <= tick && tick < hold.end(); });
}

Tick counted_ticks(std::span<const Hold> holds, Tick tick) {
  Tick held = 0;
  for (const Hold& hold : holds) {
    if (hold.from < tick) held += std::min(tick, hold.end()) - hold.from;
  }
  return tick - held;
}

Tick tick_after(std::span<const Hold> holds, Tick count) {
  Tick tick = count;
  for (const Hold& hold : holds) {
    // A hold from the mission's end on never begins.
    if (hold.from >= tick) break;
    if (hold.open()) return hold.end();
    tick += hold.until - hold.from;
  }
  return tick;
}

std::vector<RosterEntry> in_counted_ticks(std::vector<RosterEntry> roster,
                                          std::span<const Hold> holds) {
  if (holds.empty()) return roster;
  for (RosterEntry& entry : roster) {
    entry.active_from = counted_ticks(holds, entry.active_from);
    if (entry.active_until >= 0) entry.active_until = counted_ticks(holds, entry.active_until);
  }
  return roster;
}

}  // namespace ergocast
