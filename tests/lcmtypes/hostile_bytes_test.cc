// SPDX-License-Identifier: BSD-3-Clause
// Hostile bytes are refused: the result is never a message, an exception or a read past the end.
// Each datagram has an allocation of its exact size, for the address sanitizer.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/noise.h"
#include "lcmtypes/codec.h"
#include "tests/lcmtypes/sample_messages.h"

namespace ergocast {
namespace {

using namespace test;

// ---- damaged bytes ----

TEST(Codec, EveryTruncationIsRefused) {
  for (const Message& message : every_message()) {
    const Bytes whole = encoded(message);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      ASSERT_EQ(verdict(cut), size < kHeaderBytes ? "size" : "tag")
          << "message kind " << message.index() << ", " << size << " bytes";
    }
  }
}

TEST(Codec, EveryTruncationWithACorrectTagIsRefusedForItsSize) {
  for (const Message& message : every_message()) {
    const Bytes whole = encoded(message);
    for (std::size_t size = kHeaderBytes; size < whole.size(); ++size) {
      const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      ASSERT_EQ(verdict(retagged(cut)), "size")
          << "message kind " << message.index() << ", " << size << " bytes";
    }
  }
}

TEST(Codec, AnythingAfterTheEndIsRefusedForItsSize) {
  for (const Message& message : every_message()) {
    Bytes longer = encoded(message);
    for (int extra = 0; extra < 9 && longer.size() < kMaxDatagramBytes; ++extra) {
      longer.push_back(std::byte{0});
      ASSERT_EQ(verdict(retagged(longer)), "size") << "message kind " << message.index();
    }
  }
}

TEST(Codec, EverySingleFlippedBitIsRefused) {
  for (const Message& message : every_message()) {
    Bytes bytes = encoded(message);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      const auto mask = static_cast<std::byte>(1 << bit % 8);
      bytes[bit / 8] ^= mask;
      ASSERT_EQ(verdict(bytes), bit / 8 < 8 ? "type" : "tag")
          << "message kind " << message.index() << ", bit " << bit;
      bytes[bit / 8] ^= mask;
    }
    ASSERT_EQ(verdict(bytes), "accepted");
  }
}

TEST(Codec, OversizedDatagramsAreRefusedUnread) {
  for (const std::size_t size : {kMaxDatagramBytes + 1, std::size_t{1473}, std::size_t{65507}}) {
    Bytes bytes = encoded(contribution());
    bytes.resize(size);
    EXPECT_EQ(verdict(retagged(bytes)), "size") << size;
  }
}

TEST(Codec, UnknownTypesAreRefusedEvenWithACorrectTag) {
  for (const std::size_t size : {kHeaderBytes, std::size_t{500}}) {
    EXPECT_EQ(verdict(retagged(Bytes(size, std::byte{0}))), "type");
    EXPECT_EQ(verdict(retagged(Bytes(size, std::byte{0xff}))), "type");
  }
}

// ---- false bytes: a correct tag over numbers that are not true ----

constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
/// A count so large that sums with it overflow.
constexpr std::int64_t kHuge = std::numeric_limits<std::int64_t>::max();

TEST(Codec, HostileCountsAreRefusedBeforeAnyDecoderSeesThem) {
  constexpr std::size_t kRosterCount = kSignatureEnd + 25, kPlanSize = kSignatureEnd + 29,
                        kVehicleCount = kHeaderBytes + 53, kDigestCount = kHeaderBytes + 8,
                        kEchoCount = kHeaderBytes + 58;
  // The offsets are right: writing the true counts there changes nothing.
  ASSERT_EQ(with_count(mission_part(), kRosterCount, 2), encoded(mission_part()));
  ASSERT_EQ(with_count(mission_part(), kPlanSize, 300), encoded(mission_part()));
  ASSERT_EQ(with_count(world_state(), kVehicleCount, 2), encoded(world_state()));
  ASSERT_EQ(with_count(digest(), kDigestCount, 2), encoded(digest()));
  ASSERT_EQ(with_count(beacon(), kEchoCount, 3), encoded(beacon()));
  for (const std::int32_t count : {-1, 0, 2, 4, 256, 257, kMost, kLeast})
    EXPECT_EQ(verdict(with_count(beacon(), kEchoCount, count)), "size") << count;
  for (const std::int32_t count :
       {-1, 0, 1, 3, 12, 13, 100, 0x01000000, 0x7fffff00, kMost, kLeast}) {
    EXPECT_EQ(verdict(with_count(mission_part(), kRosterCount, count)), "size") << count;
    EXPECT_EQ(verdict(with_count(world_state(), kVehicleCount, count)), "size") << count;
    EXPECT_EQ(verdict(with_count(digest(), kDigestCount, count)), "size") << count;
  }
  for (const std::int32_t count : {-1, 0, 299, 301, 512, 513, kMost, kLeast}) {
    EXPECT_EQ(verdict(with_count(mission_part(), kPlanSize, count)), "size") << count;
  }
}

