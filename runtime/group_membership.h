// SPDX-License-Identifier: BSD-3-Clause
// A socket's membership in LCM's group belongs to one network interface and ends with it: after an
// adapter was unplugged, or a container disconnected from its network, LCM stays deaf on the next
// one. It has no call for that, so its sockets are dealt with here.
#pragma once

#include <netinet/in.h>

#include <vector>

#include "runtime/lcm_url.h"

namespace ergocast {

class GroupMembership {
 public:
  /// Takes note of the sockets of this process that listen to the buses of `url`.
  explicit GroupMembership(const LcmUrl& url);

  /// Joins the group on the interface that leads to it, where that is not the one joined before.
  /// @return whether it was another
  bool renew();

 private:
  in_addr group_;
  std::vector<int> sockets_;
  unsigned interface_;  // joined on; 0: unknown
};

}  // namespace ergocast
