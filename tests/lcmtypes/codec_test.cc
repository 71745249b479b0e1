// The codec between honest messages and hostile bytes. Honest: every field survives, and the types
// that lcm-gen generates read the same from our bytes, because lcm-spy and log players use them.
// Hostile: whatever the bytes are, the answer is a reason, never a message, a throw or a read past
// the end (each datagram stands in an allocation of its exact size, for the address sanitizer).
#include "lcmtypes/codec.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <cmath>
#include <cstring>
#include <ergocast/agent_status_t.hpp>
#include <ergocast/command_t.hpp>
#include <ergocast/contribution_t.hpp>
#include <ergocast/hello_t.hpp>
#include <ergocast/mission_t.hpp>
#include <ergocast/record_ack_t.hpp>
#include <ergocast/stop_t.hpp>
#include <ergocast/team_status_t.hpp>
#include <ergocast/world_state_t.hpp>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/coverage_table.h"
#include "core/noise.h"
#include "lcmtypes/channels.h"

namespace ergocast {
namespace {

using Bytes = std::vector<std::byte>;
using Decoded = std::variant<Message, Refusal>;

constexpr RunId kRun = 0xfeedfacecafebeef;
constexpr std::size_t kHeaderBytes = 60;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---- honest messages, every field with a value of its own ----------------------------------------

Header header_of_sender(AgentId sender) {
  return {kRun, sender, 0x8000000000000123, 4711, 123456789012};
}

Hello hello() { return {header_of_sender(kUnassigned), 7, "host.example", "0.1.0"}; }

MissionPart mission_part() {
  MissionPart m;
  m.header = header_of_sender(kCoordinator);
  m.revision = 12;
  m.state = MissionState::kRunning;
  m.part = 2;
  m.parts = 5;
  m.roster = {{{0, 0xffffffffffffffff}, 0, -1}, {{127, 5}, 100, 200}};
  for (int i = 0; i < 300; ++i) m.plan.push_back(static_cast<std::byte>(i * 7));
  m.reason = "because";
  return m;
}

Contribution contribution() {
  Contribution m;
  m.header = header_of_sender(3);
  m.steps = 1000;
  m.next_broadcast_tick = 1001;
  m.elapsed_s = 100;
  m.block = 1;
  m.mode_count = 225;
  for (int k = 0; k < kBlockSize; ++k) m.sums[static_cast<std::size_t>(k)] = 99.5 * std::sin(k) / 3;
  m.sums[5] = -0.0;
  m.sums[6] = 5e-324;
  return m;
}

AgentStatus agent_status() {
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
  m.refused = {11, 12, 13, 14, 15, 16};
  m.kernel_drops = 17;
  m.host = "host.example";
  return m;
}

TeamStatus team_status() {
  return {header_of_sender(kCoordinator), MissionState::kEnded, 1500, 3, 4, 1.0 / 7, 2, 9};
}

Stop stop() { return {header_of_sender(kOperator), true, "enough"}; }

WorldState world_state() {
  WorldState m;
  m.header = header_of_sender(kWorld);
  m.roster_revision = 3;
  m.missed_deadlines = 4;
  m.skipped_ticks = 5;
  m.part = 1;
  m.parts = 8;
  m.vehicle_count = 2;
  m.vehicles[0] = {16, 77, {1.0 / 3, -2, 3}, {4, 5, 6}};
  m.vehicles[1] = {127, -1, {7, 8, 9}, {10, -11, 1e-300}};
  return m;
}

Command command() { return {header_of_sender(2), {1.0 / 3, 2, 3}, {-4, 5, 6}}; }

RecordAck record_ack() { return {header_of_sender(kLogger)}; }

std::vector<Message> every_message() {
  return {hello(), mission_part(), contribution(), agent_status(), team_status(),
          stop(),  world_state(),  command(),      record_ack()};
}

// ---- bytes ---------------------------------------------------------------------------------------

Bytes encoded(const Message& message) {
  Bytes bytes;
  encode(message, bytes);
  bytes.shrink_to_fit();
  return bytes;
}

/// Recomputes the tag as a sender who knows the format would: XXH3-128 with bytes 44 to 59 zero.
Bytes retagged(Bytes bytes) {
  std::memset(bytes.data() + 44, 0, 16);
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  std::memcpy(bytes.data() + 44, canonical.digest, 16);
  return bytes;
}

void put32(Bytes& bytes, std::size_t offset, std::int32_t value) {
  const std::uint32_t big_endian = __builtin_bswap32(static_cast<std::uint32_t>(value));
  std::memcpy(bytes.data() + offset, &big_endian, 4);
}

Bytes with_count(const Message& message, std::size_t offset, std::int32_t count) {
  Bytes bytes = encoded(message);
  put32(bytes, offset, count);
  return retagged(bytes);
}

/// "accepted", or the reason.
std::string verdict(const Decoded& decoded) {
  const auto* refusal = std::get_if<Refusal>(&decoded);
  return refusal == nullptr ? "accepted" : to_string(*refusal);
}
std::string verdict(const Bytes& bytes, RunId run = kRun) { return verdict(decode(bytes, run)); }
std::string verdict(const Message& message) { return verdict(encoded(message)); }

template <class M>
M decoded_as(const Bytes& bytes) {
  return std::get<M>(std::get<Message>(decode(bytes, kRun)));
}

/// What lcm-gen's own type reads from our bytes; it has to use all of them.
template <class Wire>
Wire read_by_lcm(const Bytes& bytes) {
  Wire wire;
  EXPECT_EQ(wire.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  return wire;
}

void expect_header(const header_t& wire, AgentId sender) {
  EXPECT_EQ(static_cast<RunId>(wire.run_id), kRun);
  EXPECT_EQ(wire.sender, sender);
  EXPECT_EQ(static_cast<Incarnation>(wire.incarnation), 0x8000000000000123);
  EXPECT_EQ(wire.sequence, 4711);
  EXPECT_EQ(wire.tick, 123456789012);
}

// ---- honest bytes --------------------------------------------------------------------------------

TEST(Codec, LcmsOwnTypesReadWhatWeWroteOfAgents) {
  const auto hello_wire = read_by_lcm<hello_t>(encoded(hello()));
  expect_header(hello_wire.header, kUnassigned);
  EXPECT_EQ(hello_wire.requested_id, 7);
  EXPECT_EQ(hello_wire.host, "host.example");
  EXPECT_EQ(hello_wire.version, "0.1.0");

  const Contribution sums = contribution();
  const auto sums_wire = read_by_lcm<contribution_t>(encoded(sums));
  expect_header(sums_wire.header, 3);
  EXPECT_EQ(sums_wire.steps, 1000);
  EXPECT_EQ(sums_wire.next_broadcast_tick, 1001);
  EXPECT_EQ(sums_wire.elapsed_s, 100);
  EXPECT_EQ(sums_wire.block, 1);
  EXPECT_EQ(sums_wire.mode_count, 225);
  EXPECT_EQ(std::memcmp(sums_wire.sums, sums.sums.data(), sizeof sums_wire.sums), 0);

  const auto status_wire = read_by_lcm<agent_status_t>(encoded(agent_status()));
  expect_header(status_wire.header, 3);
  EXPECT_EQ(status_wire.phase, 2);
  EXPECT_EQ(status_wire.ergodic_metric, 1.0 / 3);
  EXPECT_EQ(status_wire.max_staleness_s, 2.5);
  EXPECT_EQ(status_wire.waiting_for, 4);
  EXPECT_EQ(status_wire.answered_tick, 5);
  EXPECT_EQ(status_wire.contributions_received, 6);
  EXPECT_EQ(status_wire.contributions_lost, 7);
  EXPECT_EQ(status_wire.messages_sent, 8);
  EXPECT_EQ(status_wire.messages_received, 9);
  EXPECT_EQ(status_wire.missed_ticks, 10);
  for (int i = 0; i < kRefusalKinds; ++i) EXPECT_EQ(status_wire.refused[i], 11 + i);
  EXPECT_EQ(status_wire.kernel_drops, 17);
  EXPECT_EQ(status_wire.status_host, "host.example");

  const auto command_wire = read_by_lcm<command_t>(encoded(command()));
  expect_header(command_wire.header, 2);
  EXPECT_EQ(command_wire.command_position_m[0], 1.0 / 3);
  EXPECT_EQ(command_wire.command_position_m[1], 2);
  EXPECT_EQ(command_wire.command_position_m[2], 3);
  EXPECT_EQ(command_wire.command_velocity_mps[0], -4);
  EXPECT_EQ(command_wire.command_velocity_mps[1], 5);
  EXPECT_EQ(command_wire.command_velocity_mps[2], 6);
}

TEST(Codec, LcmsOwnTypesReadWhatWeWroteOfTheMission) {
  const MissionPart part = mission_part();
  const auto part_wire = read_by_lcm<mission_t>(encoded(part));
  expect_header(part_wire.header, kCoordinator);
  EXPECT_EQ(part_wire.revision, 12);
  EXPECT_EQ(part_wire.state, 1);
  EXPECT_EQ(part_wire.part, 2);
  EXPECT_EQ(part_wire.parts, 5);
  ASSERT_EQ(part_wire.roster_count, 2);
  EXPECT_EQ(part_wire.roster[0].id, 0);
  EXPECT_EQ(part_wire.roster[0].nonce, -1) << "all 64 bits, as LCM's signed number";
  EXPECT_EQ(part_wire.roster[0].active_from, 0);
  EXPECT_EQ(part_wire.roster[0].active_until, -1);
  EXPECT_EQ(part_wire.roster[1].id, 127);
  EXPECT_EQ(part_wire.roster[1].active_from, 100);
  EXPECT_EQ(part_wire.roster[1].active_until, 200);
  ASSERT_EQ(part_wire.plan_size, 300);
  EXPECT_EQ(std::memcmp(part_wire.plan.data(), part.plan.data(), 300), 0);
  EXPECT_EQ(part_wire.reason, "because");

  const auto team_wire = read_by_lcm<team_status_t>(encoded(team_status()));
  expect_header(team_wire.header, kCoordinator);
  EXPECT_EQ(team_wire.mission_state, 2);
  EXPECT_EQ(team_wire.tick_count, 1500);
  EXPECT_EQ(team_wire.agents_alive, 3);
  EXPECT_EQ(team_wire.agents_expected, 4);
  EXPECT_EQ(team_wire.median_ergodic_metric, 1.0 / 7);
  EXPECT_EQ(team_wire.team_waiting_for, 2);
  EXPECT_EQ(team_wire.team_missed_deadlines, 9);

  const auto stop_wire = read_by_lcm<stop_t>(encoded(stop()));
  expect_header(stop_wire.header, kOperator);
  EXPECT_EQ(stop_wire.stop_failed, 1);
  EXPECT_EQ(stop_wire.stop_reason, "enough");
}

TEST(Codec, LcmsOwnTypesReadWhatWeWroteOfTheWorld) {
  const auto wire = read_by_lcm<world_state_t>(encoded(world_state()));
  expect_header(wire.header, kWorld);
  EXPECT_EQ(wire.roster_revision, 3);
  EXPECT_EQ(wire.missed_deadlines, 4);
  EXPECT_EQ(wire.skipped_ticks, 5);
  EXPECT_EQ(wire.state_part, 1);
  EXPECT_EQ(wire.state_parts, 8);
  ASSERT_EQ(wire.vehicle_count, 2);
  EXPECT_EQ(wire.vehicles[0].vehicle_id, 16);
  EXPECT_EQ(wire.vehicles[0].vehicle_answered_tick, 77);
  EXPECT_EQ(wire.vehicles[0].position_m[0], 1.0 / 3);
  EXPECT_EQ(wire.vehicles[0].position_m[1], -2);
  EXPECT_EQ(wire.vehicles[0].position_m[2], 3);
  EXPECT_EQ(wire.vehicles[0].velocity_mps[0], 4);
  EXPECT_EQ(wire.vehicles[1].vehicle_id, 127);
  EXPECT_EQ(wire.vehicles[1].vehicle_answered_tick, -1);
  EXPECT_EQ(wire.vehicles[1].velocity_mps[1], -11);
  EXPECT_EQ(wire.vehicles[1].velocity_mps[2], 1e-300);

  expect_header(read_by_lcm<record_ack_t>(encoded(record_ack())).ack_header, kLogger);
}

TEST(Codec, EveryMessageComesBackAsTheSameMessage) {
  // LCM's types above show that every field is in the bytes, so equal bytes mean equal fields.
  for (const Message& message : every_message()) {
    const Bytes bytes = encoded(message);
    const Decoded decoded = decode(bytes, kRun);
    ASSERT_EQ(verdict(decoded), "accepted") << "message kind " << message.index();
    EXPECT_EQ(std::get<Message>(decoded).index(), message.index());
    EXPECT_EQ(encoded(std::get<Message>(decoded)), bytes) << "message kind " << message.index();
  }
}

TEST(Codec, StopKeepsWhetherTheMissionFailed) {
  Stop wanted = stop();
  wanted.failed = false;
  EXPECT_FALSE(decoded_as<Stop>(encoded(wanted)).failed);
  EXPECT_TRUE(decoded_as<Stop>(encoded(stop())).failed);
}

TEST(Codec, TheTagStandsAtBytes44To59AndCoversAllOthers) {
  for (const Message& message : every_message()) {
    const Bytes bytes = encoded(message);
    EXPECT_EQ(bytes, retagged(bytes)) << "message kind " << message.index();
  }
}

TEST(Codec, EncodingReusesItsBufferWithoutLeavingAnythingInIt) {
  Bytes buffer = encoded(mission_part());
  encode(stop(), buffer);
  EXPECT_EQ(buffer, encoded(stop()));
}

TEST(Codec, TheFullestMessagesFitOneDatagram) {
  MissionPart part = mission_part();
  part.roster.assign(kMaxRosterEntriesPerMessage, part.roster[0]);
  part.plan.assign(kMaxPlanBytesPerMessage, std::byte{1});
  part.reason.assign(kMaxReasonLength, 'r');
  WorldState world = world_state();
  world.vehicle_count = kMaxVehiclesPerState;
  AgentStatus status = agent_status();
  status.host.assign(kMaxHostLength, 'h');
  for (const Message& message : {Message(part), Message(world), Message(status)}) {
    EXPECT_LE(encoded(message).size(), kMaxDatagramBytes);
    EXPECT_EQ(verdict(message), "accepted");
  }
  EXPECT_LE(encoded(contribution()).size(), kMaxDatagramBytes);
}

TEST(Codec, StringsAreCutAtTheirLimitsAndAtANul) {
  const Hello long_names{header_of_sender(-1), -1, std::string(500, 'h'), std::string(500, 'v')};
  const auto cut = decoded_as<Hello>(encoded(long_names));
  EXPECT_EQ(cut.host, std::string(kMaxHostLength, 'h'));
  EXPECT_EQ(cut.version, std::string(kMaxVersionLength, 'v'));
  const auto long_reason = decoded_as<Stop>(
      encoded(Stop{header_of_sender(kOperator), true, std::string(5000, 'r')}));
  EXPECT_EQ(long_reason.reason, std::string(kMaxReasonLength, 'r'));
  const auto nul = decoded_as<Stop>(
      encoded(Stop{header_of_sender(kOperator), true, std::string("one\0two", 7)}));
  EXPECT_EQ(nul.reason, "one");
}

// ---- damaged bytes -------------------------------------------------------------------------------

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

// ---- lying bytes: a correct tag over numbers that are not true -----------------------------------

constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();

TEST(Codec, HostileCountsAreRefusedBeforeAnyDecoderSeesThem) {
  constexpr std::size_t kRosterCount = kHeaderBytes + 17, kPlanSize = kHeaderBytes + 21,
                        kVehicleCount = kHeaderBytes + 32;
  // The offsets are right: writing the true counts there changes nothing.
  ASSERT_EQ(with_count(mission_part(), kRosterCount, 2), encoded(mission_part()));
  ASSERT_EQ(with_count(mission_part(), kPlanSize, 300), encoded(mission_part()));
  ASSERT_EQ(with_count(world_state(), kVehicleCount, 2), encoded(world_state()));
  for (const std::int32_t count : {-1, 0, 1, 3, 12, 13, 100, 0x01000000, 0x7fffff00, kMost, kLeast}) {
    EXPECT_EQ(verdict(with_count(mission_part(), kRosterCount, count)), "size") << count;
    EXPECT_EQ(verdict(with_count(world_state(), kVehicleCount, count)), "size") << count;
  }
  for (const std::int32_t count : {-1, 0, 299, 301, 512, 513, kMost, kLeast}) {
    EXPECT_EQ(verdict(with_count(mission_part(), kPlanSize, count)), "size") << count;
  }
}

TEST(Codec, TwoCountsThatLieTogetherAreRefusedToo) {
  // 28 bytes less of roster and 28 more of plan: the whole adds up, so only its meaning changes.
  Bytes shifted = encoded(mission_part());
  put32(shifted, kHeaderBytes + 17, 1);
  put32(shifted, kHeaderBytes + 21, 328);
  const auto part = decoded_as<MissionPart>(retagged(shifted));
  EXPECT_EQ(part.roster.size(), 1u);
  EXPECT_EQ(part.plan.size(), 328u);
  // Beyond a limit, it does not help that the sum is right.
  put32(shifted, kHeaderBytes + 17, 13);
  put32(shifted, kHeaderBytes + 21, 300 - 11 * 28 + 2 * 28);
  EXPECT_EQ(verdict(retagged(shifted)), "size");
}

TEST(Codec, HostileStringLengthsAreRefused) {
  const struct {
    Message message;
    std::size_t offset;
    std::int32_t length;  // with the final NUL
  } strings[] = {{hello(), kHeaderBytes + 4, 13},
                 {hello(), kHeaderBytes + 4 + 4 + 13, 6},
                 {stop(), kHeaderBytes + 1, 7},
                 {agent_status(), encoded(agent_status()).size() - 17, 13},
                 {mission_part(), encoded(mission_part()).size() - 12, 8}};
  for (const auto& text : strings) {
    ASSERT_EQ(with_count(text.message, text.offset, text.length), encoded(text.message))
        << "the offset is right";
    for (const std::int32_t length : {-1, 0, 1, text.length - 1, text.length + 1, 64, 65, 1000,
                                      kMost, kMost - 3, kLeast}) {
      EXPECT_EQ(verdict(with_count(text.message, text.offset, length)), "size")
          << "message kind " << text.message.index() << ", length " << length;
    }
    Bytes unterminated = encoded(text.message);
    unterminated[text.offset + 4 + static_cast<std::size_t>(text.length) - 1] = std::byte{'x'};
    EXPECT_EQ(verdict(retagged(unterminated)), "size");
  }
}

TEST(Codec, StringsLongerThanTheirLimitAreRefusedEvenIfTheBytesAreThere) {
  Bytes bytes = encoded(Stop{header_of_sender(kOperator), true, std::string(kMaxReasonLength, 'r')});
  bytes.insert(bytes.end() - 1, std::byte{'r'});
  put32(bytes, kHeaderBytes + 1, kMaxReasonLength + 2);
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
      changed<Part>(mission_part(), [](Part& m) { m.state = static_cast<MissionState>(4); }),
      changed<Part>(mission_part(), [](Part& m) { m.state = static_cast<MissionState>(-1); }),
      changed<Part>(mission_part(), [](Part& m) { m.revision = -1; }),
      changed<Part>(mission_part(), [](Part& m) { m.part = -1; }),
      changed<Part>(mission_part(), [](Part& m) { m.part = m.parts; }),
      changed<Part>(mission_part(), [](Part& m) { m.parts = kMaxPlanParts + 1; }),
      changed<Part>(mission_part(), [](Part& m) { m.part = 0, m.parts = 0; }),
      changed<Part>(mission_part(), [](Part& m) { m.part = -5, m.parts = kLeast; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].author.agent = -1; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].author.agent = kMaxAgents; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].active_from = -1; }),
      changed<Part>(mission_part(), [](Part& m) { m.roster[1].active_until = -2; }),
      changed<Contribution>(contribution(), [](Contribution& m) { m.header.sender = -1; }),
      changed<Contribution>(contribution(), [](Contribution& m) { m.header.sender = kMaxAgents; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.header.sender = kCoordinator; }),
      changed<AgentStatus>(agent_status(), [](AgentStatus& m) { m.header.sender = kMaxAgents; }),
      changed<AgentStatus>(agent_status(),
                           [](AgentStatus& m) { m.phase = static_cast<AgentPhase>(4); }),
      changed<AgentStatus>(agent_status(),
                           [](AgentStatus& m) { m.phase = static_cast<AgentPhase>(-1); }),
      changed<TeamStatus>(team_status(),
                          [](TeamStatus& m) { m.state = static_cast<MissionState>(9); }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.header.tick = -1; }),
      changed<WorldState>(world_state(), [](WorldState& m) { m.roster_revision = -1; }),
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
      changed<Command>(command(), [](Command& m) { m.header.sender = kWorld; }),
      changed<Command>(command(), [](Command& m) { m.header.sender = kMaxAgents; }),
      changed<Command>(command(), [](Command& m) { m.header.tick = -1; }),
  };
  for (std::size_t i = 0; i < std::size(lies); ++i) EXPECT_EQ(verdict(lies[i]), "range") << "lie " << i;
}

