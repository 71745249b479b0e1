// SPDX-License-Identifier: BSD-3-Clause
// Records the peers that this host receives, with their losses in both directions. No socket and no
// clock.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/doctor/probe.h"
#include "core/base/ids.h"

namespace ergocast::doctor {

struct Loss {
  ProbeCount expected, received;
  double small_percent() const { return percent(expected.small, received.small); }
  double large_percent() const { return percent(expected.large, received.large); }
  double percent() const { return percent(expected.all(), received.all()); }

 private:
  static double percent(std::uint32_t expected, std::uint32_t received);
};

/// One test on another host; a host may run several.
struct Peer {
  std::string host, version, address;
  Loss from_it;
  std::optional<Loss> to_it;          ///< as it reports; nothing if it never reports to receive us
  std::vector<double> round_trips_s;  ///< ascending
  std::int64_t duplicates = 0;
  std::uint64_t key = 0;  ///< the fingerprint of its mission key; 0 without one

  /// Whether it sent for long enough (half a second) to report what it receives.
  bool judged() const { return from_it.received.all() >= kProbesPerSecond / 2; }
  /// @pre there are round trips
  double round_trip_s(double quantile) const;
};

class PeerLedger {
 public:
  /// @param key  the fingerprint of ours
  PeerLedger(std::uint64_t nonce, std::string host, std::string version, std::uint64_t key = 0);

  /// The next probe to send. @pre called at most kMaxProbes times
  Probe next(Instant now);
  void take(const Probe& probe, const std::string& address, Instant now);

  std::uint32_t sent() const { return static_cast<std::uint32_t>(sent_at_.size()); }
  /// Sorted by host.
  std::vector<Peer> peers() const;
  /// Tests that another host received for at least a second and this host never received.
  int only_received_by_others() const;

 private:
  struct Row {
    Peer peer;
    std::vector<bool> seen;
    std::uint32_t first = 0, last = 0;
    Instant last_at{};
    std::optional<std::uint32_t> last_timed;  // our probe in the newest round trip
  };
  void count(const Probe& probe, Instant now, Row& row);
  void take_echo(const Echo& echo, Instant now, Row& row);

  std::uint64_t nonce_;
  std::string host_, version_;
  std::uint64_t key_;
  std::vector<Instant> sent_at_;
  std::map<std::uint64_t, Row> rows_;
  struct SecondHandPeer {
    std::uint32_t first = 0, last = 0;
  };
  std::map<std::uint64_t, SecondHandPeer> rumours_;  // by nonce, the peers that other hosts report
};

}  // namespace ergocast::doctor
