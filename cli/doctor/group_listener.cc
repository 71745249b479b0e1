// SPDX-License-Identifier: BSD-3-Clause
// Opens a non-blocking socket for the group.
#include "cli/doctor/group_listener.h"

#include "runtime/bus/group_socket.h"

namespace ergocast::doctor {

Socket group_listener(const std::string& group, int port, std::string& error) {
  Socket socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK);
  if (const auto problem = listen_to_group(socket, group, port)) error = *problem;
  return socket;
}

}  // namespace ergocast::doctor