TEST(Codec, CountsThatOnlyOverflowAreRefused) {
  constexpr std::int64_t kHuge = std::numeric_limits<std::int64_t>::max();
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
       {&AgentStatus::contributions_received, &AgentStatus::contributions_lost,
        &AgentStatus::messages_sent, &AgentStatus::messages_received, &AgentStatus::missed_ticks,
        &AgentStatus::kernel_drops}) {
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
      const Words words = random_words(11, Purpose::kFault, change, round);
      bytes[8 + words.first % (bytes.size() - 8)] = static_cast<std::byte>(words.second);
    }
    if (round % 7 == 0) bytes.resize(kHeaderBytes + round % (bytes.size() - kHeaderBytes + 1));
    const Decoded decoded = decode(retagged(bytes), 0);
    if (const auto* message = std::get_if<Message>(&decoded)) {
      ++accepted;
      ASSERT_EQ(verdict(decode(encoded(*message), 0)), "accepted") << "round " << round;
    } else {
      ++refused;
    }
  }
  // Both ways out were taken often enough to mean something.
  EXPECT_GT(refused, 5000);
  EXPECT_GT(accepted, 5000);
}

// ---- what only the table can judge: bytes in, no effect ------------------------------------------

constexpr double kDt = 0.1;
constexpr std::int64_t kSteps = 1000;

