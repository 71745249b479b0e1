// SPDX-License-Identifier: BSD-3-Clause
// Sockets as runtime/bus opens them, but without a codec: a relay changes no byte.
#include "relay/local_group.h"

#include <cerrno>
#include <utility>

#include "relay/packets.h"
#include "runtime/bus/datagram_filter.h"
#include "runtime/bus/group_socket.h"
#include "runtime/bus/self_test.h"

namespace ergocast::relay {

LocalGroup::LocalGroup(const LcmUrl& url) : writer_(AF_INET, SOCK_DGRAM), space_(kMaxGroupBytes) {
  for (std::size_t bus = 0; bus < kBusCount; ++bus) {
    buses_[bus] = address_of(url.group, url.base_port + static_cast<int>(bus));
  }
  const unsigned char ttl = static_cast<unsigned char>(url.ttl), loop = 1;
  setsockopt(writer_.fd(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  setsockopt(writer_.fd(), IPPROTO_IP, IP_MULTICAST_LOOP, &loop, sizeof loop);
}

Result<LocalGroup> LocalGroup::open(const LcmUrl& url, bool others) {
  if (const auto problem = why_unreachable(url)) return failure(*problem);
  LocalGroup group(url);
  if (group.writer_.fd() < 0) return failure(url.base() + ": " + no_socket(errno));
  const int buffer_bytes = url.receive_buffer();
  for (const Bus bus : {Bus::kSwarm, Bus::kWorld, Bus::kCommand}) {
    Socket reader(AF_INET, SOCK_DGRAM);
    setsockopt(reader.fd(), SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof buffer_bytes);
    if (!others) admit_only(reader.fd(), kEveryType);
    const int port = url.base_port + static_cast<int>(bus);
    if (const auto problem = listen_to_group(reader, url.group, port)) {
      return failure(url.of(bus) + ": " + *problem);
    }
    if (const auto problem = why_deaf(url, bus)) return failure(*problem);
    group.readers_.push_back(std::move(reader));
  }
  const auto fds = group.fds();
  group.membership_.emplace(url, std::vector<int>(fds.begin(), fds.end()));
  return group;
}

std::array<int, kBusCount> LocalGroup::fds() const {
  return {readers_[0].fd(), readers_[1].fd(), readers_[2].fd()};
}

void LocalGroup::receive(std::size_t most,
                         const std::function<void(Bus, std::span<const std::byte>)>& on_datagram) {
  for (std::size_t bus = 0; bus < kBusCount; ++bus) {
    for (std::size_t i = 0; i < most; ++i) {
      const ssize_t size = recv(readers_[bus].fd(), space_.data(), space_.size(), MSG_DONTWAIT);
      if (size < 0) break;
      on_datagram(static_cast<Bus>(bus), std::span(space_).first(static_cast<std::size_t>(size)));
    }
  }
}

void LocalGroup::send(const GroupDatagram& datagram) {
  const sockaddr_in& to = buses_[static_cast<std::size_t>(datagram.bus)];
  sendto(writer_.fd(), datagram.bytes.data(), datagram.bytes.size(), MSG_DONTWAIT,
         reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

}  // namespace ergocast::relay
