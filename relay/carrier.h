// SPDX-License-Identifier: BSD-3-Clause
// What sites and hubs have in common: the gate, the memory of what was carried, and the counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/base/ids.h"
#include "relay/address.h"
#include "relay/gate.h"
#include "relay/kept_stops.h"
#include "relay/outbound_queue.h"
#include "relay/recent.h"
#include "team/messages.h"

namespace ergocast::relay {

/// What a relay has counted since its start.
struct Counts {
  std::int64_t from_group = 0, to_group = 0;  ///< datagrams
  std::int64_t from_flows = 0, to_flows = 0;
  std::int64_t copies = 0;   ///< carried already within the last second
  std::int64_t no_path = 0;  ///< came while no flow was open
  Dropped dropped;
  RefusalCounts refused{};
  std::int64_t bytes_to_flows = 0;
};

/// Adds what a sender has sent and dropped.
void add(const Sender& sender, Counts& counts);
/// One line for the log.
std::string to_text(const Counts& counts);

class Carrier {
 public:
  Carrier(const MessageAuthenticator& authenticator, bool others) : gate_(authenticator, others) {}

  /// Whether a datagram of the local group is to be carried to the flows.
  /// @param has_path  without one it is not, and does not count as carried when it comes again
  std::optional<Admitted> from_group(Bus bus, std::span<const std::byte> datagram, bool has_path,
                                     Instant now);
  /// One of a flow. `copy` is set if it is a copy of one that was carried.
  std::optional<Admitted> from_flow(const GroupDatagram& datagram, Instant now, bool& copy);
  /// Puts a datagram of a flow into the local group.
  void put(GroupDatagram datagram, const Admitted& admitted, Instant now, Outbox& out);

  /// Queues the stops of the last minute that came before the flow began.
  void give_stops(Sender& sender, Instant begun, Instant now) const {
    stops_.give(sender, begun, now);
  }
  /// Keeps the counts of a sender that is about to be removed.
  void end(const Sender& sender) { add(sender, counts_); }
  /// Without those of senders that are still there.
  Counts counts() const;

 private:
  Gate gate_;
  Recent recent_;
  Echoes echoes_;
  KeptStops stops_;
  Counts counts_;
};

}  // namespace ergocast::relay
