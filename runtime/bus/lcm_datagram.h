// SPDX-License-Identifier: BSD-3-Clause
// LCM's unfragmented datagram: "LC02", a sequence number, the channel's name, a zero, the message.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "lcmtypes/message_authenticator.h"

namespace ergocast {

inline constexpr std::uint32_t kLcmMagic = 0x4c433032;  // "LC02"
inline constexpr std::size_t kLcmHeaderBytes = 8;
/// The longest channel name of LCM, 63 characters, with its zero.
inline constexpr std::size_t kMaxChannelBytes = 64;
/// No datagram of ours is longer.
inline constexpr std::size_t kMaxLcmBytes = kLcmHeaderBytes + kMaxChannelBytes + kMaxDatagramBytes;

/// The parts of a received datagram, which they point into.
struct LcmDatagram {
  std::string_view channel;
  std::span<const std::byte> message;
};

/// Nothing if `bytes` are anything else, for example a fragment of a longer message ("LC03").
std::optional<LcmDatagram> parse_datagram(std::span<const std::byte> bytes);

/// Writes a datagram into `out` and returns its size.
/// @pre `channel` has less than kMaxChannelBytes, `message` at most kMaxDatagramBytes
std::size_t write_datagram(std::span<std::byte, kMaxLcmBytes> out, std::uint32_t sequence,
                           std::string_view channel, std::span<const std::byte> message);

}  // namespace ergocast
