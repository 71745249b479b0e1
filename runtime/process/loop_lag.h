// SPDX-License-Identifier: BSD-3-Clause
// The delay of an event loop: a machine that is too slow, or a suspended process, shows in it.
#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/ids.h"

namespace ergocast {

class LoopLag {
 public:
  /// The loop woke up at `now`; its work was due at `planned`.
  void woke(Instant planned, Instant now) {
    woke_ = now;
    worst_ = std::max(worst_, now - planned);
  }
  /// The loop has done its work. Since it woke up, it received nothing new.
  void done(Instant now) { worst_ = std::max(worst_, now - woke_); }

  /// The longest delay or working time since the last call [s].
  double take_s() {
    return std::chrono::duration<double>(std::exchange(worst_, PacingClock::duration(0))).count();
  }

 private:
  Instant woke_{};
  PacingClock::duration worst_{0};
};

}  // namespace ergocast
