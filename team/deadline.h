// SPDX-License-Identifier: BSD-3-Clause
// A deadline in wall time and in mission time. A lockstep run passes thousands of mission seconds
// in a wall second. A real-time run may take many wall seconds for a mission second.
#pragma once

#include <algorithm>

#include "core/base/ids.h"

namespace ergocast {

/// Due at `at` or at `tick`, whichever comes first. Due at once if it was never set.
struct Deadline {
  Instant at{};
  Tick tick = 0;

  bool due(Instant now, Tick current) const { return now >= at || current >= tick; }

  /// Sets both: `wall` from `now`, and `mission_s` of mission time, at least one tick.
  static Deadline in(PacingClock::duration wall, Instant now, double mission_s, double dt_s,
                     Tick current) {
    return {now + wall, current + std::max<Tick>(1, static_cast<Tick>(mission_s / dt_s))};
  }
};

}  // namespace ergocast
