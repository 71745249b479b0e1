// SPDX-License-Identifier: BSD-3-Clause
// Parses the kernel's table of UDP sockets, /proc/net/udp: open ports and the inodes of their
// sockets.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace ergocast::doctor {

struct UdpSocket {
  int port = 0;
  unsigned long inode = 0;  ///< links the socket to the processes that hold it
  bool operator==(const UdpSocket&) const = default;
};

/// The sockets in such a table; malformed lines are skipped.
std::vector<UdpSocket> parse_socket_table(std::string_view table);

}  // namespace ergocast::doctor
