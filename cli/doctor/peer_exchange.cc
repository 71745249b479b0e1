// SPDX-License-Identifier: BSD-3-Clause
// Sends a probe in each period and spends the rest of the period reading the probes of other hosts.
#include "cli/doctor/peer_exchange.h"

#include <arpa/inet.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "cli/doctor/group_listener.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/program_options.h"

namespace ergocast::doctor {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kPeriod = std::chrono::nanoseconds(1s) / kProbesPerSecond;

/// Reads the datagrams that have arrived; a limit lets us send also during a flood.
void receive_probes(const Socket& listener, PeerLedger& ledger) {
  std::array<std::byte, 2048> buffer;
  for (int i = 0; i < 256; ++i) {
    sockaddr_in from{};
    socklen_t length = sizeof from;
    const ssize_t size = recvfrom(listener.fd(), buffer.data(), buffer.size(), 0,
                                  reinterpret_cast<sockaddr*>(&from), &length);
    if (size < 0) return;
    const Instant at = now();
    const auto probe = read(std::span(buffer.data(), static_cast<std::size_t>(size)));
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &from.sin_addr, text, sizeof text);
    if (probe) ledger.take(*probe, text, at);
  }
}

void hear_until(Instant deadline, const Socket& listener, PeerLedger& ledger) {
  for (Instant at = now(); at < deadline; at = now()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - at);
    pollfd ready{listener.fd(), POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(left.count())) > 0) receive_probes(listener, ledger);
  }
}

}  // namespace

PeerTest try_peers(const LcmUrl& url, const MessageAuthenticator& authenticator,
                   std::chrono::seconds duration) {
  PeerTest test;
  const Socket listener = group_listener(url.group, url.base_port, test.error);
  if (!test.error.empty()) return test;
  const Socket sender(AF_INET, SOCK_DGRAM);
  const auto ttl = static_cast<unsigned char>(url.ttl);
  setsockopt(sender.fd(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  const sockaddr_in group = address_of(url.group, url.base_port);

  PeerLedger ledger(random_identity(), host_name(), version(), authenticator.fingerprint());
  std::vector<std::byte> bytes;
  const auto count = static_cast<std::uint32_t>(duration.count() * kProbesPerSecond);
  const Instant start = now();
  std::uint32_t unsent = 0;
  std::string problem;
  for (std::uint32_t i = 1; i <= count; ++i) {
    write(ledger.next(now()), bytes);
    if (sendto(sender.fd(), bytes.data(), bytes.size(), 0,
               reinterpret_cast<const sockaddr*>(&group), sizeof group) < 0) {
      ++unsent;
      problem = std::string("cannot send: ") + std::strerror(errno);
    }
    hear_until(start + i * kPeriod, listener, ledger);
  }
  // A single failure counts as an ordinary loss.
  if (unsent == count) test.error = problem;
  test.peers = ledger.peers();
  test.only_received_by_others = ledger.only_received_by_others();
  test.sent = ledger.sent();
  return test;
}

}  // namespace ergocast::doctor
