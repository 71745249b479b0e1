// SPDX-License-Identifier: BSD-3-Clause
// When a process that knows the mission repeats it on request: after a random moment, unless
// another one is faster, and not too often. Agents do so, and `ergocast run`, which outlives them.
#pragma once

#include <chrono>
#include <optional>

#include "core/ids.h"
#include "core/noise.h"
#include "team/messages.h"

namespace ergocast {

/// Whether a coordinator or a world asks for the mission because it does not know it.
inline bool asks_for_mission(const Hello& hello) {
  return hello.header.sender < kUnassigned && hello.header.tick < 0;
}

class MissionRepeat {
 public:
  /// @param seed  of the delays
  explicit MissionRepeat(std::uint64_t seed) : seed_(seed) {}

  /// A process requests the mission.
  /// @param draw  other than at all other times
  void asked(Instant now, std::int64_t draw) { plan(now, kAnswerGap, draw); }

  /// A process has sent a part of `revision`, where we hold `ours`.
  void overheard(std::int64_t revision, std::int64_t ours, Instant now, std::int64_t draw) {
    // Another one was faster. That is believed twice only: it may be a recording of one part.
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
        uniform_pair(seed_, Purpose::kAnswer, 0, static_cast<std::uint64_t>(draw)).x();
    due_ = now + std::chrono::duration_cast<PacingClock::duration>(share * kLongestDelay);
  }

  std::uint64_t seed_;
  std::optional<Instant> due_, last_;
  int left_to_others_ = 0;
};

}  // namespace ergocast
