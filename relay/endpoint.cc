// SPDX-License-Identifier: BSD-3-Clause
// Converts between the system's addresses and ours.
#include "relay/endpoint.h"

#include <netdb.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

#include "relay/packets.h"
#include "text/read_number.h"

namespace ergocast::relay {
namespace {

constexpr std::size_t kIpv4At = 12;

Address from_system(const sockaddr_in6& system) {
  Address address;
  std::memcpy(address.ip.data(), &system.sin6_addr, address.ip.size());
  address.port = ntohs(system.sin6_port);
  address.interface = system.sin6_scope_id;
  return address;
}

Address from_system(const sockaddr_in& system) {
  Address address;
  address.ip[10] = address.ip[11] = 0xff;
  std::memcpy(&address.ip[kIpv4At], &system.sin_addr, sizeof system.sin_addr);
  address.port = ntohs(system.sin_port);
  return address;
}

/// The system's address of the kind that the socket has, and its length.
struct SystemAddress {
  sockaddr_storage storage{};
  socklen_t length = 0;
};

SystemAddress to_system(const Address& address, bool ipv6) {
  SystemAddress system;
  if (ipv6) {
    sockaddr_in6 to{};
    to.sin6_family = AF_INET6;
    to.sin6_port = htons(address.port);
    to.sin6_scope_id = address.interface;
    std::memcpy(&to.sin6_addr, address.ip.data(), address.ip.size());
    system.length = sizeof to;
    std::memcpy(&system.storage, &to, sizeof to);
    return system;
  }
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(address.port);
  std::memcpy(&to.sin_addr, &address.ip[kIpv4At], sizeof to.sin_addr);
  system.length = sizeof to;
  std::memcpy(&system.storage, &to, sizeof to);
  return system;
}

std::string no_place(std::string_view text) {
  return "'" + std::string(text) +
         "' is not HOST:PORT, such as hub.example.org:7700 or [2001:db8::1]:7700";
}

/// What getaddrinfo() finds; the caller frees it.
int find(const HostAndPort& name, int flags, addrinfo** first) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV | flags;
  return getaddrinfo(name.host.empty() ? "::" : name.host.c_str(),
                     std::to_string(name.port).c_str(), &hints, first);
}

Address to_address(const sockaddr_storage& system) {
  if (system.ss_family == AF_INET6) {
    sockaddr_in6 from;
    std::memcpy(&from, &system, sizeof from);
    return from_system(from);
  }
  sockaddr_in from;
  std::memcpy(&from, &system, sizeof from);
  return from_system(from);
}

/// Whether it is :: or 0.0.0.0.
bool is_every_address(const Address& address) {
  constexpr Address kIpv4{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff}};
  return address.ip == Address().ip || address.ip == kIpv4.ip;
}

/// Room for the kernel's note on a packet: this host's address, and the interface.
union Note {
  cmsghdr header;
  std::array<char, CMSG_SPACE(sizeof(in6_pktinfo))> bytes;
};

std::array<std::uint8_t, 16> our_address(msghdr& message) {
  Address ours;
  for (cmsghdr* note = CMSG_FIRSTHDR(&message); note != nullptr;
       note = CMSG_NXTHDR(&message, note)) {
    if (note->cmsg_level == IPPROTO_IPV6 && note->cmsg_type == IPV6_PKTINFO) {
      std::memcpy(ours.ip.data(), CMSG_DATA(note) + offsetof(in6_pktinfo, ipi6_addr),
                  sizeof(in6_addr));
    } else if (note->cmsg_level == IPPROTO_IP && note->cmsg_type == IP_PKTINFO) {
      sockaddr_in at{};
      // ipi_addr has where the packet was sent, which may be a broadcast address.
      std::memcpy(&at.sin_addr, CMSG_DATA(note) + offsetof(in_pktinfo, ipi_spec_dst),
                  sizeof at.sin_addr);
      ours = from_system(at);
    }
  }
  return ours.ip;
}

/// Makes a message leave from that address.
void set_our_address(msghdr& message, Note& space, const Address& to, bool ipv6) {
  const auto write = [&](int level, int type, const auto& info) {
    message.msg_control = &space;
    message.msg_controllen = CMSG_SPACE(sizeof info);
    space.header.cmsg_level = level;
    space.header.cmsg_type = type;
    space.header.cmsg_len = CMSG_LEN(sizeof info);
    std::memcpy(CMSG_DATA(&space.header), &info, sizeof info);
  };
  if (ipv6) {
    in6_pktinfo info{};
    std::memcpy(&info.ipi6_addr, to.ours.data(), sizeof info.ipi6_addr);
    info.ipi6_ifindex = to.interface;
    write(IPPROTO_IPV6, IPV6_PKTINFO, info);
  } else {
    in_pktinfo info{};
    std::memcpy(&info.ipi_spec_dst, &to.ours[kIpv4At], sizeof info.ipi_spec_dst);
    write(IPPROTO_IP, IP_PKTINFO, info);
  }
}

}  // namespace

