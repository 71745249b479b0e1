// SPDX-License-Identifier: BSD-3-Clause
// A socket that closes itself, and addresses to send to.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <utility>

namespace ergocast {

class Socket {
 public:
  Socket(int family, int type, int protocol = 0)
      : fd_(socket(family, type | SOCK_CLOEXEC, protocol)) {}
  /// Takes over an open socket.
  explicit Socket(int fd) : fd_(fd) {}
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  int fd() const { return fd_; }  ///< negative: the kernel refused

 private:
  int fd_;
};

/// What to print when the kernel has refused a socket with `error`: the problem and the remedy.
std::string no_socket(int error);

/// @pre `ip` is an IPv4 address. LcmUrl checks its group for this.
sockaddr_in address_of(const std::string& ip, int port);

}  // namespace ergocast
