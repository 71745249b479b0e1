// SPDX-License-Identifier: BSD-3-Clause
// Which of the world's states the logger has, and which it may still need.
//
// In lockstep the world runs a bounded number of ticks ahead of the record. It repeats the states
// that the logger lacks. A logger that makes no progress for too long is given up.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "team/messages.h"

namespace ergocast {

class RecordWindow {
 public:
  /// From now on the logger may be waited for.
  void start(Instant now) { progress_ = now; }

  /// Takes in a logger's acknowledgement. A restarted logger may have less than its predecessor
  /// had.
  void acknowledge(const RecordAck& ack, Instant now);

  /// Whether the world may publish `tick`: the record is close behind, or the logger is given up.
  /// It is given up here if it has made no progress for longer than `patience`. A restarted world
  /// may always publish its first state, and a logger whose files were damaged goes on from there:
  /// nothing repeats the states before.
  bool is_close(Tick tick, Instant now, PacingClock::duration patience);
  /// Whether the logger has every row before `tick`.
  bool complete(Tick tick) const { return recorded_ && *recorded_ + 1 >= tick; }
  bool lost() const { return lost_; }
  /// When the record last grew.
  Instant progress() const { return progress_; }

  /// Keeps all parts of a tick's state for the logger, and drops the oldest.
  void remember(std::vector<WorldState> states);
  bool empty() const { return history_.empty(); }
  /// The states last remembered. @pre !empty()
  std::vector<WorldState>& newest() { return history_.back(); }
  const std::vector<WorldState>& newest() const { return history_.back(); }

  /// Calls `repeat` with states before `tick` that the logger lacks: a bounded number of them.
  template <class F>
  void for_each_lacking(Tick tick, const F& repeat) const {
    if (!recorded_) return;
    for (const auto& states : history_) {
      const Tick sent = states.front().header.tick;
      if (sent > *recorded_ && sent <= *recorded_ + kHelpTicks && sent < tick) repeat(states);
    }
  }

 private:
  /// A row needs two states: its tick's, and the next one, which carries the applied velocity.
  static constexpr Tick kHelpTicks = 16;

  std::optional<Tick> recorded_;  // what the logger has acknowledged
  Incarnation logger_ = 0;
  Instant progress_{};
  bool lost_ = false;
  std::deque<std::vector<WorldState>> history_;
};

}  // namespace ergocast
