// SPDX-License-Identifier: BSD-3-Clause
// How late or deaf an event loop was: what a machine that is too slow, or a process that stood
// still, looks like from inside.
#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/ids.h"

namespace ergocast {

class LoopLag {
 public:
  /// The loop woke up at `now`, having had work to do at `planned`.
  void woke(Instant planned, Instant now) {
    woke_ = now;
    worst_ = std::max(worst_, now - planned);
  }
  /// It has done what there was to do: until now it heard nothing new.
  void done(Instant now) { worst_ = std::max(worst_, now - woke_); }

  /// The worst of either since the last call [s].
  double take_s() {
    return std::chrono::duration<double>(std::exchange(worst_, PacingClock::duration(0))).count();
  }

 private:
  Instant woke_{};
  PacingClock::duration worst_{0};
};

}  // namespace ergocast
