// SPDX-License-Identifier: BSD-3-Clause
// Binds a non-blocking socket to the group's address, which other sockets may share, and joins
// the group.
#include "ops/doctor/group_listener.h"

#include <cerrno>
#include <cstring>

namespace ergocast::doctor {

Socket group_listener(const std::string& group, int port, std::string& error) {
  Socket socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK);
  const int yes = 1;
  const sockaddr_in address = address_of(group, port);
  const ip_mreq membership{address.sin_addr, {htonl(INADDR_ANY)}};
  setsockopt(socket.fd(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    error = std::string("cannot open the port: ") + std::strerror(errno);
  } else if (setsockopt(socket.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership,
                        sizeof membership) != 0) {
    error = std::string("cannot listen to the group: ") + std::strerror(errno);
  }
  return socket;
}

}  // namespace ergocast::doctor
