// SPDX-License-Identifier: BSD-3-Clause
// One list of fields for each packet; writing and reading both use it, as lcmtypes/fields.h.
#include "relay/packets.h"

#include <sodium.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/base/require.h"
#include "lcmtypes/wire.h"

namespace ergocast::relay {
namespace {

/// A later format of packets has another one, so that relays of two versions do not join.
constexpr std::string_view kPurpose = "ergocast relay, format 1";
constexpr std::size_t kKindBytes = 1;
constexpr std::int64_t kMostBytesPerS = std::int64_t{1} << 40;
constexpr double kLongestRoundTripS = 3600;
/// Ask and Question are as long as their answers.
constexpr std::size_t kAskPadding = 16, kQuestionPadding = kMaxReportLength;

const unsigned char* raw(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

CookieBytes keyed_hash(std::span<const std::byte> bytes, const MissionKey::Secret& key) {
  CookieBytes hash;
  crypto_generichash(reinterpret_cast<unsigned char*>(hash.data()), hash.size(), raw(bytes),
                     bytes.size(), raw(key), key.size());
  return hash;
}

template <std::size_t kCount>
void padding(auto& io) {
  std::array<std::byte, kCount> zeros{};
  io.bytes(zeros);
}

void list(auto& io,
          auto& counts) requires std::is_same_v<std::remove_cvref_t<decltype(counts)>, FlowCounts> {
  io.count(counts.packets_sent);
  io.count(counts.packets_received);
  io.count(counts.dropped);
}

/// Visits the fields of a packet.
struct Fields {
  static void of(auto& io, auto& m) {
    using M = std::remove_cvref_t<decltype(m)>;
    if constexpr (std::is_same_v<M, Ask>) {
      io.number(m.site), io.number(m.nonce), padding<kAskPadding>(io);
    } else if constexpr (std::is_same_v<M, Cookie>) {
      io.number(m.nonce), io.bytes(m.cookie);
    } else if constexpr (std::is_same_v<M, Join>) {
      io.number(m.site), io.count(m.count), io.bytes(m.cookie), io.count(m.most_bytes_per_s);
      io.holds(m.most_bytes_per_s <= kMostBytesPerS);
    } else if constexpr (std::is_same_v<M, Ping>) {
      io.number(m.site), io.count(m.count), list(io, m.counts), io.quantity(m.round_trip_s);
      io.holds(m.round_trip_s <= kLongestRoundTripS);
    } else if constexpr (std::is_same_v<M, Pong>) {
      io.count(m.count), list(io, m.counts);
    } else if constexpr (std::is_same_v<M, Leave>) {
      io.number(m.site), io.count(m.count);
    } else if constexpr (std::is_same_v<M, Question>) {
      io.number(m.nonce), io.bytes(m.cookie), padding<kQuestionPadding>(io);
    } else if constexpr (std::is_same_v<M, Report>) {
      io.number(m.nonce), io.text(m.text, kMaxReportLength);
    } else {
      static_assert(std::is_same_v<M, Welcome> || std::is_same_v<M, Unknown>);
      io.count(m.count);
    }
  }
};

template <class M>
std::optional<Control> read_as(std::span<const std::byte> fields) {
  M message;
  Reader reader(fields);
  Fields::of(reader, message);
  if (!reader.complete() || !reader.plausible()) return std::nullopt;
  return message;
}

template <std::size_t kAt = 0>
std::optional<Control> read_kind(std::size_t kind, std::span<const std::byte> fields) {
  if constexpr (kAt == std::variant_size_v<Control>) {
    return std::nullopt;
  } else {
    if (kind == kAt) return read_as<std::variant_alternative_t<kAt, Control>>(fields);
    return read_kind<kAt + 1>(kind, fields);
  }
}

}  // namespace

// ---- packets with a tag ----

Seal::Seal(const MissionKey* key) {
  ERGOCAST_REQUIRE(sodium_init() >= 0);
  const MissionKey::Secret none{};
  const MissionKey::Secret& shared = key != nullptr ? key->shared : none;
  const auto purpose = std::as_bytes(std::span(kPurpose));
  crypto_generichash(reinterpret_cast<unsigned char*>(key_.data()), key_.size(), raw(purpose),
                     purpose.size(), raw(shared), shared.size());
}

std::vector<std::byte> Seal::write(const Control& control) const {
  std::vector<std::byte> fields, packet;
  Writer writer(fields);
  std::visit([&writer](const auto& message) { Fields::of(writer, message); }, control);
  packet.push_back(static_cast<std::byte>(control.index()));
  packet.insert(packet.end(), fields.begin(),
                fields.begin() + static_cast<std::ptrdiff_t>(writer.size()));
  return close(std::move(packet));
}

std::vector<std::byte> Seal::close(std::vector<std::byte> packet) const {
  const CookieBytes tag = keyed_hash(packet, key_);
  packet.insert(packet.end(), tag.begin(), tag.end());
  return packet;
}

std::optional<Control> Seal::read(std::span<const std::byte> packet) const noexcept {
  try {
    constexpr std::size_t kTag = sizeof(CookieBytes);
    if (packet.size() < kKindBytes + kTag || packet.size() > kMaxDatagramBytes) return std::nullopt;
    const auto signed_part = packet.first(packet.size() - kTag);
    const CookieBytes tag = keyed_hash(signed_part, key_);
    if (sodium_memcmp(tag.data(), packet.last(kTag).data(), kTag) != 0) return std::nullopt;
    return read_kind(std::to_integer<std::size_t>(packet[0]), signed_part.subspan(kKindBytes));
  } catch (...) {  // out of memory
    return std::nullopt;
  }
}

// ---- cookies ----

CookieBytes CookieJar::of_period(const Address& from, SiteId site, std::int64_t period) const {
  std::vector<std::byte> bytes;
  Writer writer(bytes);
  writer.bytes(std::as_bytes(std::span(from.ip)));
  writer.number(std::uint32_t{from.port});
  writer.number(from.interface);
  writer.number(site);
  writer.number(period);
  return keyed_hash(std::span(bytes).first(writer.size()), secret_);
}

// A cookie names half of kCookieTime, and holds in the next half as well.
CookieBytes CookieJar::make(const Address& from, SiteId site, Instant now) const {
  return of_period(from, site, now.time_since_epoch() / (kCookieTime / 2));
}

bool CookieJar::holds(const CookieBytes& cookie, const Address& from, SiteId site,
                      Instant now) const {
  const std::int64_t period = now.time_since_epoch() / (kCookieTime / 2);
  const CookieBytes newer = of_period(from, site, period);
  const CookieBytes older = of_period(from, site, period - 1);
  const bool is_newer = sodium_memcmp(newer.data(), cookie.data(), cookie.size()) == 0;
  const bool is_older = sodium_memcmp(older.data(), cookie.data(), cookie.size()) == 0;
  return is_newer || is_older;
}

// ---- data ----

namespace {

constexpr std::array<std::array<std::byte, kMagicBytes>, 2> kMagics{
    {{std::byte{'L'}, std::byte{'C'}, std::byte{'0'}, std::byte{'2'}},
     {std::byte{'L'}, std::byte{'C'}, std::byte{'0'}, std::byte{'3'}}}};
/// The first byte of a frame: the bus, and this bit for a fragment.
constexpr unsigned kFragmentBit = 0x80;

bool begins_with(std::span<const std::byte> bytes, std::span<const std::byte> start) {
  return bytes.size() > start.size() && std::equal(start.begin(), start.end(), bytes.begin());
}

}  // namespace

bool is_lcm(std::span<const std::byte> datagram) {
  return begins_with(datagram, kMagics[0]) || begins_with(datagram, kMagics[1]);
}

void append_frame(std::vector<std::byte>& packet, Bus bus, std::span<const std::byte> datagram) {
  ERGOCAST_REQUIRE(is_lcm(datagram) && datagram.size() <= kMaxGroupBytes);
  if (packet.empty()) packet.push_back(kDataKind);
  const auto rest = datagram.subspan(kMagicBytes);
  const unsigned fragment = begins_with(datagram, kMagics[1]) ? kFragmentBit : 0;
  packet.push_back(static_cast<std::byte>(static_cast<unsigned>(bus) | fragment));
  packet.push_back(static_cast<std::byte>(rest.size() >> 8));
  packet.push_back(static_cast<std::byte>(rest.size() & 0xff));
  packet.insert(packet.end(), rest.begin(), rest.end());
}

std::vector<GroupDatagram> frames_of(std::span<const std::byte> packet) {
  std::vector<GroupDatagram> datagrams;
  if (packet.empty() || packet[0] != kDataKind) return datagrams;
  auto left = packet.subspan(kDataHeaderBytes);
  while (left.size() > kFrameHeaderBytes) {
    const auto what = std::to_integer<unsigned>(left[0]);
    const auto size =
        std::to_integer<std::size_t>(left[1]) << 8 | std::to_integer<std::size_t>(left[2]);
    const unsigned bus = what & ~kFragmentBit;
    left = left.subspan(kFrameHeaderBytes);
    if (bus >= kBusCount || size == 0 || size > left.size()) break;
    const auto& magic = kMagics[(what & kFragmentBit) != 0 ? 1 : 0];
    GroupDatagram& one = datagrams.emplace_back(GroupDatagram{static_cast<Bus>(bus), {}});
    one.bytes.reserve(kMagicBytes + size);
    one.bytes.assign(magic.begin(), magic.end());
    one.bytes.insert(one.bytes.end(), left.begin(),
                     left.begin() + static_cast<std::ptrdiff_t>(size));
    left = left.subspan(size);
  }
  return datagrams;
}

}  // namespace ergocast::relay
