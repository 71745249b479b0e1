// SPDX-License-Identifier: BSD-3-Clause
// Two ledgers probe each other over links that lose, delay or repeat, and both compute the right
// losses.
#include "cli/doctor/peer_ledger.h"

#include <gtest/gtest.h>

#include <chrono>

namespace ergocast::doctor {
namespace {

using namespace std::chrono_literals;

/// Two hosts that probe in turn; two functions of the sequence define the network between them.
struct Pair {
  PeerLedger a{1, "alpha", "0.1.0"}, b{2, "beta", "0.1.0", 77};
  Instant at{1h};

  template <class FromA, class FromB>
  void probe(int count, FromA a_arrives, FromB b_arrives) {
    for (int i = 0; i < count; ++i) {
      at += 25ms;
      const Probe from_a = a.next(at);
      if (a_arrives(from_a.sequence)) b.take(from_a, "10.0.0.1", at + 2ms);
      at += 25ms;
      const Probe from_b = b.next(at);
      if (b_arrives(from_b.sequence)) a.take(from_b, "10.0.0.2", at + 3ms);
    }
  }
};

constexpr auto kAll = [](std::uint32_t) { return true; };
constexpr auto kNone = [](std::uint32_t) { return false; };

TEST(PeerLedger, BothReceiveEachOtherAndKnowIt) {
  Pair pair;
  pair.probe(40, kAll, kAll);
  const auto peers = pair.a.peers();
  ASSERT_EQ(peers.size(), 1u);
  EXPECT_EQ(peers[0].host, "beta");
  EXPECT_EQ(peers[0].address, "10.0.0.2");
  EXPECT_EQ(peers[0].key, 77u);
  EXPECT_EQ(peers[0].from_it.percent(), 0);
  EXPECT_EQ(peers[0].from_it.received.all(), 40u);
  ASSERT_TRUE(peers[0].to_it.has_value());
  EXPECT_EQ(peers[0].to_it->percent(), 0);
  EXPECT_EQ(peers[0].to_it->received.all(), 40u);
  EXPECT_EQ(peers[0].duplicates, 0);
}

TEST(PeerLedger, ARoundTripIsTheTimeOnTheWayAndNotTheTimeHeld) {
  Pair pair;
  pair.probe(40, kAll, kAll);
  const Peer peer = pair.a.peers()[0];
  ASSERT_EQ(peer.round_trips_s.size(), 40u);
  for (const double quantile : {0.0, 0.5, 0.99, 1.0}) {
    EXPECT_NEAR(peer.round_trip_s(quantile), 0.005, 1e-9);
  }
}

TEST(PeerLedger, OneWayShowsOnTheSideThatReceives) {
  Pair pair;
  pair.probe(40, kNone, kAll);
  EXPECT_TRUE(pair.b.peers().empty());
  const Peer peer = pair.a.peers()[0];
  EXPECT_TRUE(peer.judged());
  EXPECT_FALSE(peer.to_it.has_value());
}

TEST(PeerLedger, LossIsReportedForEachDirectionAndLength) {
  Pair pair;
  pair.probe(
      200, [](std::uint32_t n) { return n % 10 != 5; },  // 5 mod 10: both lengths
      [](std::uint32_t n) { return !is_large(n); });
  const Peer peer = pair.a.peers()[0];
  EXPECT_NEAR(peer.to_it->percent(), 10, 1);
  EXPECT_EQ(peer.from_it.small_percent(), 0);
  EXPECT_EQ(peer.from_it.large_percent(), 100);
}

TEST(PeerLedger, WhatComesTwiceCountsOnceAndIsReported) {
  PeerLedger a(1, "alpha", ""), b(2, "beta", "");
  for (int i = 0; i < 20; ++i) {
    const Probe probe = b.next(Instant(1s * i));
    a.take(probe, "", Instant(1s * i));
    a.take(probe, "", Instant(1s * i));
  }
  EXPECT_EQ(a.peers()[0].from_it.received.all(), 20u);
  EXPECT_EQ(a.peers()[0].duplicates, 20);
}

TEST(PeerLedger, OwnProbesAreIgnored) {
  PeerLedger a(1, "alpha", "");
  a.take(a.next(Instant(1s)), "", Instant(1s));
  EXPECT_TRUE(a.peers().empty());
}

TEST(PeerLedger, AHostThatStartsLateHasLostNothing) {
  Pair pair;
  pair.probe(100, kAll, [](std::uint32_t n) { return n >= 60; });
  EXPECT_EQ(pair.a.peers()[0].from_it.percent(), 0);
}

TEST(PeerLedger, AHostThatHasEndedIsNoLongerEchoed) {
  Pair pair;
  pair.probe(20, kAll, kAll);
  EXPECT_EQ(pair.a.next(pair.at + 1s).echoes.size(), 1u);
  EXPECT_TRUE(pair.a.next(pair.at + 10s).echoes.empty());
}

TEST(PeerLedger, AHostThatOnlyOthersReceiveIsCounted) {
  PeerLedger a(1, "alpha", ""), b(2, "beta", ""), c(3, "gamma", "");
  for (int i = 0; i < 40; ++i) {
    const Instant at(50ms * i);
    b.take(c.next(at), "", at);
    a.take(b.next(at), "", at);
  }
  EXPECT_EQ(a.only_received_by_others(), 1);
  EXPECT_EQ(b.only_received_by_others(), 0);
}

TEST(PeerLedger, EchoesOfProbesThatWereNeverSentProveNothing) {
  PeerLedger a(1, "alpha", "");
  a.next(Instant(1s));
  Probe forged{2, 0, "beta", "", {{1, 5, 9, {3, 1}, 0}}};
  a.take(forged, "", Instant(2s));
  EXPECT_FALSE(a.peers()[0].to_it.has_value());
  forged = {
      2, 1, "beta", "", {{1, 0, 0, {1, 0}, 50'000'000'000}}};  // held since before it was sent
  a.take(forged, "", Instant(2s));
  EXPECT_TRUE(a.peers()[0].to_it.has_value());
  EXPECT_TRUE(a.peers()[0].round_trips_s.empty());
}

TEST(PeerLedger, AFloodOfHostsFillsATableAndNoMore) {
  PeerLedger a(1, "alpha", "");
  for (std::uint64_t nonce = 2; nonce < 1000; ++nonce) {
    a.take({nonce, 0, "x", "", {{nonce + 5000, 0, 50, {1, 0}, 0}}}, "", Instant(1s));
  }
  EXPECT_EQ(a.peers().size(), kMaxPeers);
  EXPECT_EQ(a.next(Instant(1s)).echoes.size(), kMaxPeers);
}

}  // namespace
}  // namespace ergocast::doctor
