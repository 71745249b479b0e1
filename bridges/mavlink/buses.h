// SPDX-License-Identifier: BSD-3-Clause
// The team's three buses: LCM's datagrams over plain UDP sockets, as examples/embed has them.
#pragma once

#include <ergocast/core/base/result.h>
#include <ergocast/lcmtypes/codec.h>
#include <ergocast/team/messages.h>
#include <ergocast/team/subscriptions.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ergocast::mavlink {

/// `udpm://GROUP:PORT?ttl=N`
struct BusUrl {
  std::string group = "239.255.76.67";
  int port = 7667;  ///< of the first of the three buses
  int ttl = 0;

  static Result<BusUrl> parse(std::string_view text);
};

class Buses {
 public:
  /// The error names what the system refuses.
  static Result<Buses> open(const BusUrl& url, const Subscriptions& subscriptions,
                            const MessageAuthenticator& authenticator);
  Buses(Buses&& other) noexcept;
  Buses& operator=(Buses&&) = delete;
  ~Buses();

  using Handler = std::function<void(const Message&, Bus, AgentId transmitter)>;
  /// Passes on what has arrived and is intact. @param run  the only one accepted; 0: any
  void read(RunId run, const Handler& handler);
  void send(const Outbox& out);
  /// To wait for; −1 where nothing is received.
  const std::array<int, kBusCount>& fds() const { return fds_; }

 private:
  Buses() { fds_.fill(-1); }
  void take(std::string_view datagram, Bus bus, RunId run, const Handler& handler);

  BusUrl url_;
  Subscriptions subscriptions_{};
  MessageAuthenticator authenticator_;
  KnownSignatures signatures_;
  std::array<int, kBusCount> fds_;
  int sender_ = -1;
  std::uint32_t sequence_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace ergocast::mavlink
