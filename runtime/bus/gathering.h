// SPDX-License-Identifier: BSD-3-Clause
// How long messages may gather in the kernel, so that a process wakes once for many.
#pragma once

#include <chrono>
#include <cstddef>

#include "core/mission/mission.h"

namespace ergocast {

/// Waking a process costs more than reading a message. In real time no process waits for a single
/// contribution or command. The next tick needs it, and the world's state of that tick wakes all.
struct Gathering {
  std::chrono::nanoseconds at_most{0};  ///< 0: each message wakes its receivers
  std::size_t datagrams = 0;            ///< that may come together on one bus
};

/// Half a tick, at most 50 ms, because answers to requests wait as well. 0 in lockstep, where each
/// process waits for others, and where less than 1 ms would be gained.
/// @param members  entries of the roster, former members included
Gathering gathering_of(const Mission& mission, std::size_t members);

}  // namespace ergocast
