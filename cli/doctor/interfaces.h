// SPDX-License-Identifier: BSD-3-Clause
// This host's network interfaces, and the interface that the kernel uses for a multicast group.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ergocast::doctor {

struct Interface {
  std::string name;
  bool up = false;
  bool carrier = false;  ///< the link is up
  bool loopback = false;
  bool multicast = false;
  int mtu_bytes = 0;
  std::string address;  ///< its first IPv4 address; empty: none

  /// Whether a team on several hosts can use it.
  bool reaches_others() const { return up && multicast && !loopback && !address.empty(); }
};

/// The interfaces of this network namespace, in the kernel's order.
std::vector<Interface> interfaces();

/// The interface for datagrams to `group`, the one that `ip route get` prints; nothing if there is
/// no route.
std::optional<std::string> routed_interface(const std::string& group);

}  // namespace ergocast::doctor
