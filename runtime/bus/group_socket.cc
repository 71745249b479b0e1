// SPDX-License-Identifier: BSD-3-Clause
// Binds to the group's own address, and joins the group for this socket alone.
#include "runtime/bus/group_socket.h"

#include <cerrno>
#include <cstring>

namespace ergocast {

std::optional<std::string> listen_to_group(const Socket& socket, const std::string& group,
                                           int port) {
  const auto failed = [](const char* what) {
    return std::string(what) + ": " + std::strerror(errno);
  };
  if (socket.fd() < 0) return no_socket(errno);
  const int yes = 1, no = 0;
  const sockaddr_in address = address_of(group, port);
  const ip_mreq membership{address.sin_addr, {htonl(INADDR_ANY)}};
  // LCM sets only this option. With another one, the kernel would not let us share LCM's port.
  setsockopt(socket.fd(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  // Without this, the socket would also receive what another socket's membership brings to this
  // host.
  setsockopt(socket.fd(), IPPROTO_IP, IP_MULTICAST_ALL, &no, sizeof no);
  if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return failed("cannot open the port");
  }
  if (setsockopt(socket.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0) {
    return failed("cannot listen to the group");
  }
  return std::nullopt;
}

}  // namespace ergocast
