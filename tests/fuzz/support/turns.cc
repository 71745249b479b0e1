// SPDX-License-Identifier: BSD-3-Clause
// Cuts an input into turns by their lengths, and mutates whole turns as well as bytes within
// them.
#include "tests/fuzz/support/turns.h"

#include <algorithm>
#include <cstring>

#include "lcmtypes/codec.h"
#include "tests/fuzz/support/datagrams.h"

namespace ergocast::fuzz {
namespace {

constexpr std::size_t kTurnBytes = 4;

/// Where a turn begins and ends.
struct Turn {
  std::size_t begin, end;
};

std::vector<Turn> turns_in(Input input) {
  std::vector<Turn> turns;
  for (std::size_t at = kPrefixBytes;
       at + kTurnBytes <= input.size() && turns.size() < kMostTurns;) {
    const std::size_t length = input[at + 2] * 256U + input[at + 3];
    const std::size_t end = std::min(input.size(), at + kTurnBytes + length);
    turns.push_back({at, end});
    at = end;
  }
  return turns;
}

/// Another datagram in the turn, at most as long as there is space.
std::size_t mutate_turn(std::span<std::uint8_t> space, std::size_t size, const Turn& turn,
                        Dice& dice) {
  std::uint8_t* const at = space.data() + turn.begin + kTurnBytes;
  std::uint8_t* const end = space.data() + turn.end;
  std::vector<std::uint8_t> datagram(at, end);
  const std::size_t before = datagram.size(), behind = size - turn.end;
  datagram.resize(std::max(before, std::min(kMaxDatagramBytes, before + space.size() - size)));
  const std::size_t after = mutate_datagram(datagram, before, dice);
  std::memmove(at + after, end, behind);
  std::copy_n(datagram.begin(), after, at);
  at[-2] = static_cast<std::uint8_t>(after / 256);
  at[-1] = static_cast<std::uint8_t>(after % 256);
  return size - before + after;
}

}  // namespace

void play(Input input, const std::function<void(std::chrono::nanoseconds)>& wait,
          const std::function<void(std::span<const std::byte>, AgentId transmitter)>& receive) {
  for (const Turn& turn : turns_in(input)) {
    wait(kWaits[input[turn.begin] % kWaits.size()]);
    const Input sent = input.subspan(turn.begin + kTurnBytes, turn.end - turn.begin - kTurnBytes);
    if (sent.size() < kHeaderBytes) continue;
    std::vector<std::uint8_t> datagram(sent.begin(), sent.end());
    retag(datagram);
    receive(bytes_of(datagram), input[turn.begin + 1]);
  }
}

std::size_t mutate_turns(std::span<std::uint8_t> space, std::size_t size, std::uint64_t seed) {
  const std::vector<Turn> turns = turns_in(space.first(size));
  if (turns.empty()) return size;
  Dice dice(seed);
  const std::size_t i = dice.below(turns.size());
  const Turn& turn = turns[i];
  const std::size_t length = turn.end - turn.begin;
  switch (dice.below(8)) {
    case 0:
      space[dice.below(kPrefixBytes)] = static_cast<std::uint8_t>(dice.next());
      return size;
    case 1:
      space[turn.begin] = static_cast<std::uint8_t>(dice.below(kWaits.size()));
      return size;
    case 2:
      space[turn.begin + 1] = static_cast<std::uint8_t>(dice.below(4));
      return size;
    case 3:  // left out
      std::memmove(&space[turn.begin], space.data() + turn.end, size - turn.end);
      return size - length;
    case 4:  // repeated, at the end
      if (size + length > space.size()) return size;
      std::memcpy(space.data() + size, &space[turn.begin], length);
      return size + length;
    case 5:  // the next one first
      if (i + 1 < turns.size()) {
        std::rotate(&space[turn.begin], &space[turn.end], space.data() + turns[i + 1].end);
      }
      return size;
    default:
      return mutate_turn(space, size, turn, dice);
  }
}

}  // namespace ergocast::fuzz
