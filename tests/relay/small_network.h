// SPDX-License-Identifier: BSD-3-Clause
// Sites, hubs and local groups without a socket: packets and datagrams arrive at once, and the test
// tells the time.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <memory>
#include <vector>

#include "lcmtypes/channels.h"
#include "relay/hub.h"
#include "relay/site.h"
#include "runtime/bus/lcm_datagram.h"
#include "runtime/process/key_file.h"
#include "tests/lcmtypes/sample_messages.h"

namespace ergocast::relay {

using namespace std::chrono_literals;
using Datagram = std::vector<std::byte>;

/// A key that can sign, the same for each number.
inline MessageAuthenticator key(int number) {
  static std::map<int, MissionKey> keys;
  const auto [at, is_new] = keys.try_emplace(number);
  if (is_new) at->second = make_mission_key();
  return MessageAuthenticator(at->second);
}

inline Address address(int host, std::uint16_t port = 7700) {
  Address address;
  address.ip[10] = address.ip[11] = 0xff;
  address.ip[12] = 10;
  address.ip[15] = static_cast<std::uint8_t>(host);
  address.port = port;
  return address;
}

/// A message as LCM sends it, signed if it has a signature.
inline Datagram datagram_of(Message message, const MessageAuthenticator& authenticator,
                            AgentId relayer = kUnassigned) {
  std::visit(
      [](auto& m) {
        if constexpr (requires { m.signature; }) m.signature = {};
      },
      message);
  const std::string& channel = channel_of(message, relayer);
  std::vector<std::byte> bytes;
  encode(message, bytes, authenticator, channel);
  std::array<std::byte, kMaxLcmBytes> space;
  const std::size_t size = write_datagram(space, 7, channel, bytes);
  return {space.begin(), space.begin() + static_cast<std::ptrdiff_t>(size)};
}

inline Message status(std::int64_t sequence, AgentId agent = 3) {
  Message message = test::agent_status();
  std::get<AgentStatus>(message).header.sender = agent;
  std::get<AgentStatus>(message).header.sequence = sequence;
  return message;
}

/// Where everything arrives.
class SmallNetwork {
 public:
  Instant now{1000s};

  Hub& add_hub(int host, const MessageAuthenticator& authenticator = key(1),
               Hub::Settings settings = {}) {
    settings.secret.fill(static_cast<std::byte>(host + secrets_++));
    hubs_[address(host)] = std::make_unique<Hub>(settings, authenticator);
    return *hubs_[address(host)];
  }
  void stop_hub(int host) { hubs_.erase(address(host)); }

  /// A site at that address, with a group of its own unless it shares one.
  Site& add_site(int host, std::vector<int> hubs, int group,
                 const MessageAuthenticator& authenticator = key(1), Site::Settings settings = {}) {
    settings.hubs = hubs.size();
    auto site = std::make_unique<Site>(settings, authenticator, static_cast<SiteId>(1000 + host));
    sites_.push_back({std::move(site), address(host), std::move(hubs), group});
    return *sites_.back().site;
  }
  /// A router gives the site another address.
  void move_site(std::size_t which, int host) { sites_[which].at = address(host); }
  void cut(bool is_cut) { cut_ = is_cut; }

  /// A program of the team sends it into a group.
  void send(int group, const Datagram& datagram, Bus bus = Bus::kSwarm) {
    for (const Place& one : sites_) {
      if (one.group == group) one.site->take_local(bus, datagram, now);
    }
    settle();
  }
  /// What relays have put into a group.
  std::vector<Datagram>& arrived(int group) { return arrived_[group]; }

  void pass(std::chrono::nanoseconds time, std::chrono::nanoseconds step = 100ms) {
    for (const Instant end = now + time; now < end;) {
      now += step;
      settle();
    }
  }
  /// Lets everything act until nothing is on its way.
  void settle() {
    for (bool busy = true; busy;) {
      busy = false;
      for (Place& one : sites_) busy = act(one) || busy;
      for (auto& [at, hub] : hubs_) {
        Outbox out;
        hub->advance(now, out);
        busy = pass_on(out, at, -1) || busy;
      }
    }
  }

  std::int64_t packets = 0;  // that were on the way

 private:
  struct Place {
    std::unique_ptr<Site> site;
    Address at;
    std::vector<int> hubs;
    int group;
  };

  bool act(Place& one) {
    Outbox out;
    one.site->advance(now, out);
    const auto wanted = one.site->wanted_hub();
    if (wanted) one.site->found({address(one.hubs[*wanted])}, now);
    return pass_on(out, one.at, one.group) || wanted;
  }

  /// Returns whether there was anything.
  bool pass_on(Outbox& out, const Address& from, int group) {
    for (const Packet& packet : out.packets) {
      ++packets;
      if (cut_) continue;
      Outbox answer;
      if (const auto hub = hubs_.find(packet.to); hub != hubs_.end()) {
        hub->second->receive(packet.bytes, from, now, answer);
        pass_on(answer, packet.to, -1);
      }
      for (Place& one : sites_) {
        if (one.at != packet.to) continue;
        Outbox more;
        one.site->receive(packet.bytes, from, now, more);
        pass_on(more, one.at, one.group);
      }
    }
    // Every process of a group receives what is sent there, its sender too. In a group with a
    // negative number the test passes that on.
    for (const GroupDatagram& datagram : out.group) {
      arrived_[group].push_back(datagram.bytes);
      for (Place& one : sites_) {
        if (one.group == group && group >= 0)
          one.site->take_local(datagram.bus, datagram.bytes, now);
      }
    }
    return !out.packets.empty() || !out.group.empty();
  }

  std::map<Address, std::unique_ptr<Hub>> hubs_;
  std::vector<Place> sites_;
  std::map<int, std::vector<Datagram>> arrived_;
  int secrets_ = 0;
  bool cut_ = false;
};

}  // namespace ergocast::relay
