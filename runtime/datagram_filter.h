// SPDX-License-Identifier: BSD-3-Clause
// What LCM must not see: it keeps every channel name it ever met, and a crafted header of a
// fragmented message ("LC03", as none of ours is) makes it write outside its memory.
#pragma once

#include <cstdint>
#include <span>

#include "core/ids.h"

namespace ergocast {

/// Whoever is repeated in a flood, and the last sequence of his that we know.
struct Repeated {
  Incarnation life = 0;
  std::int64_t newest = 0;
};

/// Of what is repeated of them, one datagram in so many passes, at random.
inline constexpr std::uint32_t kShareThatPasses = 32;

/// From now on the kernel passes on to this socket of LCM's only unfragmented LCM messages under
/// our channels' names (with any number of up to three digits where there is one for each agent),
/// and no longer than ours.
/// Of any other datagram nothing is left but four bytes, which LCM throws away at once; the kernel
/// would count one that is dropped as lost for want of buffer space. Needs no privileges. False if
/// the kernel cannot do it: then all stays as it was.
/// @param flooded  what these lives have said up to their newest sequences is dropped, but for a share.
///                 The kernel counts that as lost for want of buffer space. Lives are told apart by 32
///                 of their bits.
bool admit_only_our_channels(int socket, std::span<const Repeated> flooded = {});

}  // namespace ergocast
