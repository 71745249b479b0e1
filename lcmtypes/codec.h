// Plain messages to checked bytes and back: the only place that knows the wire.
//
// Bytes are believed in this order: size, type, tag (a hash over everything), run, the counts
// against the size; only then does a generated decoder see them. Debian's decoders trust a
// declared count before they look at the length, so nothing else may call them.
#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "core/messages.h"

namespace ergocast {

/// Longest datagram we send: one Ethernet frame on any path with an MTU of 1280.
inline constexpr std::size_t kMaxDatagramBytes = 1220;

/// Writes `message` into `out`, whose capacity is reused. Strings are cut at their limits.
/// @pre counts within the limits of core/messages.h.
void encode(const Message& message, std::vector<std::byte>& out);

/// The message in `bytes`, or why it is refused. Never throws, whatever the bytes are.
/// @param run  the only run accepted; 0 accepts any (who only watches, or has yet to join).
std::variant<Message, Refusal> decode(std::span<const std::byte> bytes, RunId run) noexcept;

}  // namespace ergocast
