// SPDX-License-Identifier: BSD-3-Clause
// How long messages may gather in the kernel, so that a process wakes once for many.
#pragma once

#include <chrono>
#include <cstddef>

#include "core/mission/mission.h"

namespace ergocast {

/// Waking a process costs more than reading a message. In real time no process waits for a single
/// contribution or command. They are needed at the next tick, and the world's state of that tick
/// wakes all processes.
struct Gathering {
  std::chrono::nanoseconds at_most{0};  ///< 0: each message wakes its receivers
  std::size_t datagrams = 0;            ///< how many may gather on one bus
};

/// The time is half a tick, and at most 50 ms, because answers to requests wait as well. It is 0 in
/// lockstep, where processes wait for each other, and where it would be below 1 ms.
/// @param members  entries of the roster, former members included
Gathering gathering_of(const Mission& mission, std::size_t members);

}  // namespace ergocast
