// SPDX-License-Identifier: BSD-3-Clause
// A site of a team: carries datagrams between its local group and one hub.
//
// A value without socket and clock, as all participants. Hubs are tried in the order of their list.
// A site that has joined a later one goes on to look for the earlier ones, because only sites at
// the same hub receive each other.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "relay/address.h"
#include "relay/carrier.h"
#include "relay/flow.h"
#include "relay/packets.h"

namespace ergocast::relay {

class Site {
 public:
  struct Settings {
    std::size_t hubs = 1;               ///< length of the list, at least 1
    std::int64_t most_bytes_per_s = 0;  ///< in each direction; 0: no limit
    bool others = false;                ///< Gate
  };
  /// Time between two searches of a site without a hub; and of one that has joined a later hub.
  static constexpr std::chrono::nanoseconds kPause = std::chrono::seconds(1);
  static constexpr std::chrono::nanoseconds kPreferredPause = std::chrono::seconds(10);

  Site(const Settings& settings, const MessageAuthenticator& authenticator, SiteId id);
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  /// A datagram of the local group.
  void take_local(Bus bus, std::span<const std::byte> datagram, Instant now);
  /// A packet of any sender.
  void receive(std::span<const std::byte> packet, const Address& from, Instant now, Outbox& out);

  /// The hub whose addresses are needed now. The answer is given to found().
  std::optional<std::size_t> wanted_hub() const { return wanted_; }
  /// @param addresses  of wanted_hub(), in the order in which to try them; none if it has no name
  void found(std::vector<Address> addresses, Instant now);

  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;
  void leave(Outbox& out);

  /// The hub that it has joined, by its place in the list.
  std::optional<std::size_t> joined() const;
  const Flow* flow() const { return flow_ ? &*flow_ : nullptr; }
  Counts counts() const;

 private:
  void search(Instant now);
  void try_next_address(Instant now);
  void adopt_candidate(Instant now);
  void begin_counts();
  void end_flow();
  void send_waiting(Instant now, Outbox& out);

  Settings settings_;
  Seal seal_;
  Flow::Identity identity_;
  std::int64_t count_ = 0;
  Carrier carrier_;
  std::optional<Flow> flow_, candidate_;
  std::size_t flow_hub_ = 0, try_hub_ = 0;
  std::optional<std::size_t> wanted_;
  std::vector<Address> untried_;  // of try_hub_, the next last
  Instant next_search_{};
  std::optional<Sender> sender_;  // while joined
  FlowCounts flow_counts_;
  std::int64_t packets_received_ = 0;  // of the flow
};

}  // namespace ergocast::relay
