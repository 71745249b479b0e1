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

/// The ticks `from`, …, `until` − 1 do not count.
struct Hold {
  Tick from = 0;
  Tick until = -1;  ///< −1: not announced yet

  bool open() const { return until < 0; }
  /// The first tick after the hold; the greatest number while the hold is open.
  Tick end() const { return open() ? std::numeric_limits<Tick>::max() : until; }
  bool operator==(const Hold&) const = default;
};

/// The greatest number of holds of a mission. Each one is sent in a part of MISSION.
/// Limit (Team): pauses of a mission. Beyond it: `ergocast pause` ends with code 4.
inline constexpr std::size_t kMaxHolds = 32;

/// Whether there are at most kMaxHolds, each ends after it begins, and none begins before the
/// previous one has ended. Only the last may lack an end.
bool are_holds(std::span<const Hold> holds);

// ---- for holds that satisfy are_holds() ----

bool is_held(std::span<const Hold> holds, Tick tick);

/// How many of the ticks before `tick` count. If `tick` itself counts, this is its number among
/// those that count. −1 stays −1.
Tick counted_ticks(std::span<const Hold> holds, Tick tick);

/// The first tick before which `count` ticks count. The greatest number if that depends on a hold
/// without an end.
/// @pre count ≥ 0
Tick tick_after(std::span<const Hold> holds, Tick count);

/// Whether the last hold has no end yet.
inline bool is_open(std::span<const Hold> holds) { return !holds.empty() && holds.back().open(); }

/// How many beginnings and ends of holds are announced. The number is odd while the last hold has
/// no end: the mission is paused, or will be.
inline int named_changes(std::span<const Hold> holds) {
  return 2 * static_cast<int>(holds.size()) - (is_open(holds) ? 1 : 0);
}

/// The roster with numbers of counted ticks in place of the world's ticks. An entry is active at
/// the number of a tick that counts if it is active at that tick.
std::vector<RosterEntry> in_counted_ticks(std::vector<RosterEntry> roster,
                                          std::span<const Hold> holds);

}  // namespace ergocast
