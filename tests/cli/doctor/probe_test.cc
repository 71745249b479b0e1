// SPDX-License-Identifier: BSD-3-Clause
// A probe survives writing and reading, LCM does not parse it, and impossible ones are refused.
#include "cli/doctor/probe.h"

#include <gtest/gtest.h>

#include <random>

namespace ergocast::doctor {
namespace {

Probe full_probe(std::uint32_t sequence) {
  Probe probe{0x1234567890abcdef, sequence, "robot-1", "0.1.0", {}, 0xfedcba9876543210};
  for (std::uint64_t i = 0; i < kMaxPeers; ++i) probe.echoes.push_back({i + 1, 4, 11, {5, 1}, 99});
  return probe;
}

std::vector<std::byte> bytes_of(const Probe& probe) {
  std::vector<std::byte> bytes;
  write(probe, bytes);
  return bytes;
}

TEST(Probe, ComesBackAsItWasWritten) {
  for (const std::uint32_t sequence : {0u, 3u, kMaxProbes - 1}) {
    const Probe sent = full_probe(sequence);
    const auto bytes = bytes_of(sent);
    const auto got = read(bytes);
    ASSERT_TRUE(got.has_value()) << sequence;
    EXPECT_EQ(bytes.size() == kLargeProbeBytes, is_large(sequence));
    EXPECT_EQ(got->nonce, sent.nonce);
    EXPECT_EQ(got->sequence, sequence);
    EXPECT_EQ(got->host, "robot-1");
    EXPECT_EQ(got->version, "0.1.0");
    EXPECT_EQ(got->key, sent.key);
    ASSERT_EQ(got->echoes.size(), kMaxPeers);
    EXPECT_EQ(got->echoes[3].nonce, 4u);
    EXPECT_EQ(got->echoes[3].last, 11u);
    EXPECT_EQ(got->echoes[3].received.small, 5u);
    EXPECT_EQ(got->echoes[3].held_ns, 99u);
  }
}

TEST(Probe, IsNothingThatLcmWouldParse) {
  const auto bytes = bytes_of(full_probe(0));
  EXPECT_NE(std::string(reinterpret_cast<const char*>(bytes.data()), 3), "LC0");
}

TEST(Probe, EveryFourthIsLarge) {
  for (std::uint32_t first = 0; first < 9; ++first) {
    std::uint32_t large = 0;
    for (std::uint32_t last = first; last < 20; ++last) {
      large += is_large(last);
      EXPECT_EQ(probes_between(first, last).large, large);
      EXPECT_EQ(probes_between(first, last).all(), last - first + 1);
    }
  }
}

TEST(Probe, WhatCannotBeTrueIsRefused) {
  const auto refused = [](auto change) {
    Probe probe = full_probe(0);
    change(probe);
    return !read(bytes_of(probe)).has_value();
  };
  EXPECT_FALSE(refused([](Probe&) {}));
  EXPECT_TRUE(refused([](Probe& p) { p.sequence = kMaxProbes; }));
  EXPECT_TRUE(refused([](Probe& p) { p.echoes[1].first = 12; }));
  EXPECT_TRUE(refused([](Probe& p) { p.echoes[1].last = kMaxProbes; }));
  EXPECT_TRUE(refused([](Probe& p) { p.echoes[1].last = 0xffffffff; }));
  EXPECT_TRUE(refused([](Probe& p) { p.echoes[1].received.small = 7; }));
  EXPECT_TRUE(refused([](Probe& p) { p.echoes[1].received.large = 3; }));
  EXPECT_TRUE(refused([](Probe& p) { p.echoes[1].received = {}; }));
  EXPECT_TRUE(refused([](Probe& p) { p.echoes[1].held_ns = 1ull << 63; }));
}

TEST(Probe, TheHostsNameCannotSteerTheTerminal) {
  Probe probe = full_probe(0);
  probe.host = "a\033[2Jb";
  EXPECT_EQ(read(bytes_of(probe))->host, "a?[2Jb");
  probe.host = std::string(500, 'x');
  EXPECT_EQ(read(bytes_of(probe))->host, std::string(32, 'x'));
}

TEST(Probe, NoSizeButItsOwnIsRead) {
  for (const std::uint32_t sequence : {0u, 3u}) {
    const auto honest = bytes_of(full_probe(sequence));
    for (std::size_t size = 0; size <= 1400; ++size) {
      auto bytes = honest;
      bytes.resize(size);
      EXPECT_EQ(read(bytes).has_value(), size == honest.size()) << size;
    }
  }
}

TEST(Probe, NoBytesHurt) {
  std::mt19937 random(1);
  const auto honest = bytes_of(full_probe(3));
  for (int i = 0; i < 20000; ++i) {
    auto bytes = honest;
    for (int flips = 0; flips < 3; ++flips) bytes[random() % bytes.size()] = std::byte(random());
    const auto probe = read(bytes);
    EXPECT_TRUE(!probe || probe->echoes.size() <= kMaxPeers);
  }
}

}  // namespace
}  // namespace ergocast::doctor
