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
#include <deque>
#include <optional>

#include "bridges/mavlink/messages.h"

namespace ergocast::mavlink {

class ClockBond {
 public:
  /// The question to send now.
  Timesync ask(Instant now) {
    asked_[next_asked_++ % asked_.size()] = now;
    while (!answers_.empty() && now - answers_.front().asked > kOldest) answers_.pop_front();
    Timesync question;
    question.ts1 = now.time_since_epoch().count();
    return question;
  }

  /// Takes in an answer; others' answers and questions have no effect.
  void take(const Timesync& answer) {
    const Instant asked{Instant::duration(answer.ts1)};
    if (answer.tc1 <= 0 || answer.tc1 > kLatest_ns ||
        std::ranges::find(asked_, asked) == asked_.end())
      return;
    answers_.push_back({asked, asked.time_since_epoch() - Instant::duration(answer.tc1)});
    if (answers_.size() > kMostAnswers) answers_.pop_front();
  }

  /// A moment that is not after the one at which the autopilot's clock was `boot_ms`; nothing
  /// without an answer of the last 20 s.
  std::optional<Instant> not_before(std::uint32_t boot_ms) const {
    if (answers_.empty()) return std::nullopt;
    const auto best = std::ranges::max_element(answers_, {}, &Answer::offset)->offset;
    return Instant(best + std::chrono::milliseconds(boot_ms) - kDrift);
  }

  /// The autopilot's clock has begun anew.
  void forget() { answers_.clear(); }

 private:
  struct Answer {
    Instant asked;
    Instant::duration offset;  ///< of our clock
  };
  /// 100 years: some autopilots answer by the calendar. No sum of such times overflows.
  static constexpr std::int64_t kLatest_ns = 3'155'760'000'000'000'000;
  static constexpr std::size_t kMostAnswers = 10;
  static constexpr auto kOldest = std::chrono::seconds(20);
  /// The drift of two clocks in that time.
  static constexpr auto kDrift = std::chrono::milliseconds(2);
  std::array<Instant, 8> asked_{};
  std::size_t next_asked_ = 0;
  std::deque<Answer> answers_;
};

}  // namespace ergocast::mavlink
