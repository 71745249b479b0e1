// SPDX-License-Identifier: BSD-3-Clause
// Preloaded into programs, stops one of them as SIGSTOP from outside would, but at the exact
// message that a test names: the first program that is about to send on a channel a message with
// that tick or a later one in its header.
//   ERGOCAST_HOLD="CHANNEL TICK FILE"   the program that removes FILE is stopped, and no other
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>

namespace {

struct Hold {
  std::string channel, file;
  std::int64_t tick = 0;
};

const Hold& hold() {
  static const Hold hold = [] {
    const char* wanted = std::getenv("ERGOCAST_HOLD");
    std::istringstream words(wanted != nullptr ? wanted : "");
    Hold hold;
    words >> hold.channel >> hold.tick >> hold.file;
    return hold;
  }();
  return hold;
}

std::string bytes_of(const msghdr& message) {
  std::string bytes;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) {
    bytes.append(static_cast<const char*>(message.msg_iov[i].iov_base), message.msg_iov[i].iov_len);
  }
  return bytes;
}

/// The tick of a message on the selected channel; nothing for any other.
std::optional<std::int64_t> tick_of(const std::string& datagram) {
  constexpr std::size_t kName = 8, kTick = 36;  // after LCM's own header; in our message
  const std::size_t at = kName + hold().channel.size() + 1 + kTick;
  if (datagram.size() < at + 8 || datagram.c_str() + kName != hold().channel) return {};
  std::uint64_t tick = 0;
  for (std::size_t i = at; i < at + 8; ++i) {
    tick = tick << 8 | static_cast<unsigned char>(datagram[i]);
  }
  return static_cast<std::int64_t>(tick);
}

}  // namespace

extern "C" int sendmmsg(int fd, mmsghdr* messages, unsigned count, int flags) noexcept {
  for (unsigned i = 0; i < count && !hold().channel.empty(); ++i) {
    if (tick_of(bytes_of(messages[i].msg_hdr)) < hold().tick) continue;
    // Those before it are sent; the caller comes back with the rest.
    if (i > 0) return static_cast<int>(syscall(SYS_sendmmsg, fd, messages, i, flags));
    if (unlink(hold().file.c_str()) == 0) raise(SIGSTOP);
    break;
  }
  return static_cast<int>(syscall(SYS_sendmmsg, fd, messages, count, flags));
}
