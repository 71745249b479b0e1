// SPDX-License-Identifier: BSD-3-Clause
// Decides by its tick, without a common clock, whether an operator's command is recent enough.
//
// The signature of STOP, PAUSE or RECALL never expires. So an outsider could record a command that
// no process obeyed, and send it again at a chosen moment. A command therefore names the newest
// tick that its sender knew. A receiver refuses it if it already knew a later tick some time ago,
// by its own clock. The alternative, a time of day in the command, would need hosts with equal
// clocks.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "core/base/ids.h"

namespace ergocast {

class CommandWindow {
 public:
  /// A command is obeyed for at least so long after its tick has passed, and at most for twice as
  /// long.
  /// Limit (Time): age up to which a STOP, PAUSE or RECALL of an operator is obeyed [s]. Beyond it:
  /// it may be refused with `late`; after twice this time it always is.
  static constexpr std::chrono::seconds kLength{5};

  /// The receiver knows at `now` that the mission has reached `tick`. Before it takes part, it may
  /// know only old ticks. Then a command must name the newest of these or a later one.
  /// @param takes_part  whether it has sent a tick of its own
  void note(Tick tick, bool takes_part, Instant now) {
    newest_ = std::max(newest_, tick);
    if (!since_) {
      oldest_ = next_oldest_ = newest_;
      if (takes_part) since_ = now;
    } else if (now - *since_ >= kLength) {
      oldest_ = next_oldest_;
      next_oldest_ = newest_;
      since_ = now;
    }
  }

  /// Whether a command that names `tick` is recent.
  bool admits(Tick tick) const { return tick >= oldest_; }

  /// Whether another process of this host may have received `tick` before us: it is at most as far
  /// ahead as the mission has gone in the window.
  bool foresees(Tick tick) const {
    return tick <= newest_ + std::max(kLeastAhead, newest_ - oldest_);
  }

 private:
  /// At the beginning the window is empty.
  /// Limit (Page): ticks by which the page of an operator may always be ahead of the process that
  /// gives the orders. Beyond it: a request is refused, unless the mission has gone as far in the
  /// last seconds.
  static constexpr Tick kLeastAhead = 1000;

  Tick newest_ = -1;
  Tick oldest_ = -1;              // the oldest that is admitted
  Tick next_oldest_ = -1;         // the newest at since_
  std::optional<Instant> since_;  // the window began to move
};

}  // namespace ergocast
