// SPDX-License-Identifier: BSD-3-Clause
// A pair of non-blocking SOCK_SEQPACKET sockets.
#include "cli/watch/control_link.h"

#include <sys/socket.h>

namespace ergocast::cli {

std::optional<std::pair<ControlLink, ControlLink>> ControlLink::pair() {
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0)
    return std::nullopt;
  return std::pair(ControlLink(Socket(ends[0])), ControlLink(Socket(ends[1])));
}

std::optional<ControlLink> ControlLink::inherited(int fd) {
  int type = 0;
  socklen_t length = sizeof type;
  const bool found = getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &length) == 0;
  if (!found || type != SOCK_SEQPACKET) return std::nullopt;
  return ControlLink(Socket(fd));
}

bool ControlLink::send(const std::string& text) const {
  if (text.empty() || text.size() > kLongest) return false;
  return ::send(end_.fd(), text.data(), text.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(text.size());
}

std::optional<std::string> ControlLink::receive() const {
  std::string text(kLongest, '\0');
  const ssize_t count = recv(end_.fd(), text.data(), text.size(), 0);
  if (count <= 0) return std::nullopt;
  text.resize(static_cast<std::size_t>(count));
  return text;
}

}  // namespace ergocast::cli
