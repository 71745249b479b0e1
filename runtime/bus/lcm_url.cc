// SPDX-License-Identifier: BSD-3-Clause
// Parses the URL strictly, derives the ports of three buses, and reserves free ports with an
// abstract socket.
#include "runtime/bus/lcm_url.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <utility>

#include "runtime/bus/socket.h"
#include "text/read_number.h"

namespace ergocast {
namespace {

constexpr std::string_view kExample = "udpm://239.255.76.67:24000?ttl=0";

std::optional<int> number(std::string_view text, int low, int high) {
  const auto value = read_number<int>(text);
  return value >= low && value <= high ? value : std::nullopt;
}

std::optional<std::string> read_option(std::string_view option, LcmUrl& url) {
  const auto equals = option.find('=');
  const std::string_view name = option.substr(0, equals);
  const std::string_view value = equals == option.npos ? "" : option.substr(equals + 1);
  if (name == "ttl") {
    const auto ttl = number(value, 0, 255);
    if (!ttl) return "ttl must be 0 to 255 (0: this host only, 1: the local network)";
    url.ttl = *ttl;
    return std::nullopt;
  }
  if (name == "recv_buf_size") {
    const auto size = number(value, 2048, 1 << 30);
    if (!size) return "recv_buf_size must be 2048 to 1073741824 bytes";
    url.receive_buffer_bytes = *size;
    return std::nullopt;
  }
  return "unknown option '" + std::string(name) + "': ttl and recv_buf_size are known";
}

template <class Address>
const sockaddr* as_sockaddr(const Address& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

bool port_is_free(int port) {
  // Without SO_REUSEADDR this fails if any socket has the port, also a shared one.
  const Socket probe(AF_INET, SOCK_DGRAM);
  const sockaddr_in any = address_of("0.0.0.0", port);
  return probe.fd() >= 0 && bind(probe.fd(), as_sockaddr(any), sizeof any) == 0;
}

/// Reserves a name that exists once in each network namespace and ends with its process.
int lock_ports(int base_port) {
  const int lock = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (lock < 0) return -1;
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  const std::string text = "ergocast-ports-" + std::to_string(base_port);
  std::memcpy(name.sun_path + 1, text.data(), text.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  if (bind(lock, as_sockaddr(name), length) == 0) return lock;
  close(lock);
  return -1;
}

}  // namespace

Result<LcmUrl> LcmUrl::parse(std::string_view text) {
  const auto wrong = [text](const std::string& what) {
    return failure("'" + std::string(text) + "' is not an LCM URL: " + what + "; for example " +
                   std::string(kExample));
  };
  constexpr std::string_view kScheme = "udpm://";
  if (!text.starts_with(kScheme)) return wrong("it must begin with udpm://");
  std::string_view rest = text.substr(kScheme.size());
  const auto question = rest.find('?');
  std::string_view options = question == rest.npos ? "" : rest.substr(question + 1);
  rest = rest.substr(0, question);

  LcmUrl url;
  const auto colon = rest.find(':');
  if (colon == rest.npos) return wrong("the port is missing");
  url.group = rest.substr(0, colon);
  in_addr group{};
  if (inet_pton(AF_INET, url.group.c_str(), &group) != 1 || !IN_MULTICAST(ntohl(group.s_addr))) {
    return wrong("the group must be an IPv4 multicast address, 224.0.0.0 to 239.255.255.255");
  }
  const auto port = number(rest.substr(colon + 1), 1, 65533);
  if (!port) return wrong("the port must be 1 to 65533 (this one and the next two are used)");
  url.base_port = *port;
  while (!options.empty()) {
    const auto end = options.find('&');
    if (const auto error = read_option(options.substr(0, end), url)) return wrong(*error);
    options = end == options.npos ? "" : options.substr(end + 1);
  }
  return url;
}

std::string LcmUrl::of_port(int port) const {
  std::string text = "udpm://" + group + ":" + std::to_string(port) + "?ttl=" + std::to_string(ttl);
  if (receive_buffer_bytes > 0) {
    text += "&recv_buf_size=" + std::to_string(receive_buffer_bytes);
  }
  return text;
}

std::optional<std::string> why_unreachable(const LcmUrl& url) {
  const std::string remedy =
      "LCM needs a multicast route. As root:\n"
      "  ip link set lo up\n"
      "  ip link set lo multicast on\n"
      "  ip route add 224.0.0.0/4 dev lo      # one host; several: the interface they share\n"
      "Check: ip route get " +
      url.group;
  const auto failed = [&](const char* what) {
    return url.base() + ": " + what + ": " + std::strerror(errno) + "\n" + remedy;
  };
  const Socket socket(AF_INET, SOCK_DGRAM);
  if (socket.fd() < 0) return url.base() + ": " + no_socket(errno);
  const sockaddr_in group = address_of(url.group, 0);
  const sockaddr_in any = address_of("0.0.0.0", 0);
  ip_mreq membership{group.sin_addr, any.sin_addr};
  if (bind(socket.fd(), as_sockaddr(any), sizeof any) != 0) {
    return failed("no UDP socket");
  }
  sockaddr_in own{};
  socklen_t length = sizeof own;
  getsockname(socket.fd(), reinterpret_cast<sockaddr*>(&own), &length);
  if (setsockopt(socket.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0) {
    return failed("cannot join the group");
  }
  // The probe goes to our own port, with a TTL of 0, so that no other host receives it.
  const unsigned char ttl = 0;
  setsockopt(socket.fd(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  sockaddr_in target = group;
  target.sin_port = own.sin_port;
  if (sendto(socket.fd(), "?", 1, 0, as_sockaddr(target), sizeof target) != 1) {
    return failed("cannot send to the group");
  }
  pollfd ready{socket.fd(), POLLIN, 0};
  if (poll(&ready, 1, 1000) == 1) return std::nullopt;
  return url.base() +
         ": a datagram to the group did not come back within 1 s\n"
         "A firewall drops what comes in. As root:\n"
         "  nft list ruleset\n"
         "Check: ergocast doctor --lcm-url '" +
         url.base() + "'";
}

std::optional<PortReservation> PortReservation::take(RunId run) {
  constexpr int kSlots = (kLastBasePort - kFirstBasePort) / 3 + 1;
  for (int i = 0; i < kSlots; ++i) {
    const int slot = static_cast<int>((run % kSlots + static_cast<RunId>(i)) % kSlots);
    const int base = kFirstBasePort + 3 * slot;
    const int lock = lock_ports(base);
    if (lock < 0) continue;
    if (port_is_free(base) && port_is_free(base + 1) && port_is_free(base + 2)) {
      return PortReservation(base, lock);
    }
    close(lock);
  }
  return std::nullopt;
}

PortReservation::PortReservation(PortReservation&& other) noexcept
    : base_port_(other.base_port_), lock_(std::exchange(other.lock_, -1)) {}

PortReservation::~PortReservation() {
  if (lock_ >= 0) close(lock_);
}

}  // namespace ergocast
