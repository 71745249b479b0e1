// SPDX-License-Identifier: BSD-3-Clause
// Explains why there is no socket, and writes addresses as the kernel reads them.
#include "runtime/bus/socket.h"

#include <arpa/inet.h>

#include <cerrno>
#include <cstring>

namespace ergocast {
std::string no_socket(int error) {
  const bool too_many = error == EMFILE || error == ENFILE;
  return std::string("no socket can be opened: ") + std::strerror(error) +
         (too_many ? "; raise the limit of open files, as with ulimit -n 1024" : "");
}

sockaddr_in address_of(const std::string& ip, int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, ip.c_str(), &address.sin_addr);
  return address;
}

}  // namespace ergocast