Basis basis() {
  Basis basis;
  basis.modes_x = basis.modes_y = 15;
  return basis;
}

/// Block 0 of an agent that stood for 100 s where every cosine is `cosine`; S_00 is the time.
Contribution standing_still(double cosine) {
  Contribution m = contribution();
  m.steps = kSteps;
  m.elapsed_s = kSteps * kDt;
  m.block = 0;
  m.sums.fill(m.elapsed_s * cosine);
  m.sums[0] = m.elapsed_s;
  return m;
}

Merge merged_from_bytes(const Contribution& theirs, CoverageTable& table) {
  return table.merge(decoded_as<Contribution>(encoded(theirs)), kSteps);
}

void expect_no_effect(const Contribution& lie) {
  CoverageTable table(basis(), kDt);
  EXPECT_EQ(merged_from_bytes(lie, table), Merge::kRefusedRange);
  EXPECT_EQ(table.row_count(), 0u);
  Coefficients average = Coefficients::Ones(15, 15);
  table.average(average);
  EXPECT_EQ(average.cwiseAbs().maxCoeff(), 0);
}

TEST(CodecAndTable, HonestRoundingOfACosineIsAccepted) {
  // |cos| by recurrence exceeds 1 by about 3e-15.
  CoverageTable table(basis(), kDt);
  EXPECT_EQ(merged_from_bytes(standing_still(1 + 3e-15), table), Merge::kNewer);
  EXPECT_EQ(merged_from_bytes(standing_still(-1 - 3e-15), table), Merge::kStale);
}

