// SPDX-License-Identifier: BSD-3-Clause
// Repeats a random datagram until a socket of its own receives it.
#include "runtime/bus/self_test.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>

#include "runtime/bus/clock.h"
#include "runtime/bus/group_socket.h"
#include "runtime/bus/random_identity.h"

namespace ergocast {

namespace {

constexpr auto kPatience = std::chrono::seconds(10);
constexpr auto kRepeatPeriod = std::chrono::milliseconds(100);

using Probe = std::array<std::byte, 16>;

Probe make_probe() {
  Probe probe{};
  const std::uint64_t nonce = random_identity();
  std::memcpy(probe.data(), "ERGOTEST", 8);
  std::memcpy(probe.data() + 8, &nonce, sizeof nonce);
  return probe;
}

/// Whether the probe is received within that time, among any others.
bool comes_back(const Socket& ear, const Probe& probe, Instant deadline) {
  for (Instant at = now(); at < deadline; at = now()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - at);
    pollfd ready{ear.fd(), POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(left.count())) <= 0) continue;
    Probe heard;
    const ssize_t size = recv(ear.fd(), heard.data(), heard.size(), MSG_DONTWAIT | MSG_TRUNC);
    if (size == static_cast<ssize_t>(probe.size()) && heard == probe) return true;
  }
  return false;
}

}  // namespace

std::optional<std::string> why_deaf(const LcmUrl& url, Bus bus) {
  const int port = url.base_port + static_cast<int>(bus);
  const auto failed = [&](const std::string& why) { return url.of(bus) + ": " + why; };
  const Socket ear(AF_INET, SOCK_DGRAM);
  if (const auto problem = listen_to_group(ear, url.group, port)) return failed(*problem);
  const Socket mouth(AF_INET, SOCK_DGRAM);
  if (mouth.fd() < 0) return failed(no_socket(errno));
  const unsigned char ttl = 0;
  setsockopt(mouth.fd(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  const sockaddr_in to = address_of(url.group, port);
  const Probe probe = make_probe();
  const Instant end = now() + kPatience;
  for (Instant at = now(); at < end; at = now()) {
    sendto(mouth.fd(), probe.data(), probe.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
    if (comes_back(ear, probe, std::min(end, at + kRepeatPeriod))) return std::nullopt;
  }
  return failed(
      "LCM's self test failed\n"
      "A firewall drops UDP at this port, in or out. As root:\n  nft list ruleset");
}

}  // namespace ergocast
