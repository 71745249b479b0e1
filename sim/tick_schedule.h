// SPDX-License-Identifier: BSD-3-Clause
// When the world publishes or repeats a state, and when the next tick may come.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "core/base/ids.h"

namespace ergocast {

class TickSchedule {
 public:
  /// An unanswered tick is repeated after this time, then after twice as long each time. So a loss
  /// is repaired soon, and a slow team does not receive too many repeats.
  static constexpr std::chrono::nanoseconds kRepeatPeriod = std::chrono::milliseconds(20);
  static constexpr std::chrono::nanoseconds kLongestRepeatPeriod = std::chrono::milliseconds(100);

  void begin(Instant now) { next_tick_ = now; }

  // ---- publishing ----

  /// The present tick is published for the first time. It lasts at least for `least`.
  void note_published(Instant now, PacingClock::duration least);
  /// The present tick is published again.
  void note_repeat(Instant now);
  /// A new tick has come, which is not published yet.
  void note_step() { published_ = false; }
  /// Whether the present tick is published.
  bool published() const { return published_; }
  bool repeat_due(Instant now) const { return now >= next_publish_; }
  Instant next_publish() const { return next_publish_; }
  /// Whether the present tick must last longer.
  bool held(Instant now) const { return now < held_until_; }
  /// No repeat is needed while it is held.
  void publish_after_hold() { next_publish_ = std::max(next_publish_, held_until_); }

  // ---- ticks by the clock ----

  Instant next_tick() const { return next_tick_; }
  void set_next_tick(Instant at) { next_tick_ = at; }
  /// Drops the late ticks beyond `limit`, and returns how many these are.
  std::int64_t drop_late_ticks(Instant now, PacingClock::duration period, int limit);

 private:
  Instant next_publish_{}, next_tick_{}, held_until_{};
  std::chrono::nanoseconds repeat_period_ = kRepeatPeriod;
  bool published_ = false;
};

}  // namespace ergocast