TEST(Codec, TwoCountsThatLieTogetherAreRefusedToo) {
  // 55 bytes less of roster and 55 more of plan: the total size is right, only the meaning changes.
  Bytes shifted = encoded(mission_part());
  put32(shifted, kSignatureEnd + 25, 1);
  put32(shifted, kSignatureEnd + 29, 355);
  const auto part = decoded_as<MissionPart>(retagged(shifted));
  EXPECT_EQ(part.roster.size(), 1u);
  EXPECT_EQ(part.plan.size(), 355u);
  // A right total does not help beyond a limit.
  put32(shifted, kSignatureEnd + 25, 7);
  put32(shifted, kSignatureEnd + 29, 300 - 5 * 55);
  EXPECT_EQ(verdict(retagged(shifted)), "size");
}

TEST(Codec, HostileStringLengthsAreRefused) {
  const struct {
    Message message;
    std::size_t offset;
    std::int32_t length;  // with the final NUL
  } strings[] = {{hello(), kHeaderBytes + 12, 13},
                 {hello(), kHeaderBytes + 12 + 4 + 13, 6},
                 {stop(), kSignatureEnd + 2, 7},
                 {agent_status(), encoded(agent_status()).size() - 17, 13},
                 {team_status(), encoded(team_status()).size() - 17, 13},
                 {mission_part(), encoded(mission_part()).size() - 12, 8}};
  for (const auto& text : strings) {
    ASSERT_EQ(with_count(text.message, text.offset, text.length), encoded(text.message))
        << "the offset is right";
    for (const std::int32_t length :
         {-1, 0, 1, text.length - 1, text.length + 1, 64, 65, 1000, kMost, kMost - 3, kLeast}) {
      EXPECT_EQ(verdict(with_count(text.message, text.offset, length)), "size")
          << "message kind " << text.message.index() << ", length " << length;
    }
    Bytes unterminated = encoded(text.message);
    unterminated[text.offset + 4 + static_cast<std::size_t>(text.length) - 1] = std::byte{'x'};
    EXPECT_EQ(verdict(retagged(unterminated)), "size");
  }
}

TEST(Codec, TextsThatMeanSomethingToATerminalAreRefused) {
  for (const Message& message : {Message(hello()), Message(stop()), Message(agent_status()),
                                 Message(team_status()), Message(mission_part())}) {
    for (const char control : {'\1', '\a', '\n', '\r', '\x1b', '\x7f'}) {
      Bytes bytes = encoded(message);
      bytes[bytes.size() - 2] =
          static_cast<std::byte>(control);  // the last string's last character
      EXPECT_EQ(verdict(retagged(bytes)), "range") << "message kind " << message.index();
    }
  }
  Bytes host = encoded(hello());
  host[kHeaderBytes + 16] = std::byte{0x1b};
  EXPECT_EQ(verdict(retagged(host)), "range");
}

// U+009B begins a sequence as ESC [ does; U+00A0 and what comes after it are letters and signs.
TEST(Codec, SecondControlCharactersAreRefusedInUtf8AndOtherCharactersAreNot) {
  for (int second = 0x80; second < 0xC0; ++second) {
    Bytes bytes = encoded(stop());
    bytes[bytes.size() - 3] = std::byte{0xC2};
    bytes[bytes.size() - 2] = static_cast<std::byte>(second);
    EXPECT_EQ(verdict(retagged(bytes)), second < 0xA0 ? "range" : "accepted") << second;
  }
}

TEST(Codec, TextThatWeSendMeansNothingToATerminal) {
  const Stop sent{header_of_sender(kOperator), true,
                  "a\x1b[2J b\xC2\x9B"
                  "2J \xC3\xA9 \x9B"};
  EXPECT_EQ(decoded_as<Stop>(encoded(sent)).reason, "a [2J b 2J \xC3\xA9 \x9B");
}

