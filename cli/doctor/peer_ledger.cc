// SPDX-License-Identifier: BSD-3-Clause
// Counts the probes of each peer by sequence number, and echoes the counts so that both
// directions are known.
#include "cli/doctor/peer_ledger.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/base/require.h"

namespace ergocast::doctor {
namespace {

using namespace std::chrono_literals;

/// A peer that is silent for longer has ended. Its echo stops then, because a longer hold would
/// make the round trip inexact.
constexpr auto kForgotten = 2s;
constexpr std::size_t kMostRumours = 4 * kMaxPeers;

}  // namespace

double Loss::percent(std::uint32_t expected, std::uint32_t received) {
  return expected == 0 ? 0.0 : 100.0 * (1.0 - static_cast<double>(received) / expected);
}

double Peer::round_trip_s(double quantile) const {
  ERGOCAST_REQUIRE(!round_trips_s.empty());
  const auto last = static_cast<double>(round_trips_s.size() - 1);
  return round_trips_s[static_cast<std::size_t>(std::lround(quantile * last))];
}

PeerLedger::PeerLedger(std::uint64_t nonce, std::string host, std::string version,
                       std::uint64_t key)
    : nonce_(nonce), host_(std::move(host)), version_(std::move(version)), key_(key) {}

Probe PeerLedger::next(Instant now) {
  ERGOCAST_REQUIRE(sent_at_.size() < kMaxProbes);
  Probe probe{nonce_, sent(), host_, version_, {}, key_};
  for (const auto& [nonce, row] : rows_) {
    if (now - row.last_at > kForgotten) continue;
    probe.echoes.push_back({nonce, row.first, row.last, row.peer.from_it.received,
                            static_cast<std::uint64_t>((now - row.last_at).count())});
  }
  sent_at_.push_back(now);
  return probe;
}

void PeerLedger::take(const Probe& probe, const std::string& address, Instant now) {
  if (probe.nonce == nonce_) return;  // our own, looped back by multicast
  if (!rows_.contains(probe.nonce) && rows_.size() == kMaxPeers) return;
  Row& row = rows_[probe.nonce];
  row.peer.host = probe.host;
  row.peer.version = probe.version;
  row.peer.key = probe.key;
  row.peer.address = address;
  count(probe, now, row);
  for (const Echo& echo : probe.echoes) {
    if (echo.nonce == nonce_) {
      take_echo(echo, now, row);
    } else if (rumours_.contains(echo.nonce) || rumours_.size() < kMostRumours) {
      auto& rumour =
          rumours_.try_emplace(echo.nonce, SecondHandPeer{echo.last, echo.last}).first->second;
      rumour.last = std::max(rumour.last, echo.last);
    }
  }
}

void PeerLedger::count(const Probe& probe, Instant now, Row& row) {
  if (row.seen.empty()) {
    row.seen.resize(kMaxProbes);
    row.first = row.last = probe.sequence;
    row.last_at = now;
  }
  if (row.seen[probe.sequence]) {
    ++row.peer.duplicates;
    return;
  }
  row.seen[probe.sequence] = true;
  row.first = std::min(row.first, probe.sequence);
  if (probe.sequence > row.last) {
    row.last = probe.sequence;
    row.last_at = now;
  }
  Loss& loss = row.peer.from_it;
  ++(is_large(probe.sequence) ? loss.received.large : loss.received.small);
  loss.expected = probes_between(row.first, row.last);
}

void PeerLedger::take_echo(const Echo& echo, Instant now, Row& row) {
  if (echo.last >= sent()) return;  // of probes we have not sent
  const Loss claim{probes_between(echo.first, echo.last), echo.received};
  auto& known = row.peer.to_it;
  if (!known || claim.expected.all() >= known->expected.all()) known = claim;
  if (row.last_timed && echo.last <= *row.last_timed) return;
  row.last_timed = echo.last;
  const auto trip = now - sent_at_[echo.last] - std::chrono::nanoseconds(echo.held_ns);
  if (trip >= 0ns) row.peer.round_trips_s.push_back(std::chrono::duration<double>(trip).count());
}

std::vector<Peer> PeerLedger::peers() const {
  std::vector<Peer> all;
  for (const auto& [nonce, row] : rows_) {
    all.push_back(row.peer);
    std::sort(all.back().round_trips_s.begin(), all.back().round_trips_s.end());
  }
  std::sort(all.begin(), all.end(), [](const Peer& a, const Peer& b) {
    return std::tie(a.host, a.address) < std::tie(b.host, b.address);
  });
  return all;
}

int PeerLedger::only_received_by_others() const {
  return static_cast<int>(std::count_if(rumours_.begin(), rumours_.end(), [this](const auto& one) {
    const auto& [nonce, rumour] = one;
    return !rows_.contains(nonce) && rumour.last - rumour.first >= kProbesPerSecond;
  }));
}

}  // namespace ergocast::doctor
