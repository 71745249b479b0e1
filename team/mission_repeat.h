// SPDX-License-Identifier: BSD-3-Clause
// Decides when a process that knows the mission repeats it on request. It does so after a random
// delay, unless another process is faster, and not too often. Agents do this, and `ergocast run`,
// which outlasts them.
#pragma once

#include <chrono>
#include <optional>

#include "core/base/ids.h"
#include "core/base/noise.h"
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
  /// @param draw  different at each call; the delay depends on it
  void asked(Instant now, std::int64_t draw) { plan(now, kAnswerGap, draw); }

  /// A process has sent a part of `revision`, where we hold `ours`.
  void overheard(std::int64_t revision, std::int64_t ours, Instant now, std::int64_t draw) {
    // Another process was faster. This counts only twice: the part may be a recording.
    if (revision >= ours && due_ && ++left_to_others_ <= 2) due_.reset();
    // The sender does not know a later revision, or the part is a recording.
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
  /// The longest delay before an answer.
  static constexpr auto kLongestDelay = std::chrono::milliseconds(50);
  /// The shortest time between two answers, and between two corrections of an old revision.
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