TEST(Codec, StringsLongerThanTheirLimitAreRefusedEvenIfTheBytesAreThere) {
  Bytes bytes =
      encoded(Stop{header_of_sender(kOperator), true, std::string(kMaxReasonLength, 'r')});
  bytes.insert(bytes.end() - 1, std::byte{'r'});
  put32(bytes, kSignatureEnd + 2, kMaxReasonLength + 2);
  EXPECT_EQ(verdict(retagged(bytes)), "size");
}

TEST(Codec, NumbersThatAreNotNumbersAreRefused) {
  const auto refused_with = [](auto message, double& number) {
    for (const double bad : {kNan, -kNan, kInfinity, -kInfinity}) {
      const double good = std::exchange(number, bad);
      EXPECT_EQ(verdict(Message(message())), "range") << bad << " in place of " << good;
      number = good;
    }
  };
  AgentStatus status = agent_status();
  const auto the_status = [&] { return status; };
  refused_with(the_status, status.ergodic_metric);
  refused_with(the_status, status.max_staleness_s);
  refused_with(the_status, status.loop_lag_s);
  TeamStatus team = team_status();
  refused_with([&] { return team; }, team.ergodic_metric);
  Contribution sums = contribution();
  refused_with([&] { return sums; }, sums.elapsed_s);
  WorldState world = world_state();
  Command answer = command();
  for (int axis = 0; axis < 3; ++axis) {
    refused_with([&] { return world; }, world.vehicles[1].position_m[axis]);
    refused_with([&] { return world; }, world.vehicles[1].velocity_mps[axis]);
    refused_with([&] { return answer; }, answer.position_m[axis]);
    refused_with([&] { return answer; }, answer.velocity_mps[axis]);
  }
}

/// A copy of `message` after `change`.
template <class M>
Message changed(M message, const std::function<void(M&)>& change) {
  change(message);
  return message;
}

