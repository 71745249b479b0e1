// SPDX-License-Identifier: BSD-3-Clause
// How old what an autopilot has measured can be, without a common clock.
//
// We ask at our time s, and the autopilot answers with its clock r (TIMESYNC). The answer was made
// after the question, so our time at its clock r was s or later. What it measured at its clock b
// was then measured at s + (b − r) or later, up to the drift of the clocks. The best bound is that
// of the quickest of the last answers.
#pragma once

#include <ergocast/core/base/ids.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "bridges/mavlink/messages.h"

namespace ergocast::mavlink {

class ClockBond {
 public:
  /// The question to send now.
  Timesync ask(Instant now) {
    asked_[next_asked_++ % asked_.size()] = now;
    Timesync question;
    question.ts1 = now.time_since_epoch().count();
    return question;
  }

  /// Takes in an answer; others' answers and questions have no effect.
  void take(const Timesync& answer) {
    const Instant asked{Instant::duration(answer.ts1)};
    if (answer.tc1 <= 0 || std::ranges::find(asked_, asked) == asked_.end()) return;
    offsets_[count_++ % offsets_.size()] = asked.time_since_epoch() - Instant::duration(answer.tc1);
  }

  /// A moment that is not after the one at which the autopilot's clock was `boot_ms`; nothing
  /// before the first answer.
  std::optional<Instant> not_before(std::uint32_t boot_ms) const {
    if (count_ == 0) return std::nullopt;
    const auto end =
        offsets_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, offsets_.size()));
    const auto best = *std::max_element(offsets_.begin(), end);
    return Instant(best + std::chrono::milliseconds(boot_ms) - kDrift);
  }

  /// The autopilot's clock has begun anew.
  void forget() { count_ = 0; }

 private:
  /// The drift of two clocks in the time between ten answers.
  static constexpr auto kDrift = std::chrono::milliseconds(2);
  std::array<Instant, 8> asked_{};
  std::array<Instant::duration, 10> offsets_{};
  std::size_t next_asked_ = 0, count_ = 0;
};

}  // namespace ergocast::mavlink
