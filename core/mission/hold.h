// SPDX-License-Identifier: BSD-3-Clause
// Ticks that do not count, because the mission is paused.
//
// The world's ticks go on while a mission is paused. Everything that depends on mission time uses
// the number of ticks that count: coverage, forecasts, broadcasts, ages, noise of the law, the end.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/roster.h"

namespace ergocast {

/// The ticks from … until − 1 do not count.
struct Hold {
  Tick from = 0;
  Tick until = -1;  ///< −1: not named yet

  bool open() const { return until < 0; }
  /// The first tick after it; the greatest number while it is open.
  Tick end() const { return open() ? std::numeric_limits<Tick>::max() : until; }
  bool operator==(const Hold&) const = default;
};

/// The most holds of a mission: each travels in a part of MISSION.
/// Limit (Team): pauses of a mission. Beyond it: `ergocast pause` ends with code 4.
inline constexpr std::size_t kMaxHolds = 32;

/// Whether each hold ends after it begins, none begins before the previous one has ended, only the
/// last has no end, and there are at most kMaxHolds.
bool are_holds(std::span<const Hold> holds);

// ---- for holds that satisfy are_holds() ----

bool is_held(std::span<const Hold> holds, Tick tick);

/// How many of the ticks before `tick` count: the number of `tick` itself if it does. −1 stays −1.
Tick counted_ticks(std::span<const Hold> holds, Tick tick);

/// The first tick before which `count` ticks count; the greatest number while that is open.
/// @pre count ≥ 0
Tick tick_after(std::span<const Hold> holds, Tick count);

/// Whether the last one has no end yet.
inline bool is_open(std::span<const Hold> holds) { return !holds.empty() && holds.back().open(); }

/// How many ends of holds are named: an odd number while the mission is paused, or will be.
inline int named_changes(std::span<const Hold> holds) {
  return 2 * static_cast<int>(holds.size()) - (is_open(holds) ? 1 : 0);
}

/// The roster with ticks that count: an entry is active at the count of a tick that counts if it is
/// active at that tick.
std::vector<RosterEntry> in_counted_ticks(std::vector<RosterEntry> roster,
                                          std::span<const Hold> holds);

}  // namespace ergocast
