// SPDX-License-Identifier: BSD-3-Clause
// An agent of Ergocast in a program of your own: this loop, and plain UDP sockets in LCM's place.
#include <arpa/inet.h>
#include <ergocast/agent/agent.h>
#include <ergocast/lcmtypes/channels.h>
#include <ergocast/lcmtypes/codec.h>
#include <poll.h>

#include <random>

using namespace ergocast;

static Instant now() { return Instant(std::chrono::steady_clock::now().time_since_epoch()); }

static sockaddr_in address_of(int bus) {  // swarm, world and commands: three ports in a row
  return {AF_INET, htons(static_cast<in_port_t>(7667 + bus)), {inet_addr("239.255.76.67")}, {}};
}

static pollfd listen_to(int bus) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0), yes = 1, this_host_only = 0;
  const sockaddr_in address = address_of(bus);
  const ip_mreq group{address.sin_addr, {htonl(INADDR_ANY)}};
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &this_host_only, sizeof this_host_only);
  if (bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0)
    std::exit((std::perror("multicast"), 3));
  return {fd, POLLIN, 0};
}

static void send(int fd, const Outgoing& sent) {  // "LC02", a number, the channel, 0, the message
  std::vector<std::byte> bytes;
  encode(sent.message, bytes);
  std::string datagram = std::string("LC02\0\0\0\0", 8) + channel_of(sent.message, sent.relayer);
  datagram.append(1, '\0').append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const sockaddr_in to = address_of(static_cast<int>(sent.bus));
  sendto(fd, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to),
         sizeof to);
}

static void take(Agent& agent, Bus bus, std::string_view datagram) {
  const std::size_t end = datagram.find('\0', 8);
  if (!datagram.starts_with("LC02") || end == datagram.npos) return;
  const auto read = decode(std::as_bytes(std::span(datagram.substr(end + 1))), agent.run());
  if (!read) return agent.count_refused(read.error());
  const auto transmitter = transmitter_of(*read, datagram.substr(8, end - 8));
  if (transmitter) agent.receive(*read, bus, *transmitter, now());
}

int main() {
  std::random_device dice;
  const Incarnation incarnation = std::uniform_int_distribution<Incarnation>(1)(dice);
  Agent agent({.incarnation = incarnation, .host = "mine", .version = ERGOCAST_VERSION});
  pollfd buses[] = {listen_to(0), listen_to(1), listen_to(2)};
  char in[65536];
  for (Outbox out;; out.clear()) {
    agent.advance(now(), out);
    for (const Outgoing& sent : out) send(buses[0].fd, sent);
    if (agent.finished()) break;
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(agent.next_wakeup() - now());
    poll(buses, kBusCount, static_cast<int>(std::clamp<long>(wait.count(), 0, 1000)));
    for (int bus = 0; bus < kBusCount; ++bus)
      for (long size; (size = recv(buses[bus].fd, in, sizeof in, 0)) >= 0;)
        take(agent, static_cast<Bus>(bus), {in, static_cast<std::size_t>(size)});
  }
  std::printf("agent %d: %s\n", agent.id(), agent.reason().c_str());
  return agent.failed() ? 4 : 0;
}
