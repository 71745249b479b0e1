// SPDX-License-Identifier: BSD-3-Clause
// A kernel filter that passes on only what a process subscribes to. So other messages neither wake
// the process nor take space in its receive buffer.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/ids.h"
#include "team/subscriptions.h"

namespace ergocast {

/// An incarnation whose messages are repeated in a flood, and its newest known sequence number.
struct Repeated {
  Incarnation incarnation = 0;
  std::int64_t newest = 0;
};

/// One in so many repeats passes, at random.
/// Limit (Network): further repeats for each one that the kernel passes. Beyond it: they are
/// dropped and counted as `rate`.
inline constexpr std::uint32_t kShareThatPasses = 32;

/// From now on the kernel passes on to this socket only unfragmented LCM messages on the channels
/// of `types`, and no longer than ours. A channel of an agent may have any number of up to three
/// digits. Needs no privileges. False if the kernel cannot do it: the old filter then stays. The
/// kernel counts what the filter drops together with what it drops for want of buffer space.
/// @param replays  those of `ergocast replay` (lcmtypes/channels.h) as well
/// @param flooded  messages of these incarnations up to their newest sequences are dropped, except
///                 for a share. Incarnations are compared by 32 of their bits.
bool admit_only(int socket, MessageTypes types, std::span<const Repeated> flooded = {},
                bool replays = false);

}  // namespace ergocast
