// SPDX-License-Identifier: BSD-3-Clause
// The kernel's table of UDP sockets, /proc/net/udp: which ports are taken, and by whom.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace ergocast::doctor {

struct UdpSocket {
  int port = 0;
  unsigned long inode = 0;  ///< by which a process is found to hold it
  bool operator==(const UdpSocket&) const = default;
};

/// The sockets in such a table, as far as it is well formed.
std::vector<UdpSocket> parse_socket_table(std::string_view table);

}  // namespace ergocast::doctor
