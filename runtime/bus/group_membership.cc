// SPDX-License-Identifier: BSD-3-Clause
// Compares the routed interface with the joined one, and moves the memberships if they differ.
#include "runtime/bus/group_membership.h"

#include <utility>

#include "runtime/bus/multicast_route.h"
#include "runtime/bus/socket.h"

namespace ergocast {

GroupMembership::GroupMembership(const LcmUrl& url, std::vector<int> sockets)
    : group_(address_of(url.group, 0).sin_addr),
      sockets_(std::move(sockets)),
      interface_(interface_towards(group_)) {}

bool GroupMembership::renew() {
  const unsigned leads_there = interface_towards(group_);
  if (leads_there == 0) return false;
  const ip_mreqn now{group_, {}, static_cast<int>(leads_there)};
  const ip_mreqn former{group_, {}, static_cast<int>(interface_)};
  bool renewed = false;
  for (const int fd : sockets_) {
    // The kernel refuses this while the membership exists.
    if (setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &now, sizeof now) != 0) continue;
    renewed = true;
    // The kernel allows 20 memberships for each socket and also counts those on removed interfaces.
    if (interface_ != 0 && interface_ != leads_there) {
      setsockopt(fd, IPPROTO_IP, IP_DROP_MEMBERSHIP, &former, sizeof former);
    }
  }
  if (renewed) interface_ = leads_there;
  return renewed;
}

}  // namespace ergocast
