// SPDX-License-Identifier: BSD-3-Clause
// A hub: passes what one site sends on to all others, and to a local group if it has one.
//
// A hub cannot forge messages, because sites check the tags. It can withhold or delay them, which
// shows as silence.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "core/base/ids.h"
#include "relay/address.h"
#include "relay/carrier.h"
#include "relay/packets.h"

namespace ergocast::relay {

class Hub {
 public:
  struct Settings {
    bool has_group = false;             ///< a peer: it has a site of its own
    std::int64_t most_bytes_per_s = 0;  ///< to each site; 0: no limit but the site's
    bool others = false;                ///< Gate
    MissionKey::Secret secret{};        ///< random, for cookies
  };
  /// Limit (Network): sites of a hub. Beyond it: no further site joins.
  static constexpr std::size_t kMostSites = 256;
  /// Limit (Time): silence of a site at a hub [s]. Beyond it: the hub forgets the site, which joins
  /// again.
  static constexpr std::chrono::nanoseconds kSilence = std::chrono::seconds(10);

  /// How long a site that joins is given the stops of the last minute, which may be lost.
  static constexpr std::chrono::nanoseconds kGivesStops = std::chrono::seconds(5);
  /// How long a site receives commands after a world, driver or logger there has sent anything.
  static constexpr std::chrono::nanoseconds kCommanded = std::chrono::seconds(10);

  Hub(const Settings& settings, const MessageAuthenticator& authenticator);

  /// A datagram of the local group.
  void take_local(Bus bus, std::span<const std::byte> datagram, Instant now);
  /// A packet of any sender.
  void receive(std::span<const std::byte> packet, const Address& from, Instant now, Outbox& out);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  std::size_t sites() const { return members_.size(); }
  Counts counts() const;
  /// For people: how many sites there are, and of as many as fit kMaxReportLength, how they are.
  std::string report(Instant now) const;

 private:
  struct Member {
    Member(const Join& join, std::int64_t most_bytes_per_s, Instant now)
        : site(join.site),
          count(join.count),
          last_received(now),
          joined(now),
          commanded_until(now + kCommanded),
          sender(most_bytes_per_s) {}
    SiteId site;
    std::int64_t count;  // of its newest Join or Ping
    Instant last_received, joined, commanded_until;
    Sender sender;
    FlowCounts ours, theirs;             // theirs as of the newest Ping
    std::int64_t received_by_ping = 0;   // of ours.packets_received, when that Ping came
    std::int64_t sent_by_pong = 0;       // of ours.packets_sent, in the newest Pong
    std::int64_t sent_by_last_pong = 0;  // the same of the Pong that theirs is about
    double round_trip_s = 0;
  };
  using Members = std::map<Address, Member>;

  void on(const Ask& ask, const Address& from, Instant now, Outbox& out);
  void on(const Join& join, const Address& from, Instant now, Outbox& out);
  void on(const Ping& ping, const Address& from, Instant now, Outbox& out);
  void on(const Leave& leave, const Address& from, Instant now, Outbox& out);
  void on(const Question& question, const Address& from, Instant now, Outbox& out);
  void on(const auto&, const Address&, Instant, Outbox&) {}
  void on_data(Member& member, std::span<const std::byte> packet, Instant now, Outbox& out);
  void send(const Control& control, const Address& to, Outbox& out) const;
  /// @param from  null: the local group
  void queue(const Admitted& admitted, const GroupDatagram& datagram, Member* from, Instant now);
  void remove(Members::iterator member);
  bool is_replay(SiteId site, std::int64_t count) const;

  Settings settings_;
  Seal seal_;
  CookieJar jar_;
  Carrier carrier_;
  Members members_;
  Instant commanded_until_{};  // the latest of all sites, with the local group
};

}  // namespace ergocast::relay
