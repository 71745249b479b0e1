// SPDX-License-Identifier: BSD-3-Clause
// When an agent repeats the mission on request: after a random moment, unless a teammate is
// faster, and not too often.
#pragma once

#include <chrono>
#include <optional>

#include "core/ids.h"
#include "core/noise.h"

namespace ergocast {

class MissionRepeat {
 public:
  /// @param incarnation  seeds the delays
  explicit MissionRepeat(Incarnation incarnation) : incarnation_(incarnation) {}

  /// A process requests the mission.
  /// @param draw  other than at all other times
  void asked(Instant now, std::int64_t draw) { plan(now, kAnswerGap, draw); }

  /// A process has sent a part of `revision`, where we hold `ours`.
  void overheard(std::int64_t revision, std::int64_t ours, Instant now, std::int64_t draw) {
    // A teammate was faster. That is believed twice only: it may be a recording of one part.
    if (revision >= ours && due_ && ++left_to_others_ <= 2) due_.reset();
    // One who has not heard of what came later, or a recording.
    if (revision < ours) plan(now, kCorrectionGap, draw);
  }

  bool due(Instant now) const { return due_ && now >= *due_; }
  Instant next() const { return due_.value_or(Instant::max()); }

  /// The mission has been repeated.
  void done(Instant now) {
    due_.reset();
    left_to_others_ = 0;
    last_ = now;
  }

 private:
  /// Of the delay before an answer.
  static constexpr auto kLongestDelay = std::chrono::milliseconds(50);
  /// Between two answers, and between two corrections of what is out of date.
  static constexpr auto kAnswerGap = std::chrono::milliseconds(100);
  static constexpr auto kCorrectionGap = std::chrono::milliseconds(500);

  void plan(Instant now, PacingClock::duration gap, std::int64_t draw) {
    if (due_ || (last_ && now - *last_ < gap)) return;
    const double share =
        uniform_pair(incarnation_, Purpose::kAnswer, 0, static_cast<std::uint64_t>(draw)).x();
    due_ = now + std::chrono::duration_cast<PacingClock::duration>(share * kLongestDelay);
  }

  Incarnation incarnation_;
  std::optional<Instant> due_, last_;
  int left_to_others_ = 0;
};

}  // namespace ergocast
