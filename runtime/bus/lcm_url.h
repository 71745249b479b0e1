// SPDX-License-Identifier: BSD-3-Clause
// The base URL that determines a run's three buses.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "team/messages.h"

namespace ergocast {

/// Base ports that runs choose for themselves: 24000, 24003, … 26997. Each takes three ports.
inline constexpr int kFirstBasePort = 24000;
inline constexpr int kLastBasePort = 26997;

/// The buffer size requested for each receiving socket, unless the URL has another; the machine may
/// allow less. The buffer holds what arrives while a process waits for a processor, for example the
/// beginning of a flood.
/// Limit (Network): receive buffer that a process asks for on each bus; the kernel may grant less
/// [bytes]. Beyond it: the newest message is lost and counted.
inline constexpr int kReceiveBufferBytes = 4 << 20;

/// `udpm://group:port[?ttl=N&recv_buf_size=N]`. Parsed and checked here, because LCM accepts
/// invalid URLs silently (no port, unknown options).
struct LcmUrl {
  std::string group = "239.255.76.67";
  int base_port = 7667;
  int ttl = 0;                   ///< 0 stays on this host, 1 reaches the local network
  int receive_buffer_bytes = 0;  ///< 0: not given

  /// The URL, or what is wrong with it and how to write it.
  static Result<LcmUrl> parse(std::string_view text);

  int receive_buffer() const {
    return receive_buffer_bytes > 0 ? receive_buffer_bytes : kReceiveBufferBytes;
  }
  std::string base() const { return of_port(base_port); }
  /// Swarm, world and command are ports +0, +1 and +2.
  std::string of(Bus bus) const { return of_port(base_port + static_cast<int>(bus)); }

 private:
  std::string of_port(int port) const;
};

/// Nothing if a datagram to the group comes back; otherwise the cause, with the commands that
/// repair it. Takes a fraction of a second.
std::optional<std::string> why_unreachable(const LcmUrl& url);

/// Three free ports of this network namespace, reserved until this process ends.
class PortReservation {
 public:
  /// Searches from a place that depends on `run`. Nothing if all ports of the range are taken.
  static std::optional<PortReservation> take(RunId run);
  PortReservation(PortReservation&& other) noexcept;
  PortReservation& operator=(PortReservation&&) = delete;
  ~PortReservation();

  int base_port() const { return base_port_; }

 private:
  PortReservation(int base_port, int lock) : base_port_(base_port), lock_(lock) {}
  int base_port_;
  int lock_;
};

}  // namespace ergocast