TEST(CodecAndTable, ASumLargerThanTheTimeItCoversIsRefused) {
  expect_no_effect(standing_still(1 + 1e-8));
  expect_no_effect(standing_still(-1 - 1e-8));
}

TEST(CodecAndTable, ASumLargerThanItsOwnS00IsRefused) {
  // S_00 adds up dt itself, since f_00 = 1: it cannot differ from the time covered.
  for (const double s00 : {0.0, 50.0, -100.0, 100 * (1 - 1e-8)}) {
    Contribution lie = standing_still(1);
    lie.sums[0] = s00;
    expect_no_effect(lie);
  }
}

TEST(CodecAndTable, ASumThatIsNotANumberIsRefused) {
  for (const double bad : {kNan, -kNan, kInfinity, -kInfinity}) {
    for (const std::size_t mode : {0, 1, 127}) {
      Contribution lie = standing_still(0.5);
      lie.sums[mode] = bad;
      expect_no_effect(lie);
    }
  }
}

// ---- channels ------------------------------------------------------------------------------------

TEST(Channels, HaveTheDocumentedNames) {
  EXPECT_EQ(channel_of(hello()), "ERGOCAST_HELLO");
  EXPECT_EQ(channel_of(mission_part()), "ERGOCAST_MISSION");
  EXPECT_EQ(channel_of(contribution()), "ERGOCAST_CONTRIBUTION_3");
  EXPECT_EQ(channel_of(agent_status()), "ERGOCAST_AGENT_STATUS_3");
  EXPECT_EQ(channel_of(team_status()), "ERGOCAST_TEAM_STATUS");
  EXPECT_EQ(channel_of(stop()), "ERGOCAST_STOP");
  EXPECT_EQ(channel_of(world_state()), "ERGOCAST_WORLD_STATE");
  EXPECT_EQ(channel_of(command()), "ERGOCAST_COMMAND_2");
  EXPECT_EQ(channel_of(record_ack()), "ERGOCAST_RECORD_ACK");
}

