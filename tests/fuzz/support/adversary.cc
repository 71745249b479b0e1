// SPDX-License-Identifier: BSD-3-Clause
// Records datagrams, makes one to four changes in a copy, and sends the copy in LCM's format.
#include "tests/fuzz/support/adversary.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "cli/doctor/group_listener.h"
#include "core/base/require.h"
#include "lcmtypes/codec.h"

namespace ergocast::fuzz {
namespace {

constexpr std::size_t kLcmHeaderBytes = 8;  // "LC02" and a sequence number
constexpr std::size_t kMostKept = 4000;
constexpr std::size_t kMostBytes = 9000;

}  // namespace

Adversary::Adversary(const LcmUrl& url, const MessageAuthenticator& authenticator,
                     std::uint64_t seed)
    : url_(url), authenticator_(authenticator), dice_(seed), mouth_(AF_INET, SOCK_DGRAM) {
  for (int bus = 0; bus < kBusCount; ++bus) {
    std::string error;
    ears_.push_back(doctor::group_listener(url.group, url.base_port + bus, error));
    ERGOCAST_REQUIRE(error.empty());
  }
}

std::uint64_t Adversary::mark(const std::string& channel, std::span<const std::uint8_t> message) {
  const std::string_view text(reinterpret_cast<const char*>(message.data()), message.size());
  return std::hash<std::string_view>()(text) * 31 + std::hash<std::string>()(channel);
}

void Adversary::listen() {
  std::array<std::uint8_t, 2048> space;
  for (int bus = 0; bus < kBusCount; ++bus) {
    for (;;) {
      const ssize_t size =
          recv(ears_[static_cast<std::size_t>(bus)].fd(), space.data(), space.size(), MSG_DONTWAIT);
      if (size < 0) break;
      take(bus, {space.data(), static_cast<std::size_t>(size)});
    }
  }
}

void Adversary::take(int bus, std::span<const std::uint8_t> datagram) {
  if (datagram.size() <= kLcmHeaderBytes || std::memcmp(datagram.data(), "LC02", 4) != 0) return;
  const auto rest = datagram.subspan(kLcmHeaderBytes);
  const auto end = std::find(rest.begin(), rest.end(), std::uint8_t{0});
  if (end == rest.end()) return;
  Packet packet{bus, std::string(rest.begin(), end), {end + 1, rest.end()}};
  if (packet.message.size() < kHeaderBytes || forged(packet.channel, packet.message)) return;
  const auto world =
      decode(std::as_bytes(std::span(packet.message)), 0, authenticator_, packet.channel);
  if (const auto* state = world ? std::get_if<WorldState>(&*world) : nullptr) {
    tick_ = std::max(tick_, state->header.tick);
    missed_deadlines_ = std::max(missed_deadlines_, state->missed_deadlines);
  }
  if (sent_ == 0 && heard_.size() < kMostKept) heard_.push_back(std::move(packet));
}

/// The packet with one to four changes, so that it differs from all recorded ones.
Adversary::Packet Adversary::damaged(const Packet& original) {
  Packet packet = original;
  const std::size_t size = packet.message.size();
  packet.message.resize(size + 64);
  std::size_t now = size;
  for (std::size_t changes = 1 + dice_.below(4); changes > 0; --changes) {
    now = mutate_datagram(packet.message, now, dice_);
  }
  packet.message.resize(now);
  if (packet.message == original.message) packet.message[dice_.below(now)] ^= 1;
  // An attacker without a key can compute the tag that a team without a key uses.
  if (authenticator_.keyed() && now >= kHeaderBytes && dice_.below(2) == 0) retag(packet.message);
  if (dice_.below(8) == 0) packet.channel = heard_[dice_.below(heard_.size())].channel;
  if (dice_.below(64) == 0) packet.channel += static_cast<char>('0' + dice_.below(10));
  if (dice_.below(5) == 0) packet.bus = static_cast<int>(dice_.below(kBusCount));
  return packet;
}

std::vector<std::uint8_t> Adversary::wrapped(const Packet& packet) {
  std::vector<std::uint8_t> datagram = {'L', 'C', '0', '2'};
  for (int i = 0; i < 4; ++i) datagram.push_back(static_cast<std::uint8_t>(dice_.next()));
  datagram.insert(datagram.end(), packet.channel.begin(), packet.channel.end());
  datagram.push_back(0);
  datagram.insert(datagram.end(), packet.message.begin(), packet.message.end());
  return datagram;
}

void Adversary::strike() {
  Packet packet = damaged(heard_[dice_.below(heard_.size())]);
  const std::size_t what = dice_.below(32);
  if (what == 0) {  // noise under a valid name
    packet.message.resize(dice_.below(dice_.below(16) == 0 ? kMostBytes : 1400));
    for (std::uint8_t& byte : packet.message) byte = static_cast<std::uint8_t>(dice_.next());
  }
  forgeries_.insert(mark(packet.channel, packet.message));
  std::vector<std::uint8_t> datagram = wrapped(packet);
  if (what == 1) datagram.resize(dice_.below(datagram.size()));  // cut off
  if (what == 2) datagram[dice_.below(kLcmHeaderBytes)] = static_cast<std::uint8_t>(dice_.next());
  if (what == 3) std::replace(datagram.begin(), datagram.end(), std::uint8_t{0}, std::uint8_t{1});
  // A crafted fragment header can crash LCM's library. No program that uses it can prevent this.
  if (datagram.size() >= 4 && std::memcmp(datagram.data(), "LC03", 4) == 0) datagram[3] = '4';
  const sockaddr_in to = address_of(url_.group, url_.base_port + packet.bus);
  sendto(mouth_.fd(), datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to),
         sizeof to);
  ++sent_;
}

}  // namespace ergocast::fuzz
