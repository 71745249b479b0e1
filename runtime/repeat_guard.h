// SPDX-License-Identifier: BSD-3-Clause
// Tells when a bus is flooded with what has been said before, and what the kernel has to know to
// keep most of it from us.
//
// A flood must not cost more than it takes to look at it: what has been read, hashed and decoded
// has already cost what our own messages need. So the kernel looks, at sender's life and sequence,
// before the datagram takes a place in the socket's buffer. It drops nothing while there is no
// flood, since teammates repeat each other's messages for good reasons, and lets a share pass while
// there is one. What it goes by was verified, so that no forger makes it drop what is new.
#pragma once

#include <chrono>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "team/liveness.h"
#include "core/ids.h"
#include "team/messages.h"
#include "runtime/datagram_filter.h"

namespace ergocast {

/// Of one bus.
class RepeatGuard {
 public:
  /// So many repeats in so long are a flood; a team's own are fewer.
  static constexpr int kMostRepeats = 200;
  static constexpr std::chrono::nanoseconds kWindow = std::chrono::milliseconds(100);
  /// It is over when so many windows together had few: a process that was held up finds little at
  /// first.
  static constexpr int kCalmWindows = 10;
  /// As many as a team has at a time, and some.
  static constexpr std::size_t kMostLives = 144;

  explicit RepeatGuard(Bus bus) : bus_(bus) {}

  /// Whether its sender has said nothing later yet, nor this, in this life (team/liveness.h).
  /// @pre the message is believed
  bool is_news(const Header& from, Instant now) { return liveness_.record(from, bus_, now); }

  /// Counts a message that is_news() was asked about. True if flooded() has changed.
  bool count(const Header& from, bool is_news, Instant now);

  /// What the kernel is to keep from us; empty while there is no flood.
  std::span<const Repeated> flooded() const { return flooded_; }

 private:
  Bus bus_;
  Liveness liveness_;
  Instant window_began_{};
  int repeats_ = 0;         // in this window, that came to us
  std::set<Author> lives_;  // that were repeated since the flood began
  std::vector<Repeated> flooded_;
};

}  // namespace ergocast
