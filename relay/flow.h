// SPDX-License-Identifier: BSD-3-Clause
// A site's side of its flow to one address of a hub: asks, joins, and keeps the flow open.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/ids.h"
#include "relay/address.h"
#include "relay/packets.h"

namespace ergocast::relay {

class Flow {
 public:
  enum class State { kAsking, kJoining, kJoined, kLost };

  /// How often a packet without an answer is sent again.
  static constexpr std::chrono::nanoseconds kRepeat = std::chrono::milliseconds(500);
  /// Limit (Time): a relay's site waits for an answer of the hub's address [s]. Beyond it: it tries
  /// the next address or hub.
  static constexpr std::chrono::nanoseconds kPatience = std::chrono::seconds(3);
  static constexpr std::chrono::nanoseconds kPingPeriod = std::chrono::seconds(1);
  /// How long an Unknown is doubted: a Pong comes in that time if the hub does know this address.
  static constexpr std::chrono::nanoseconds kDoubt = kPingPeriod * 3 / 2;
  /// Limit (Time): silence of a hub that a site has joined [s]. Beyond it: the site is cut off, and
  /// looks for a hub.
  static constexpr std::chrono::nanoseconds kSilence = std::chrono::seconds(5);

  struct Identity {
    SiteId site = 0;
    std::int64_t most_bytes_per_s = 0;  ///< to receive; 0: no limit
  };
  /// @param count  of the site's packets with a count, over all of its flows
  Flow(const Seal& seal, const Identity& identity, std::int64_t& count, const Address& hub,
       Instant now);

  const Address& hub() const { return hub_; }
  State state() const { return state_; }
  bool joined() const { return state_ == State::kJoined; }
  /// While joined; 0 before the first measurement.
  double round_trip_s() const { return round_trip_s_; }

  void receive(const Control& control, Instant now);
  /// Sends what is due. @param counts  of this flow, for the hub's report
  void advance(Instant now, const FlowCounts& counts, Outbox& out);
  Instant next_wakeup() const;
  /// Tells the hub that the site leaves.
  void leave(Outbox& out);

 private:
  struct Sent {
    std::int64_t count = 0;
    Instant at{};
  };
  void enter(State state, Instant now);
  const Sent* ping(std::int64_t count) const;
  void send(const Control& control, Outbox& out) const;
  void on(const Cookie& cookie, Instant now);
  void on(const Welcome& welcome, Instant now);
  void on(const Pong& pong, Instant now);
  void on(const Unknown& unknown, Instant now);
  void on(const auto&, Instant) {}

  const Seal& seal_;
  Identity identity_;
  std::int64_t& count_;
  Address hub_;
  State state_ = State::kAsking;
  Instant since_, due_;                   // in this state since; the next packet
  Instant heard_;                         // a Pong, while joined
  std::optional<Instant> unknown_since_;  // the first Unknown after it
  std::array<Sent, 8> pings_{};  // the last, by count: an answer may take longer than a period
  std::int64_t join_count_ = 0;
  std::uint64_t nonce_ = 0;
  CookieBytes cookie_{};
  double round_trip_s_ = 0;
};

}  // namespace ergocast::relay
