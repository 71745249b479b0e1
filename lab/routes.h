// SPDX-License-Identifier: BSD-3-Clause
// Which simulated processes receive what: each from its table of subscriptions.
#pragma once

#include <cstddef>
#include <vector>

#include "lab/network.h"
#include "team/messages.h"
#include "team/subscriptions.h"

namespace ergocast::lab {

class Routes {
 public:
  /// Nodes are added once each, in ascending order.
  void add(NodeId node, const Subscriptions& subscriptions) {
    for (std::size_t bus = 0; bus < kBusCount; ++bus) {
      on_bus_[bus].set(static_cast<std::size_t>(node), subscriptions[bus] != 0);
      for (std::size_t type = 0; type < kMessageTypeCount; ++type) {
        if ((subscriptions[bus] >> type & 1) != 0) listeners_[bus][type].push_back(node);
      }
    }
  }

  /// The nodes that subscribe to any type on this bus.
  const NodeSet& on(Bus bus) const { return on_bus_[static_cast<std::size_t>(bus)]; }
  /// The nodes that subscribe to messages of this type on this bus.
  const std::vector<NodeId>& listeners(Bus bus, const Message& message) const {
    return listeners_[static_cast<std::size_t>(bus)][message.index()];
  }

 private:
  NodeSet on_bus_[kBusCount];
  std::vector<NodeId> listeners_[kBusCount][kMessageTypeCount];
};

}  // namespace ergocast::lab
