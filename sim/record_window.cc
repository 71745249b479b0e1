// SPDX-License-Identifier: BSD-3-Clause
// Follows what the logger acknowledges, and keeps the states that it may still lack.
#include "sim/record_window.h"

#include <utility>

namespace ergocast {

void RecordWindow::acknowledge(const RecordAck& ack, Instant now) {
  const bool same_logger = ack.header.incarnation == logger_;
  if (recorded_ && same_logger && ack.header.tick <= *recorded_) return;
  lost_ = lost_ && same_logger;
  logger_ = ack.header.incarnation;
  recorded_ = ack.header.tick;
  progress_ = now;
}

bool RecordWindow::is_close(Tick tick, Instant now, PacingClock::duration patience) {
  if (lost_) return true;
  if (recorded_ && (history_.empty() || tick - *recorded_ <= kRecordWindowTicks)) return true;
  lost_ = now - progress_ > patience;
  return lost_;
}

void RecordWindow::remember(std::vector<WorldState> states) {
  history_.push_back(std::move(states));
  if (history_.size() > static_cast<std::size_t>(kRecordWindowTicks) + 2) history_.pop_front();
}

}  // namespace ergocast
