// SPDX-License-Identifier: BSD-3-Clause
// One datagram on some channel, as received and with a valid tag. An accepted message is unchanged
// when it is sent again. A single message cannot break a table, and a receiver with a key accepts
// none.
//
// Input: a byte with the length of the channel's name, the name, the datagram.
#include <cmath>

#include "cli/doctor/bus_listener.h"
#include "core/law/coverage_table.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "tests/fuzz/support/datagrams.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {
namespace {

/// 5 × 4 modes and a step of 0.1 s, as in tests/support/team.h.
void merge(const Contribution& theirs) {
  CoverageTable table(Basis{.modes_x = 5, .modes_y = 4}, 0.1);
  const Merge merged = table.merge(theirs, Tick{1} << 40);
  ERGOCAST_REQUIRE(table.row_count() == (merged == Merge::kNewer ? 1U : 0U));
  Coefficients coverage = Coefficients::Zero(20);
  table.average(coverage);
  for (const double c : coverage) ERGOCAST_REQUIRE(std::abs(c) <= 1 + 1e-6);
}

/// Truth values can be written in several ways: any number but 0 is true.
bool has_flags(const Message& message) {
  return std::holds_alternative<Stop>(message) || std::holds_alternative<TeamStatus>(message) ||
         std::holds_alternative<MissionPart>(message) || std::holds_alternative<Amend>(message) ||
         std::holds_alternative<Recall>(message) || std::holds_alternative<WorldState>(message) ||
         std::holds_alternative<RecordAck>(message);
}

void check_accepted(const Message& message, std::string_view channel,
                    std::span<const std::byte> bytes) {
  std::vector<std::byte> again;
  encode(message, again);
  ERGOCAST_REQUIRE(again.size() == bytes.size());
  if (!has_flags(message)) ERGOCAST_REQUIRE(std::ranges::equal(again, bytes));
  const auto decoded = decode(again, 0);
  ERGOCAST_REQUIRE(decoded.has_value());
  ERGOCAST_REQUIRE(transmitter_of(message, channel_of(message)) == header_of(message).sender);
  const auto transmitter = transmitter_of(message, channel);
  ERGOCAST_REQUIRE(!transmitter || (*transmitter >= kOperator && *transmitter < kMaxAgents));
  if (const auto* theirs = std::get_if<Contribution>(&message)) merge(*theirs);
}

void take(std::span<const std::byte> bytes, std::string_view channel) {
  static const MessageAuthenticator authenticator(MissionKey{{std::byte{7}}, {std::byte{8}}, {}});
  ERGOCAST_REQUIRE(!decode(bytes, 0, authenticator, channel));
  const auto decoded = decode(bytes, 0);
  if (decoded) check_accepted(*decoded, channel, bytes);
}

std::size_t mutate(std::span<std::uint8_t> space, std::size_t size, std::uint64_t seed) {
  if (size == 0) return 0;
  const std::size_t at = 1 + space[0];
  if (at >= size) return size;
  Dice dice(seed);
  std::size_t datagram = size - at;
  for (std::size_t changes = 1 + dice.below(4); changes > 0; --changes) {
    datagram = mutate_datagram(space.subspan(at), datagram, dice);
  }
  return at + datagram;
}

}  // namespace

FUZZ_TARGET_WITH(datagram, &mutate) {
  if (input.empty() || input.size() < 1U + input[0]) return;
  const std::string_view channel = text_of(input.subspan(1, input[0]));
  const Input datagram = input.subspan(1U + input[0]);
  take(bytes_of(datagram), channel);
  if (datagram.size() < kHeaderBytes) return;
  std::vector<std::uint8_t> lying(datagram.begin(), datagram.end());
  retag(lying);
  take(bytes_of(lying), channel);
  doctor::Overheard overheard;
  overheard.take(bytes_of(lying));
}

}  // namespace ergocast::fuzz
