// SPDX-License-Identifier: BSD-3-Clause
// Forged datagrams: bytes changed at the places of fields, with a valid tag.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "team/messages.h"

namespace ergocast::fuzz {

inline constexpr std::size_t kHeaderBytes = 60;

/// A generator of numbers that depend only on its seed.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  /// Below `sides`, which is above 0.
  std::size_t below(std::size_t sides) { return next() % sides; }

 private:
  std::uint64_t state_;
};

/// Gives a datagram of at least kHeaderBytes the tag of a sender without a key.
void retag(std::span<std::uint8_t> datagram);

/// Changes one thing: a field's number, a string's length, a few bits, the size. Returns the new
/// size, at most space.size(). The tag stays as it was.
std::size_t mutate_datagram(std::span<std::uint8_t> space, std::size_t size, Dice& dice);

}  // namespace ergocast::fuzz