TEST(Channels, CarryTheirOwnTypeOnly) {
  for (const Message& message : every_message()) {
    for (const Message& other : every_message()) {
      EXPECT_EQ(belongs_on(message, channel_of(other)), message.index() == other.index())
          << "message kind " << message.index() << " on " << channel_of(other);
    }
    EXPECT_FALSE(belongs_on(message, ""));
    EXPECT_FALSE(belongs_on(message, "ERGOCAST_"));
    EXPECT_FALSE(belongs_on(message, "ERGOCAST_STATUS_3"));
  }
}

TEST(Channels, NameTheSenderButForContributionsWhichOthersMayRelay) {
  EXPECT_FALSE(belongs_on(command(), "ERGOCAST_COMMAND_3"));
  EXPECT_FALSE(belongs_on(agent_status(), "ERGOCAST_AGENT_STATUS_30"));
  EXPECT_TRUE(belongs_on(contribution(), "ERGOCAST_CONTRIBUTION_9"));
}

TEST(CodecDeathTest, StopsACallerThatExceedsACount) {
  MissionPart part = mission_part();
  part.roster.assign(kMaxRosterEntriesPerMessage + 1, part.roster[0]);
  EXPECT_DEATH(encoded(part), "broken precondition");
  WorldState world = world_state();
  world.vehicle_count = kMaxVehiclesPerState + 1;
  EXPECT_DEATH(encoded(world), "broken precondition");
}

}  // namespace
}  // namespace ergocast
