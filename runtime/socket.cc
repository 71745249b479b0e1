// SPDX-License-Identifier: BSD-3-Clause
// Wraps a descriptor, and finds the descriptors of this process that are bound to given ports.
#include "runtime/socket.h"

#include <arpa/inet.h>

#include <cerrno>
#include <cstring>

namespace ergocast {
namespace {

constexpr int kMaxDescriptors = 256;

/// The UDP port a descriptor is bound to; 0 if it is none, or no such socket.
int bound_port(int fd) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  int type = 0;
  socklen_t type_length = sizeof type;
  if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_length) != 0 || type != SOCK_DGRAM) return 0;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length) != 0) return 0;
  return address.sin_family == AF_INET ? ntohs(address.sin_port) : 0;
}

}  // namespace

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

std::vector<int> sockets_at(int first_port, int count) {
  std::vector<int> sockets;
  for (int fd = 0; fd < kMaxDescriptors; ++fd) {
    const int port = bound_port(fd);
    if (port >= first_port && port < first_port + count) sockets.push_back(fd);
  }
  return sockets;
}

}  // namespace ergocast
