// SPDX-License-Identifier: BSD-3-Clause
// Detects floods of repeated messages and lists what the kernel must drop.
//
// Reading, hashing and decoding a repeat costs as much as one of our own messages. So the kernel
// compares the sender's incarnation and sequence before the datagram takes a place in the socket's
// buffer. Without a flood it drops nothing, because teammates repeat each other's messages for good
// reasons. During a flood it lets a share pass. The list has only verified messages, so a forger
// cannot make the kernel drop new ones.
#pragma once

#include <chrono>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "runtime/bus/datagram_filter.h"
#include "team/liveness.h"
#include "team/messages.h"

namespace ergocast {

/// The guard of one bus.
class RepeatGuard {
 public:
  /// The number of repeats in a window that counts as a flood; a team repeats fewer.
  /// Limit (Network): repeats of old messages on a bus in 0.1 s. Beyond it: the kernel passes only
  /// a share of them and drops the others.
  static constexpr int kMostRepeats = 200;
  static constexpr std::chrono::nanoseconds kWindow = std::chrono::milliseconds(100);
  /// A flood ends if so many windows together have few repeats. One window is not enough, because a
  /// delayed process receives little at first.
  static constexpr int kCalmWindows = 10;
  /// More than the incarnations that a team has at a time.
  static constexpr std::size_t kMaxIncarnations = 144;

  explicit RepeatGuard(Bus bus) : bus_(bus) {}

  /// Whether this message is new: its sender has sent neither this nor a later message in this
  /// incarnation (team/liveness.h).
  /// @pre the message was verified
  bool is_new(const Header& from, Instant now) { return liveness_.record(from, bus_, now); }

  /// Counts a message that was passed to is_new(). True if flooded() has changed.
  bool count(const Header& from, bool is_new, Instant now);

  /// The messages that the kernel must drop; empty without a flood.
  std::span<const Repeated> flooded() const { return flooded_; }

 private:
  Bus bus_;
  Liveness liveness_;
  Instant window_began_{};
  int repeats_ = 0;            // in this window, as received
  std::set<Author> flooding_;  // repeated since the flood began
  std::vector<Repeated> flooded_;
};

}  // namespace ergocast
