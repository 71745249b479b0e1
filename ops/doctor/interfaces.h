// SPDX-License-Identifier: BSD-3-Clause
// This host's network interfaces, and which of them the kernel would send to a group over.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ergocast::doctor {

struct Interface {
  std::string name;
  bool up = false;
  bool carrier = false;  ///< somebody is at the other end
  bool loopback = false;
  bool multicast = false;
  int mtu_bytes = 0;
  std::string address;  ///< its first IPv4 address; empty: none

  /// Whether a team on several hosts could use it.
  bool reaches_others() const { return up && multicast && !loopback && !address.empty(); }
};

/// Of this network namespace, in the kernel's order.
std::vector<Interface> interfaces();

/// The interface over which datagrams to `group` leave, as `ip route get` would say; nothing if
/// there is no route.
std::optional<std::string> routed_interface(const std::string& group);

}  // namespace ergocast::doctor
