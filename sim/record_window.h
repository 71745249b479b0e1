// SPDX-License-Identifier: BSD-3-Clause
// What the logger has of the world's states, and what it may still ask for.
//
// In lockstep the world runs a bounded number of ticks ahead of the record, and repeats the states
// that the logger lacks. A logger that makes no progress for too long is given up.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "team/messages.h"

namespace ergocast {

class RecordWindow {
 public:
  /// From now on the logger may be waited for.
  void start(Instant now) { progress_ = now; }

  /// A fresh word of a logger. A restarted one may have less than its predecessor had.
  void acknowledge(const RecordAck& ack, Instant now);

  /// Whether `tick` may be said: the record is close behind, or its logger is given up, as one is
  /// that was not and that has made no progress for longer than `patience`.
  bool is_close(Tick tick, Instant now, PacingClock::duration patience);
  /// Whether the logger has every row before `tick`.
  bool complete(Tick tick) const { return recorded_ && *recorded_ + 1 >= tick; }
  bool lost() const { return lost_; }
  /// When the record last grew.
  Instant progress() const { return progress_; }

  /// Keeps a tick's states, all parts, for the logger; the oldest go.
  void remember(std::vector<WorldState> states);
  bool empty() const { return history_.empty(); }
  /// The states last remembered. @pre !empty()
  std::vector<WorldState>& newest() { return history_.back(); }
  const std::vector<WorldState>& newest() const { return history_.back(); }

  /// Calls `repeat` with the states before `tick` that the logger lacks, a bounded number of them.
  template <class F>
  void for_each_lacking(Tick tick, const F& repeat) const {
    if (!recorded_) return;
    for (const auto& states : history_) {
      const Tick sent = states.front().header.tick;
      if (sent > *recorded_ && sent <= *recorded_ + kHelpTicks && sent < tick) repeat(states);
    }
  }

 private:
  /// A row needs two states: its tick's, and the next one's, which carries the applied velocity.
  static constexpr Tick kHelpTicks = 16;

  std::optional<Tick> recorded_;  // what the logger has acknowledged
  Incarnation logger_ = 0;
  Instant progress_{};
  bool lost_ = false;
  std::deque<std::vector<WorldState>> history_;
};

}  // namespace ergocast
