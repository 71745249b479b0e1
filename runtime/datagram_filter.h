// SPDX-License-Identifier: BSD-3-Clause
// A kernel filter that protects LCM. LCM stores every channel name it receives, and a crafted
// header of a fragmented message ("LC03", which we never send) makes it write outside its memory.
#pragma once

#include <cstdint>
#include <span>

#include "core/ids.h"

namespace ergocast {

/// An incarnation whose messages are repeated in a flood, and its newest known sequence number.
struct Repeated {
  Incarnation life = 0;
  std::int64_t newest = 0;
};

/// Of the repeats, a random one in so many datagrams passes.
inline constexpr std::uint32_t kShareThatPasses = 32;

/// From now on the kernel passes on to this socket of LCM's only unfragmented LCM messages under
/// our channels' names (with any number of up to three digits where there is one channel for each
/// agent), and no longer than ours. Of any other datagram it keeps four bytes, which LCM discards
/// at once; a dropped datagram would be counted as lost for want of buffer space. Needs no
/// privileges. False if the kernel cannot do it: the old filter then stays.
/// @param flooded  messages of these incarnations up to their newest sequences are dropped, except
///                 for a share. The kernel counts them as lost for want of buffer space.
///                 Incarnations are compared by 32 of their bits.
bool admit_only_our_channels(int socket, std::span<const Repeated> flooded = {});

}  // namespace ergocast
