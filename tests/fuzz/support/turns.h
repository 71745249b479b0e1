// SPDX-License-Identifier: BSD-3-Clause
// An attacker's datagrams, one after the other: the input of the targets with a state.
//
// The input starts with kPrefixBytes that the target reads. Turns of 4 bytes and a datagram follow.
// The bytes are the wait before it (an index of kWaits), its transmitter, and its length (2 bytes,
// high one first). Tags are made valid, so that a change reaches the listening core.
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

inline constexpr std::size_t kPrefixBytes = 2;
inline constexpr std::size_t kMostTurns = 32;
inline constexpr std::array<std::chrono::milliseconds, 8> kWaits = {
    std::chrono::milliseconds(0),    std::chrono::milliseconds(1),
    std::chrono::milliseconds(20),   std::chrono::milliseconds(100),
    std::chrono::milliseconds(500),  std::chrono::milliseconds(1000),
    std::chrono::milliseconds(4000), std::chrono::milliseconds(60000)};

/// Calls `wait` and then `receive` for each turn, `receive` only if there is a datagram.
void play(Input input, const std::function<void(std::chrono::nanoseconds)>& wait,
          const std::function<void(std::span<const std::byte>, AgentId transmitter)>& receive);

/// Changes one turn, or the order of the turns.
std::size_t mutate_turns(std::span<std::uint8_t> space, std::size_t size, std::uint64_t seed);

}  // namespace ergocast::fuzz