Result<HostAndPort> HostAndPort::parse(std::string_view text) {
  const auto wrong = [&] { return failure(no_place(text)); };
  const std::size_t colon = text.rfind(':');
  if (colon == text.npos) return wrong();
  std::string_view host = text.substr(0, colon);
  const auto port = read_number<int>(text.substr(colon + 1));
  if (!port || *port < 1 || *port > 65535) return wrong();
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != host.npos) {
    return wrong();
  }
  return HostAndPort{std::string(host), static_cast<std::uint16_t>(*port)};
}

Result<HostAndPort> HostAndPort::parse_hub(std::string_view text) {
  auto place = parse(text);
  if (place && place->host.empty()) return failure(no_place(text));
  return place;
}

std::string to_text(const HostAndPort& place) {
  const bool ipv6 = place.host.find(':') != place.host.npos;
  return (ipv6 ? '[' + place.host + ']' : place.host) + ':' + std::to_string(place.port);
}

// AI_ADDRCONFIG leaves out addresses of a kind that this host has only on its loopback. A
// literal needs no name server, and so no such choice.
Result<std::vector<Address>> look_up(const HostAndPort& name) {
  addrinfo* first = nullptr;
  int error = find(name, AI_NUMERICHOST, &first);
  if (error == EAI_NONAME) error = find(name, AI_ADDRCONFIG, &first);
  if (error != 0) return failure(name.host + ": " + gai_strerror(error));
  std::vector<Address> addresses;
  for (const addrinfo* one = first; one != nullptr; one = one->ai_next) {
    sockaddr_storage system{};
    std::memcpy(&system, one->ai_addr, one->ai_addrlen);
    addresses.push_back(to_address(system));
  }
  freeaddrinfo(first);
  return addresses;
}

Result<Endpoint> Endpoint::open(const std::optional<Address>& at) {
  const int no = 0, buffer_bytes = 4 << 20;
  bool ipv6 = true;
  Socket socket(AF_INET6, SOCK_DGRAM);
  if (socket.fd() >= 0) setsockopt(socket.fd(), IPPROTO_IPV6, IPV6_V6ONLY, &no, sizeof no);
  if (socket.fd() < 0) {
    socket = Socket(AF_INET, SOCK_DGRAM);
    ipv6 = false;
  }
  if (socket.fd() < 0) return failure(no_socket(errno));
  setsockopt(socket.fd(), SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof buffer_bytes);
  if (at) {
    const SystemAddress system = to_system(*at, ipv6);
    if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&system.storage), system.length) != 0) {
      return failure(to_text(*at) + ": " + std::strerror(errno));
    }
    if (is_every_address(*at)) {
      const int yes = 1;
      setsockopt(socket.fd(), ipv6 ? IPPROTO_IPV6 : IPPROTO_IP,
                 ipv6 ? IPV6_RECVPKTINFO : IP_PKTINFO, &yes, sizeof yes);
    }
  }
  return Endpoint(std::move(socket), ipv6);
}

std::optional<Endpoint::Received> Endpoint::receive(std::vector<std::byte>& space) {
  space.resize(kMaxGroupBytes);
  sockaddr_storage system{};
  Note note{};
  iovec part{space.data(), space.size()};
  msghdr message{};
  message.msg_name = &system;
  message.msg_namelen = sizeof system;
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = &note;
  message.msg_controllen = sizeof note;
  const ssize_t size = recvmsg(fd(), &message, MSG_DONTWAIT);
  if (size < 0) return std::nullopt;
  Address from = to_address(system);
  from.ours = our_address(message);
  return Received{std::span(space).first(static_cast<std::size_t>(size)), from};
}

void Endpoint::send(const Packet& packet) {
  SystemAddress system = to_system(packet.to, ipv6_);
  Note note{};
  iovec part{const_cast<std::byte*>(packet.bytes.data()), packet.bytes.size()};
  msghdr message{};
  message.msg_name = &system.storage;
  message.msg_namelen = system.length;
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  if (packet.to.ours != Address().ours) set_our_address(message, note, packet.to, ipv6_);
  if (sendmsg(fd(), &message, MSG_DONTWAIT) < 0) ++not_sent_;
}

// ---- names ----

Resolver::Resolver() : shared_(std::make_shared<Shared>(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))) {
  std::thread([shared = shared_] { work(shared); }).detach();
}

Resolver::~Resolver() {
  const std::lock_guard lock(shared_->mutex);
  shared_->ends = true;
  shared_->asked.notify_one();
}

void Resolver::ask(const HostAndPort& name) {
  const std::lock_guard lock(shared_->mutex);
  shared_->question = name;
  shared_->asked.notify_one();
}

std::optional<Result<std::vector<Address>>> Resolver::take() {
  std::uint64_t wakes = 0;
  [[maybe_unused]] const ssize_t none = read(fd(), &wakes, sizeof wakes);
  const std::lock_guard lock(shared_->mutex);
  return std::exchange(shared_->answer, std::nullopt);
}

void Resolver::work(const std::shared_ptr<Shared>& shared) {
  std::unique_lock lock(shared->mutex);
  for (;;) {
    shared->asked.wait(lock, [&] { return shared->question || shared->ends; });
    if (shared->ends) return;
    const HostAndPort name = *std::exchange(shared->question, std::nullopt);
    lock.unlock();
    auto found = look_up(name);
    lock.lock();
    shared->answer = std::move(found);
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t none = write(shared->wake.fd(), &one, sizeof one);
  }
}

}  // namespace ergocast::relay
