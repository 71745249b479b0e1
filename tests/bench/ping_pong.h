// SPDX-License-Identifier: BSD-3-Clause
// The lower bound of lockstep, and the cost of LCM alone: processes that only exchange the same
// messages.
#pragma once

#include <cstddef>
#include <optional>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "tests/bench/raw_buses.h"

namespace ergocast::bench {

/// The messages of a mission in one tick of lockstep, in the bytes of our codec: the world sends
/// its state, every agent all its blocks and a command; the logger acknowledges at intervals.
struct Traffic {
  int agents;
  int blocks;             ///< per agent and tick
  int agents_in_a_state;  ///< at most, in each part of the world's state
  std::size_t state_bytes, block_bytes, command_bytes, ack_bytes;
};
Traffic traffic_of(const Mission& mission);

/// Forks every agent and the logger, is the world itself, and plays `ticks` ticks. The messages
/// have the right size, number, order and recipients, but no content: nothing is encoded, checked
/// or computed. Every process has ended when it returns.
/// @return ticks per second without the start; nullopt if LCM cannot be used
std::optional<double> ping_pong(Carrier carrier, const Traffic& traffic, Tick ticks);

}  // namespace ergocast::bench
