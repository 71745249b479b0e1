// SPDX-License-Identifier: BSD-3-Clause
// Renews the membership of sockets in the multicast group. A membership belongs to one network
// interface and ends with it. Without renewal, a process would receive nothing after its network
// adapter was replaced or its container was reconnected.
#pragma once

#include <netinet/in.h>

#include <vector>

#include "runtime/bus/lcm_url.h"

namespace ergocast {

class GroupMembership {
 public:
  /// @param sockets  those that have joined the group of `url`
  GroupMembership(const LcmUrl& url, std::vector<int> sockets);

  /// Joins the group on the interface of the current route, if it is not the one joined before.
  /// @return whether the interface changed
  bool renew();

 private:
  in_addr group_;
  std::vector<int> sockets_;
  unsigned interface_;  // the joined interface; 0: unknown
};

}  // namespace ergocast
