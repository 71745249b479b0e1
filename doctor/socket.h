// A socket that closes itself, and one that listens to a group beside LCM's.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <utility>

namespace ergocast::doctor {

class Socket {
 public:
  explicit Socket(int family, int type, int protocol = 0)
      : fd_(socket(family, type | SOCK_CLOEXEC, protocol)) {}
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket& operator=(Socket&&) = delete;
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  int fd() const { return fd_; }  ///< negative: the kernel refused

 private:
  int fd_;
};

sockaddr_in address_of(const std::string& group, int port);

/// Hears what is sent to the group and port, and no other group's; shares the port as LCM does.
/// Its fd() is valid even if `error` says why it hears nothing.
Socket group_listener(const std::string& group, int port, std::string& error);

}  // namespace ergocast::doctor