TEST(Codec, NumbersOutsideTheirRangeAreRefused) {
  using Part = MissionPart;
  const Message lies[] = {
      changed<Hello>(hello(), [](Hello& m) { m.requested_id = -2; }),
      changed<Hello>(hello(), [](Hello& m) { m.requested_id = kMaxAgents; }),
      changed<Hello>(hello(), [](Hello& m) { m.revision = -2; }),
      changed<Hello>(hello(), [](Hello& m) { m.revision = kHuge; }),
      changed<Part>(mission_part(), [](Part& m) { m.state = static_cast<MissionState>(4); }),
      changed<Part>(mission_part(), [](Part& m) { m.state = static_cast<MissionState>(-1); }),
      changed<Part>(mission_part(), [](Part& m) { m.revision = -1; }),
      changed<Part>(mission_part(), [](Part& m) { m.revision = std::int64_t{1} << 49; }),
      changed<Part>(mission_part(), [](Part& m) { m.part = -1; }),
      changed<Part>(mission_part(), [](Part& m) { m.part = m.parts; }),
      changed<Part>(mission_part(), [](Part& m) { m.parts = kMaxMissionParts + 1; }),
      changed<Part>(mission_part(), [](Part& m) { m.part = 0, m.parts = 0; }),
      changed<Part>(mission_part(), [](Part& m) { m.part = -5, m.parts = kLeast; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].author.agent = -1; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].author.agent = kMaxAgents; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].active_from = -1; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].active_until = -2; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].active_from = kHuge; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].active_until = kHuge; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].since_tick = kHuge; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].since_revision = kHuge; }),
      changed<Contribution>(contribution(), [](Contribution& m) { m.steps = -1; }),
      changed<Contribution>(contribution(), [](Contribution& m) { m.steps = kHuge; }),
      changed<Contribution>(contribution(), [](Contribution& m) { m.next_broadcast_tick = -1; }),
      changed<Contribution>(contribution(), [](Contribution& m) { m.next_broadcast_tick = kHuge; }),
      changed<Contribution>(contribution(), [](Contribution& m) { m.header.sender = -1; }),
      changed<Contribution>(contribution(), [](Contribution& m) { m.header.sender = kMaxAgents; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.header.sender = kCoordinator; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.header.sender = kMaxAgents; }),
      changed<AgentStatus>(agent_status(),
                           [](AgentStatus& m) { m.phase = static_cast<AgentPhase>(6); }),
      changed<AgentStatus>(agent_status(),
                           [](AgentStatus& m) { m.phase = static_cast<AgentPhase>(-1); }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.rate_offender = -2; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.rate_offender = kMaxAgents; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.loop_lag_s = -1e-9; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.max_staleness_s = -1; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.ergodic_metric = -1; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.waiting_for = kMaxAgents; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.answered_tick = -2; }),
      changed<TeamStatus>(team_status(), [](TeamStatus& m) { m.ergodic_metric = -1; }),
      changed<TeamStatus>(team_status(), [](TeamStatus& m) { m.tick_count = -1; }),
      changed<TeamStatus>(team_status(), [](TeamStatus& m) { m.agents_alive = -1; }),
      changed<TeamStatus>(team_status(), [](TeamStatus& m) { m.agents_expected = -1; }),
      changed<TeamStatus>(team_status(), [](TeamStatus& m) { m.silent_agent = kMaxAgents; }),
      changed<TeamStatus>(team_status(), [](TeamStatus& m) { m.missed_deadlines = -1; }),
      changed<TeamStatus>(team_status(),
                          [](TeamStatus& m) { m.state = static_cast<MissionState>(9); }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.header.tick = -1; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.roster_revision = -1; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.roster_revision = kHuge; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.missed_deadlines = -1; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.missed_deadlines = kHuge; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.skipped_ticks = -1; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.skipped_ticks = kHuge; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.vehicles[1].answered_tick = -2; }),
      changed<WorldState>(world_state(),
                          [](WorldState& m) { m.vehicles[1].answered_tick = kHuge; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.part = -1; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.part = m.parts; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.part = 0, m.parts = 0; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.parts = kMaxAgents + 1; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.vehicles[1].id = -1; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.vehicles[1].id = kMaxAgents; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.header.sender = 3; }),
      changed<Part>(mission_part(), [](Part& m) { m.header.sender = kOperator; }),
      changed<TeamStatus>(team_status(), [](TeamStatus& m) { m.header.sender = 0; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.header.sender = kWorld; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.detection_probability = 1.5; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.detection_probability = -0.5; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.wrong_confirmations = -1; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.finds[0].object = kMaxObjects; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.finds[0].agent = -1; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.finds[1].tick = -1; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.finds[1].x_m.y() = 1.0 / 0.0; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.contacts[0].cell = -1; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.contacts[0].cell = kMaxSearchCells; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.contacts[0].reports = -1; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.contacts[0].newest = -1; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.contacts[0].probability = 1.5; }),
      changed<RecordAck>(record_ack(), [](RecordAck& m) { m.contacts[0].probability = -0.5; }),
      changed<Command>(command(), [](Command& m) { m.header.sender = kWorld; }),
      changed<Command>(command(), [](Command& m) { m.header.sender = kMaxAgents; }),
      changed<Command>(command(), [](Command& m) { m.header.tick = -2; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].since_tick = -1; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].since_revision = -1; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.contributions_relayed = -1; }),
      changed<Digest>(digest(), [](Digest& m) { m.header.sender = kCoordinator; }),
      changed<Digest>(digest(), [](Digest& m) { m.header.sender = kMaxAgents; }),
      changed<Digest>(digest(), [](Digest& m) { m.entries[1].author.agent = -1; }),
      changed<Digest>(digest(), [](Digest& m) { m.entries[1].author.agent = kMaxAgents; }),
      changed<Digest>(digest(), [](Digest& m) { m.entries[1].steps = -1; }),
      changed<Effort>(effort(), [](Effort& m) { m.header.sender = kWorld; }),
      changed<Effort>(effort(), [](Effort& m) { m.header.tick = -1; }),
      changed<Effort>(effort(), [](Effort& m) { m.part = 3; }),
      changed<Effort>(effort(), [](Effort& m) { m.parts = kMaxEffortParts + 1; }),
      changed<Effort>(effort(), [](Effort& m) { m.tiles[1].number = -1; }),
      changed<Effort>(effort(), [](Effort& m) { m.tiles[1].number = kMaxTiles; }),
      changed<Effort>(effort(), [](Effort& m) { m.tiles[1].content.newest_look = -1; }),
      changed<Beacon>(beacon(), [](Beacon& m) { m.header.sender = kWorld; }),
      changed<Beacon>(beacon(), [](Beacon& m) { m.header.tick = -1; }),
      changed<Beacon>(beacon(), [](Beacon& m) { m.roster_revision = -1; }),
      changed<Beacon>(beacon(), [](Beacon& m) { m.number = 0; }),
      changed<Beacon>(beacon(), [](Beacon& m) { m.position_m.y() = kNan; }),
      changed<Beacon>(beacon(), [](Beacon& m) { m.velocity_mps.x() = kInfinity; }),
  };
  for (std::size_t i = 0; i < std::size(lies); ++i)
    EXPECT_EQ(verdict(lies[i]), "range") << "lie " << i;
}

