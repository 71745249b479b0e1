// SPDX-License-Identifier: BSD-3-Clause
// The datagram that hosts exchange to test their connection.
//
// A firewall may treat ports differently, so a probe goes to the port that the team will use. It is
// no LCM message and does not begin with LCM's "LC02": an LCM program on that port discards it
// after four bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ergocast::doctor {

inline constexpr int kProbesPerSecond = 20;
inline constexpr int kMaxPeerSeconds = 600;
inline constexpr std::uint32_t kMaxProbes = kProbesPerSecond * kMaxPeerSeconds;
/// Limit (Commands): tests of other hosts that `ergocast doctor --peer` tells apart. Beyond it:
/// others are not shown.
inline constexpr std::size_t kMaxPeers = 24;
/// Every fourth probe is as long as our longest message with LCM's header: 1280 bytes with IP and
/// UDP.
inline constexpr std::size_t kLargeProbeBytes = 1252;
inline constexpr bool is_large(std::uint32_t sequence) { return sequence % 4 == 3; }

/// The number of small and large probes from `first` to `last`.
struct ProbeCount {
  std::uint32_t small = 0, large = 0;
  std::uint32_t all() const { return small + large; }
};
ProbeCount probes_between(std::uint32_t first, std::uint32_t last);

/// The probes that a host has received of another one.
struct Echo {
  std::uint64_t nonce = 0;            ///< the sender of the probes
  std::uint32_t first = 0, last = 0;  ///< sequence numbers
  ProbeCount received;                ///< from first to last, each once
  std::uint64_t held_ns = 0;          ///< from receiving `last` to sending this
};

struct Probe {
  std::uint64_t nonce = 0;  ///< names the test that sends it
  std::uint32_t sequence = 0;
  std::string host, version;
  std::vector<Echo> echoes;
  std::uint64_t key = 0;  ///< the fingerprint of its mission key; 0 without one
};

/// The bytes of `probe`, in `out`. Names are cut at 32 and 16 bytes, echoes at kMaxPeers.
void write(const Probe& probe, std::vector<std::byte>& out);
/// The probe in `bytes`; nothing if a size or number in it is impossible.
std::optional<Probe> read(std::span<const std::byte> bytes);

}  // namespace ergocast::doctor
