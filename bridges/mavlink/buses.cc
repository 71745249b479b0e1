// SPDX-License-Identifier: BSD-3-Clause
// A datagram is "LC02", a number, the channel, a zero byte and the message.
#include "bridges/mavlink/buses.h"

#include <arpa/inet.h>
#include <ergocast/lcmtypes/channels.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

namespace ergocast::mavlink {
namespace {

constexpr int kReceiveBufferBytes = 4 << 20;
/// In one turn, so that a flood does not keep setpoints from being sent.
constexpr int kMostDatagrams = 256;

sockaddr_in address_of(const BusUrl& url, int bus) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<in_port_t>(url.port + bus));
  inet_pton(AF_INET, url.group.c_str(), &address.sin_addr);
  return address;
}

bool has_number(std::string_view text, int low, int high, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
}

bool listen_to(int fd, const sockaddr_in& address) {
  const int yes = 1;
  const ip_mreq group{address.sin_addr, {htonl(INADDR_ANY)}};
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes);
  return setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
         bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
         setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) == 0;
}

}  // namespace

Result<BusUrl> BusUrl::parse(std::string_view text) {
  const auto wrong = failure("'" + std::string(text) +
                             "' is not an LCM URL, such as udpm://239.255.76.67:24000?ttl=1");
  constexpr std::string_view kScheme = "udpm://", kTtl = "ttl=";
  if (!text.starts_with(kScheme)) return wrong;
  std::string_view rest = text.substr(kScheme.size());
  const auto question = rest.find('?');
  std::string_view options = question == rest.npos ? "" : rest.substr(question + 1);
  rest = rest.substr(0, question);
  const auto colon = rest.find(':');
  BusUrl url;
  if (colon == rest.npos || !has_number(rest.substr(colon + 1), 1, 65533, url.port)) return wrong;
  url.group = rest.substr(0, colon);
  in_addr group{};
  if (inet_pton(AF_INET, url.group.c_str(), &group) != 1 || !IN_MULTICAST(ntohl(group.s_addr)))
    return wrong;
  while (!options.empty()) {
    const std::string_view one = options.substr(0, options.find('&'));
    options.remove_prefix(std::min(options.size(), one.size() + 1));
    if (one.starts_with("recv_buf_size=")) continue;
    if (!one.starts_with(kTtl) || !has_number(one.substr(kTtl.size()), 0, 255, url.ttl))
      return wrong;
  }
  return url;
}

Result<Buses> Buses::open(const BusUrl& url, const Subscriptions& subscriptions,
                          const MessageAuthenticator& authenticator) {
  Buses buses;
  buses.url_ = url;
  buses.subscriptions_ = subscriptions;
  buses.authenticator_ = authenticator;
  const auto failed = [&] {
    return failure(url.group + ":" + std::to_string(url.port) + ": " + std::strerror(errno) +
                   "; `ergocast doctor` says what is missing");
  };
  constexpr int kKind = SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC;
  buses.sender_ = socket(AF_INET, kKind, 0);
  const auto ttl = static_cast<unsigned char>(url.ttl);
  if (buses.sender_ < 0 ||
      setsockopt(buses.sender_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl) != 0)
    return failed();
  for (int bus = 0; bus < kBusCount; ++bus) {
    const auto at = static_cast<std::size_t>(bus);
    if (subscriptions[at] == 0) continue;
    buses.fds_[at] = socket(AF_INET, kKind, 0);
    if (buses.fds_[at] < 0 || !listen_to(buses.fds_[at], address_of(url, bus))) return failed();
  }
  return buses;
}

Buses::Buses(Buses&& other) noexcept
    : url_(std::move(other.url_)),
      subscriptions_(other.subscriptions_),
      authenticator_(other.authenticator_),
      fds_(other.fds_),
      sender_(std::exchange(other.sender_, -1)) {
  other.fds_.fill(-1);
}

Buses::~Buses() {
  for (const int fd : fds_) {
    if (fd >= 0) close(fd);
  }
  if (sender_ >= 0) close(sender_);
}

void Buses::read(RunId run, const Handler& handler) {
  std::array<char, 65536> in;
  for (int bus = 0; bus < kBusCount; ++bus) {
    const int fd = fds_[static_cast<std::size_t>(bus)];
    for (int i = 0; fd >= 0 && i < kMostDatagrams; ++i) {
      const auto size = recv(fd, in.data(), in.size(), 0);
      if (size < 0) break;
      take({in.data(), static_cast<std::size_t>(size)}, static_cast<Bus>(bus), run, handler);
    }
  }
}

void Buses::take(std::string_view datagram, Bus bus, RunId run, const Handler& handler) {
  constexpr std::size_t kName = 8;
  const std::size_t end = datagram.find('\0', kName);
  if (!datagram.starts_with("LC02") || end == datagram.npos) return;
  const std::string_view channel = datagram.substr(kName, end - kName);
  if (!is_channel_of(subscriptions_[static_cast<std::size_t>(bus)], channel)) return;
  const auto message = decode(std::as_bytes(std::span(datagram.substr(end + 1))), run,
                              authenticator_, channel, &signatures_);
  if (!message) return;
  const auto transmitter = transmitter_of(*message, channel);
  if (transmitter) handler(*message, bus, *transmitter);
}

void Buses::send(const Outbox& out) {
  for (const Outgoing& one : out) {
    const std::string& channel = channel_of(one.message, one.relayer);
    encode(one.message, bytes_, authenticator_, channel);
    const std::uint32_t sequence = htonl(sequence_++);
    std::string datagram = "LC02";
    datagram.append(reinterpret_cast<const char*>(&sequence), sizeof sequence);
    datagram.append(channel).append(1, '\0');
    datagram.append(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    const sockaddr_in to = address_of(url_, static_cast<int>(one.bus));
    sendto(sender_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
  }
}

}  // namespace ergocast::mavlink
