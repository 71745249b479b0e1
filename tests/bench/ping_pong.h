// SPDX-License-Identifier: BSD-3-Clause
// The floor of lockstep, and beside it what LCM alone costs: processes that only pass the same messages around.
#pragma once

#include <cstddef>
#include <optional>

#include "tests/bench/raw_buses.h"
#include "core/ids.h"
#include "core/mission.h"

namespace ergocast::bench {

/// What a mission says in one tick of lockstep, in the bytes that our codec makes of it: the world
/// its state, every agent all its blocks and a command; the logger acknowledges now and then.
struct Traffic {
  int agents;
  int blocks;  ///< per agent and tick
  std::size_t state_bytes, block_bytes, command_bytes, ack_bytes;
};
Traffic traffic_of(const Mission& mission);

/// Forks every agent and the logger, is the world itself, and plays `ticks` ticks: the messages have the right size, number, order and recipients, but nothing in them. Nothing is
/// encoded, checked or computed. Every process has ended when it returns.
/// @return ticks per second, the start left out; nothing if LCM cannot be used
std::optional<double> ping_pong(Carrier carrier, const Traffic& traffic, Tick ticks);

}  // namespace ergocast::bench
