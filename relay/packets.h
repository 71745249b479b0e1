// SPDX-License-Identifier: BSD-3-Clause
// The bytes between a site and a hub. Byte 0 is the kind.
//
// A data packet holds datagrams of LCM. Nothing protects it but the tags of the messages in it,
// which both ends check: at the first wrong one they drop the rest, and a packet that begins with
// one does not count. All other packets end with a tag of their own, keyed by the mission key. So a
// host without the key gets no answer from a relay.
//
// A site joins in two round trips: kAsk, kCookie, kJoin, kWelcome. The cookie is a keyed hash of
// the site's address by a secret of the hub. A hub keeps nothing of a site before the cookie has
// come back, so a false source address costs it one hash, and takes no memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/base/ids.h"
#include "lcmtypes/message_authenticator.h"
#include "relay/address.h"
#include "team/messages.h"

namespace ergocast::relay {

using CookieBytes = std::array<std::byte, 16>;

/// 64 random bits of a process of a relay.
using SiteId = std::uint64_t;

/// Site to hub: may I join? The answer is shorter.
struct Ask {
  SiteId site = 0;
  std::uint64_t nonce = 0;  ///< the answer repeats it
};
struct Cookie {
  std::uint64_t nonce = 0;
  CookieBytes cookie{};
};
/// `count` of Join, Ping and Leave grows with each packet of the site, so that a recording has no
/// effect.
struct Join {
  SiteId site = 0;
  std::int64_t count = 0;
  CookieBytes cookie{};
  std::int64_t most_bytes_per_s = 0;  ///< that the site wants to receive; 0: no limit
};
struct Welcome {
  std::int64_t count = 0;
};
/// What one end of a flow has counted since the flow began.
struct FlowCounts {
  std::int64_t packets_sent = 0;
  std::int64_t packets_received = 0;  ///< in a Ping: when the last Pong had come
  std::int64_t dropped = 0;           ///< datagrams that its full queue has dropped
};
/// Site to hub, each second: keeps the flow open, also in routers that translate addresses.
struct Ping {
  SiteId site = 0;
  std::int64_t count = 0;
  FlowCounts counts;
  double round_trip_s = 0;  ///< as last measured
};
struct Pong {
  std::int64_t count = 0;
  FlowCounts counts;
};
/// Hub to site: the address of that Ping has not joined. The site asks again, unless a Pong
/// follows.
struct Unknown {
  std::int64_t count = 0;
};
struct Leave {
  SiteId site = 0;
  std::int64_t count = 0;
};
/// `ergocast doctor --relay` to hub, with a cookie. It is as long as the longest answer.
struct Question {
  std::uint64_t nonce = 0;
  CookieBytes cookie{};
};
struct Report {
  std::uint64_t nonce = 0;
  std::string text;
};
inline constexpr int kMaxReportLength = 1100;

using Control =
    std::variant<Ask, Cookie, Join, Welcome, Ping, Pong, Unknown, Leave, Question, Report>;

/// Byte 0 of a data packet. Other packets have the number of their alternative of Control.
inline constexpr std::byte kDataKind{0x80};

/// Writes and checks the packets that have a tag of their own.
class Seal {
 public:
  /// @param key  null for a team without a key: then anybody can make the packets
  explicit Seal(const MissionKey* key);

  std::vector<std::byte> write(const Control& control) const;
  /// Appends the tag of a packet without one.
  std::vector<std::byte> close(std::vector<std::byte> packet) const;
  /// Nothing if the bytes are anything else, or have another key. Never throws.
  std::optional<Control> read(std::span<const std::byte> packet) const noexcept;

 private:
  MissionKey::Secret key_{};
};

/// Makes and checks cookies, with no memory of what was made.
class CookieJar {
 public:
  explicit CookieJar(const MissionKey::Secret& secret) : secret_(secret) {}
  CookieBytes make(const Address& from, SiteId site, Instant now) const;
  /// Whether make() returned it at most kCookieTime ago.
  bool holds(const CookieBytes& cookie, const Address& from, SiteId site, Instant now) const;

  static constexpr std::chrono::nanoseconds kCookieTime = std::chrono::seconds(60);

 private:
  CookieBytes of_period(const Address& from, SiteId site, std::int64_t period) const;
  MissionKey::Secret secret_;
};

/// LCM's longest datagram is the longest of UDP. It fits a data packet, because the four bytes of
/// its magic number travel as one bit.
inline constexpr std::size_t kMaxGroupBytes = 65507;
/// Several datagrams share a packet up to this length: with the headers of IPv6 and UDP it fits any
/// path with an MTU of 1280. A single message of ours does so with those of IPv4.
inline constexpr std::size_t kBundleBytes = 1280 - 48;
inline constexpr std::size_t kDataHeaderBytes = 1, kFrameHeaderBytes = 3, kMagicBytes = 4;

/// The bytes that a datagram takes in a data packet.
constexpr std::size_t frame_bytes(std::size_t datagram) {
  return kFrameHeaderBytes + datagram - kMagicBytes;
}
/// Whether a relay can carry it: LC02 or LC03, and what follows.
bool is_lcm(std::span<const std::byte> datagram);
/// Appends a datagram to a data packet, which begins with its first.
/// @pre is_lcm(datagram), and it fits
void append_frame(std::vector<std::byte>& packet, Bus bus, std::span<const std::byte> datagram);
/// The datagrams of a data packet, up to the first damage.
std::vector<GroupDatagram> frames_of(std::span<const std::byte> packet);

}  // namespace ergocast::relay
