// SPDX-License-Identifier: BSD-3-Clause
// Doubles the period of repeats, and drops ticks that are too late.
#include "sim/tick_schedule.h"

#include <algorithm>

namespace ergocast {

void TickSchedule::note_published(Instant now, PacingClock::duration least) {
  published_ = true;
  repeat_period_ = kRepeatPeriod;
  next_publish_ = now + repeat_period_;
  held_until_ = now + least;
}

void TickSchedule::note_repeat(Instant now) {
  repeat_period_ = std::min(2 * repeat_period_, kLongestRepeatPeriod);
  next_publish_ = now + repeat_period_;
}

std::int64_t TickSchedule::drop_late_ticks(Instant now, PacingClock::duration period, int limit) {
  const std::int64_t late = (now - next_tick_) / period;
  if (late <= limit) return 0;
  next_tick_ += (late - limit) * period;
  return late - limit;
}

}  // namespace ergocast
