// SPDX-License-Identifier: BSD-3-Clause
// Where a packet of a relay comes from or goes to.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "team/messages.h"

namespace ergocast::relay {

/// An IPv6 address with its port. IPv4 is ::ffff:a.b.c.d, so that one socket serves both.
struct Address {
  std::array<std::uint8_t, 16> ip{};
  std::uint16_t port = 0;
  std::uint32_t interface = 0;  ///< of an address that is valid on one link only; else 0
  /// Which address of this host it uses, at a socket that receives at all of them; else 0. Answers
  /// leave from there, because a router on the way takes no others.
  std::array<std::uint8_t, 16> ours{};
  auto operator<=>(const Address&) const = default;
};

/// "10.0.0.1:7700" or "[fd00:0:0:0:0:0:0:1]:7700".
std::string to_text(const Address& address);

struct Packet {
  Address to;
  std::vector<std::byte> bytes;
};

/// A datagram of the local LCM group, with LCM's header.
struct GroupDatagram {
  Bus bus;
  std::vector<std::byte> bytes;
};

/// What a participant sends in a turn: packets of relays, and datagrams into the local group.
struct Outbox {
  std::vector<Packet> packets;
  std::vector<GroupDatagram> group;
};

}  // namespace ergocast::relay
