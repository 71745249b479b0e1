// SPDX-License-Identifier: BSD-3-Clause
// One message of every kind, every field with a value of its own, and their bytes.
#pragma once

#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "lcmtypes/codec.h"

namespace ergocast::test {

using Bytes = std::vector<std::byte>;

inline constexpr RunId kRun = 0xfeedfacecafebeef;
inline constexpr std::size_t kHeaderBytes = 60;
inline constexpr std::size_t kSignatureEnd = 124;
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---- honest messages, every field with a value of its own ----

inline Header header_of_sender(AgentId sender) {
  return {kRun, sender, 0x8000000000000123, 4711, 123456789012};
}

inline Hello hello() {
  return {header_of_sender(kUnassigned), 7, "host.example", "0.1.0", 19, "fine"};
}

inline Signature a_signature() {
  Signature signature;
  for (std::size_t i = 0; i < signature.size(); ++i) signature[i] = static_cast<std::byte>(i + 1);
  return signature;
}

inline MissionPart mission_part() {
  MissionPart m;
  m.header = header_of_sender(kCoordinator);
  m.revision = 12;
  m.state = MissionState::kRunning;
  m.part = 2;
  m.parts = 5;
  m.roster = {{{0, 0xffffffffffffffff}, 0, -1}, {{127, 5}, 100, 200, true, 300, 11, 3, 9, true}};
  for (int i = 0; i < 300; ++i) m.plan.push_back(static_cast<std::byte>(i * 7));
  for (int i = 0; i < 30; ++i) m.amendments.push_back(static_cast<std::byte>(i * 3));
  m.stand_by_revision = 11;
  m.reason = "because";
  m.signature = a_signature();
  return m;
}

inline Contribution contribution() {
  Contribution m;
  m.header = header_of_sender(3);
  m.steps = 1000;
  m.next_broadcast_tick = 1001;
  m.elapsed_s = 100;
  m.block = 1;
  m.mode_count = 225;
  const std::span<double> sums = m.sums.set_all();
  for (int k = 0; k < kBlockSize; ++k) sums[static_cast<std::size_t>(k)] = 99.5 * std::sin(k) / 3;
  sums[5] = -0.0;
  sums[6] = 5e-324;
  return m;
}

/// The same coverage with numbers in 16 bits.
inline Contribution averages() {
  Contribution m = contribution();
  m.encoding = ContributionEncoding::kFixed16;
  m.block = 0;
  m.gained_steps = 10;
  const std::span<double> sums = m.sums.set_all(kMostBlockSize);
  const std::span<double> gains = m.gains.set_all(kMostBlockSize);
  for (std::size_t k = 0; k < kMostBlockSize; ++k) {
    sums[k] = 100 * std::cos(static_cast<double>(k));
    gains[k] = std::cos(3 * static_cast<double>(k));
  }
  return m;
}

/// The first block of a mission that sends the other modes less often.
inline Contribution low_modes(Contribution m) {
  const auto shorten = [](BlockSums& sums) {
    const std::vector<double> low(sums.begin(), sums.begin() + kLowModes);
    std::ranges::copy(low, sums.set_all(kLowModes).begin());
  };
  m.block = 0;
  shorten(m.sums);
  if (m.encoding == ContributionEncoding::kFixed16) shorten(m.gains);
  return m;
}
inline Contribution low_sums() { return low_modes(contribution()); }
inline Contribution low_averages() { return low_modes(averages()); }

inline AgentStatus agent_status() {
  AgentStatus m;
  m.header = header_of_sender(3);
  m.phase = AgentPhase::kRunning;
  m.ergodic_metric = 1.0 / 3;
  m.max_staleness_s = 2.5;
  m.waiting_for = 4;
  m.answered_tick = 5;
  m.contributions_received = 6;
  m.contributions_lost = 7;
  m.messages_sent = 8;
  m.messages_received = 9;
  m.missed_ticks = 10;
  m.contributions_relayed = 18;
  m.refused = {11, 12, 13, 14, 15, 16, 19, 20, 21};
  m.rate_offender = 22;
  m.kernel_drops = 17;
  m.loop_lag_s = 0.25;
  m.blocked_by = 6;
  m.blocked_now_ticks = 23;
  m.blocked_ticks = 25;
  m.longest_block_ticks = 24;
  m.host = "host.example";
  return m;
}

inline TeamStatus team_status() {
  return {header_of_sender(kCoordinator),
          MissionState::kEnded,
          1500,
          3,
          4,
          1.0 / 7,
          2,
          9,
          true,
          "base.example"};
}

inline Stop stop() { return {header_of_sender(kOperator), true, "enough", true, a_signature()}; }

inline Amend amend() {
  Amend m{.header = header_of_sender(kOperator),
          .number = 3,
          .kind = AmendmentKind::kTarget,
          .delay_ticks = 70,
          .part = 1,
          .parts = 4,
          .content = {},
          .by = "anna@base",
          .signature = a_signature()};
  for (int i = 0; i < 400; ++i) m.content.push_back(static_cast<std::byte>(i * 5));
  return m;
}

inline Recall recall() { return {header_of_sender(kOperator), 127, true, a_signature()}; }

inline WorldState world_state() {
  WorldState m;
  m.header = header_of_sender(kWorld);
  m.roster_revision = 3;
  m.missed_deadlines = 4;
  m.skipped_ticks = 5;
  m.clamped_commands = 6;
  m.uncounted_ticks = 7;
  m.found = 0x80000003;
  m.part = 1;
  m.parts = 8;
  m.vehicle_count = 2;
  m.vehicles[0] = {16, 77, {1.0 / 3, -2, 3}, {4, 5, 6}, 0x80000005, 4095, 654321};
  m.vehicles[1] = {127, -1, {7, 8, 9}, {10, -11, 1e-300}};
  return m;
}

inline Command command() {
  return {header_of_sender(2), {1.0 / 3, 2, 3}, {-4, 5, 6}, 0xfeedfacecafebeef, 123456};
}

inline RecordAck record_ack() {
  RecordAck m{header_of_sender(kLogger), true, 0.25, 3, 2};
  m.finds[0] = {.object = 31, .agent = 127, .tick = 4711, .x_m = {1.0 / 3, -2, 0}};
  m.finds[1] = {.object = 0, .agent = 0, .tick = 4712};
  m.contact_count = 1;
  m.contacts[0] = {
      .cell = 4095, .reports = 3, .newest = 4711, .probability = 0.75, .confirmed = true};
  return m;
}

inline Digest digest() {
  Digest m;
  m.header = header_of_sender(3);
  m.entry_count = 2;
  m.entries[0] = {{0, 0xffffffffffffffff}, 0, 0};
  m.entries[1] = {{127, 5}, 4711, 0xfedcba9876543210};
  return m;
}

inline Beacon beacon() {
  Beacon m;
  m.header = header_of_sender(3);
  m.roster_revision = 12;
  m.position_m = {1.0 / 3, -2, 3};
  m.velocity_mps = {4, 5, -6};
  m.number = 65535;
  m.echo_count = 3;
  m.echoes[0] = 40000;
  m.echoes[2] = 1;
  return m;
}

inline Effort effort() {
  Effort m;
  m.header = header_of_sender(3);
  m.part = 1;
  m.parts = 3;
  m.tile_count = 2;
  m.tiles[0] = {0, {5, {}}};
  m.tiles[1] = {static_cast<std::int32_t>(kMaxTiles) - 1, {4711, {}}};
  m.tiles[1].content.looks[63] = 65535;
  return m;
}

inline std::vector<Message> every_message() {
  return {hello(),       mission_part(), contribution(), agent_status(), team_status(), stop(),
          world_state(), command(),      record_ack(),   digest(),       amend(),       averages(),
          low_sums(),    low_averages(), beacon(),       recall(),       effort()};
}

// ---- bytes ----

inline Bytes encoded(const Message& message) {
  Bytes bytes;
  encode(message, bytes);
  bytes.shrink_to_fit();
  return bytes;
}

/// Recomputes the tag with knowledge of the format: XXH3-128 with bytes 44 to 59 zero.
inline Bytes retagged(Bytes bytes) {
  std::memset(bytes.data() + 44, 0, 16);
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  std::memcpy(bytes.data() + 44, canonical.digest, 16);
  return bytes;
}

inline void put32(Bytes& bytes, std::size_t offset, std::int32_t value) {
  const std::uint32_t big_endian = __builtin_bswap32(static_cast<std::uint32_t>(value));
  std::memcpy(bytes.data() + offset, &big_endian, 4);
}

inline Bytes with_count(const Message& message, std::size_t offset, std::int32_t count) {
  Bytes bytes = encoded(message);
  put32(bytes, offset, count);
  return retagged(bytes);
}

/// "accepted", or the reason.
inline std::string verdict(const Decoded& decoded) {
  return decoded ? "accepted" : to_string(decoded.error());
}
inline std::string verdict(const Bytes& bytes, RunId run = kRun) {
  return verdict(decode(bytes, run));
}
inline std::string verdict(const Message& message) { return verdict(encoded(message)); }

template <class M>
M decoded_as(const Bytes& bytes) {
  return std::get<M>(decode(bytes, kRun).value());
}

}  // namespace ergocast::test
