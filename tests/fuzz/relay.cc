// SPDX-License-Identifier: BSD-3-Clause
// Packets from anywhere at a hub, at a site that has joined it, and at a gate: nothing breaks, a
// stranger gets no longer answer than its packet, and what has no tag of the key goes nowhere.
//
// Input: a byte for each packet's receiver and sender, its length in two bytes, the packet. With
// bit 7 the packet's tag is repaired, as a holder of the key could.
#include <algorithm>

#include "relay/hub.h"
#include "relay/site.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {
namespace {

using namespace std::chrono_literals;
using relay::Address;
using relay::Outbox;

constexpr unsigned kToSite = 1, kToGroup = 2, kSenders = 3, kRepaired = 0x80;

Address address(unsigned host) {
  Address address;
  address.ip[15] = static_cast<std::uint8_t>(host);
  address.port = 7700;
  return address;
}

/// A hub at address 0, and a site at address 1 that joins it.
class Network {
 public:
  Network() {
    site_.advance(now_, up_);
    site_.found({address(0)}, now_);
    for (int turn = 0; turn < 4; ++turn) carry();
    ERGOCAST_REQUIRE(site_.joined().has_value());
  }

  void take(unsigned what, std::span<const std::byte> bytes) {
    now_ += 10ms;
    const Address from = address((what >> 2) % kSenders);
    std::vector<std::byte> packet(bytes.begin(), bytes.end());
    if ((what & kRepaired) != 0 && !packet.empty()) packet = seal_.close(packet);
    if ((what & kToGroup) != 0) {
      site_.take_local(Bus::kSwarm, packet, now_);
    } else if ((what & kToSite) != 0) {
      site_.receive(packet, from, now_, up_);
    } else {
      Outbox answer;
      hub_.receive(packet, from, now_, answer);
      for (const relay::Packet& one : answer.packets) {
        ERGOCAST_REQUIRE(one.to == from && one.bytes.size() <= packet.size());
      }
      ERGOCAST_REQUIRE(answer.packets.size() <= 1 && answer.group.empty());
    }
    ERGOCAST_REQUIRE(up_.group.empty());  // nothing has a tag of the key
    carry();
    ERGOCAST_REQUIRE(hub_.sites() <= kSenders + 1);
  }

 private:
  void carry() {
    site_.advance(now_, up_);
    hub_.advance(now_, down_);
    for (const relay::Packet& one : up_.packets) hub_.receive(one.bytes, address(1), now_, down_);
    up_ = {};
    for (const relay::Packet& one : down_.packets) {
      if (one.to == address(1)) site_.receive(one.bytes, address(0), now_, up_);
    }
    down_ = {};
  }

  static MessageAuthenticator key() {
    return MessageAuthenticator(MissionKey{{std::byte{7}}, {std::byte{8}}, {}});
  }
  Instant now_{1000s};
  relay::Seal seal_{key().key()};
  relay::Hub hub_{{}, key()};
  relay::Site site_{{}, key(), 5};
  Outbox up_, down_;
};

}  // namespace

FUZZ_TARGET(relay) {
  Network network;
  for (Input left = input; left.size() >= 3;) {
    const std::size_t size = std::min<std::size_t>(left[1] * 256U + left[2], left.size() - 3);
    network.take(left[0], bytes_of(left.subspan(3, size)));
    left = left.subspan(3 + size);
  }
}

}  // namespace ergocast::fuzz