TEST(Codec, CountsThatOnlyOverflowAreRefused) {
  for (const Message& original : every_message()) {
    const auto with = [&](const std::function<void(Header&)>& change) {
      Message message = original;
      std::visit([&](auto& m) { change(m.header); }, message);
      return verdict(message);
    };
    for (const std::int64_t bad : {kHuge, -kHuge, (std::int64_t{1} << 48) + 1, std::int64_t{-2}}) {
      EXPECT_EQ(with([&](Header& h) { h.sequence = bad; }), "range") << bad;
      EXPECT_EQ(with([&](Header& h) { h.tick = bad; }), "range") << bad;
    }
    EXPECT_EQ(with([](Header& h) { h.sender = kOperator - 1; }), "range");
    EXPECT_EQ(with([](Header& h) { h.sender = kMaxAgents; }), "range");
  }
  for (std::int64_t AgentStatus::*count :
       {&AgentStatus::contributions_received, &AgentStatus::messages_sent,
        &AgentStatus::messages_received, &AgentStatus::missed_ticks, &AgentStatus::kernel_drops,
        &AgentStatus::blocked_now_ticks, &AgentStatus::blocked_ticks,
        &AgentStatus::longest_block_ticks}) {
    for (const std::int64_t bad : {kHuge, std::int64_t{-1}}) {
      AgentStatus status = agent_status();
      status.*count = bad;
      EXPECT_EQ(verdict(Message(status)), "range");
    }
  }
  AgentStatus status = agent_status();
  status.refused[5] = kHuge;
  EXPECT_EQ(verdict(Message(status)), "range");
}

// A jump in a sender's numbering makes others count losses that never happened. Their statuses must
// still be accepted.
TEST(Codec, MoreLossesThanThereCanBeAreSentAsTheMostThatIsAccepted) {
  AgentStatus status = agent_status();
  status.contributions_lost = std::int64_t{1} << 57;
  EXPECT_EQ(decoded_as<AgentStatus>(encoded(status)).contributions_lost, std::int64_t{1} << 48);
}

TEST(Codec, AnotherRunsMessagesAreRefusedUnlessAnyRunWillDo) {
  for (const Message& message : every_message()) {
    const Bytes bytes = encoded(message);
    EXPECT_EQ(verdict(bytes, kRun), "accepted");
    EXPECT_EQ(verdict(bytes, kRun + 1), "run");
    EXPECT_EQ(verdict(bytes, kRun << 32), "run");
    EXPECT_EQ(verdict(bytes, 0), "accepted");
  }
}

TEST(Codec, MutationsWithACorrectTagNeverDoMoreThanBeRefusedOrMakeAValidMessage) {
  const std::vector<Message> originals = every_message();
  int refused = 0, accepted = 0;
  for (std::uint64_t round = 0; round < 60000; ++round) {
    Bytes bytes = encoded(originals[round % originals.size()]);
    for (std::uint32_t change = 0; change < 1 + round % 5; ++change) {
      const RandomBits words = random_words(11, Purpose::kFault, change, round);
      bytes[8 + words.first % (bytes.size() - 8)] = static_cast<std::byte>(words.second);
    }
    if (round % 7 == 0) bytes.resize(kHeaderBytes + round % (bytes.size() - kHeaderBytes + 1));
    const Decoded decoded = decode(retagged(bytes), 0);
    if (decoded) {
      ++accepted;
      ASSERT_EQ(verdict(decode(encoded(*decoded), 0)), "accepted") << "round " << round;
    } else {
      ++refused;
    }
  }
  // Both results were frequent enough for the test to be meaningful.
  EXPECT_GT(refused, 5000);
  EXPECT_GT(accepted, 5000);
}

}  // namespace
}  // namespace ergocast
