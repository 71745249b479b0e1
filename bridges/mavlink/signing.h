// SPDX-License-Identifier: BSD-3-Clause
// Signatures of MAVLink 2: a sender that has the link's key, and frames that are no repeats.
//
// A signed frame ends with the number of the link, a time and the first 48 bits of SHA-256 over
// key, frame, number and time. Times count 10 µs since 1 January 2015, and grow with each frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace ergocast::mavlink {

using SigningKey = std::array<std::byte, 32>;

/// 1 January 2015 by the clock of Unix [s].
inline constexpr std::int64_t kSigningEpoch_s = 1420070400;
/// A time of the clock of Unix as signatures have it [10 µs]; nothing before their epoch. A
/// computer without a battery for its clock begins in 1970.
constexpr std::optional<std::uint64_t> signing_time(std::int64_t unix_s, std::int64_t ns) {
  if (unix_s <= kSigningEpoch_s) return std::nullopt;
  return static_cast<std::uint64_t>(unix_s - kSigningEpoch_s) * 100'000 +
         static_cast<std::uint64_t>(ns / 10'000);
}

/// A sender that is new here may be this much behind the newest frame of any other [10 µs].
inline constexpr std::uint64_t kSigningSlack = 6'000'000;

inline constexpr std::size_t kSignatureBytes = 13;
/// Link, time and the beginning of the hash.
using SignatureBlock = std::array<std::byte, kSignatureBytes>;

/// @param frame  from its first byte to the end of its checksum
/// @param time   of which 48 bits count
SignatureBlock sign(const SigningKey& key, std::span<const std::byte> frame, std::uint8_t link,
                    std::uint64_t time);

/// The time in a block.
std::uint64_t time_of(std::span<const std::byte, kSignatureBytes> block);

}  // namespace ergocast::mavlink
