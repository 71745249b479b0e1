// SPDX-License-Identifier: BSD-3-Clause
// Valid messages: every field survives, and lcm-gen's types read the same from our bytes, because
// lcm-spy and log players use them.
#include "lcmtypes/codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ergocast/agent_status_t.hpp>
#include <ergocast/amend_t.hpp>
#include <ergocast/averages_t.hpp>
#include <ergocast/beacon_t.hpp>
#include <ergocast/command_t.hpp>
#include <ergocast/contribution_t.hpp>
#include <ergocast/digest_t.hpp>
#include <ergocast/hello_t.hpp>
#include <ergocast/low_averages_t.hpp>
#include <ergocast/low_sums_t.hpp>
#include <ergocast/mission_t.hpp>
#include <ergocast/recall_t.hpp>
#include <ergocast/record_ack_t.hpp>
#include <ergocast/stop_t.hpp>
#include <ergocast/team_status_t.hpp>
#include <ergocast/world_state_t.hpp>

#include "tests/lcmtypes/sample_messages.h"

namespace ergocast {
namespace {

using namespace test;

/// The value that lcm-gen's own type reads from our bytes; it must use all of them.
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

/// docs/safety.md has the cost of this on a radio link.
TEST(Codec, ABeaconHasTwoBytesForEachTeammate) {
  Beacon one = beacon();
  for (const int team : {0, 1, 16, 64, kMaxEchoesPerMessage}) {
    one.echo_count = team;
    EXPECT_EQ(encoded(one).size(), static_cast<std::size_t>(122 + 2 * team));
  }
}

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

  const auto averages_wire = read_by_lcm<averages_t>(encoded(averages()));
  expect_header(averages_wire.header, 3);
  EXPECT_EQ(averages_wire.averages_steps, 1000);
  EXPECT_EQ(averages_wire.averages_next_broadcast_tick, 1001);
  EXPECT_EQ(averages_wire.averages_elapsed_s, 100);
  EXPECT_EQ(averages_wire.gained_steps, 10);
  EXPECT_EQ(averages_wire.averages_block, 0);
  EXPECT_EQ(averages_wire.averages_mode_count, 225);
  EXPECT_EQ(averages_wire.averages[0], 32767);
  EXPECT_EQ(averages_wire.averages[3], -32439) << "cos 3 in 1/32767";
  EXPECT_EQ(averages_wire.rates[1], -32439) << "likewise";

  const auto low_wire = read_by_lcm<low_sums_t>(encoded(low_sums()));
  expect_header(low_wire.header, 3);
  EXPECT_EQ(low_wire.low_steps, 1000);
  EXPECT_EQ(low_wire.low_next_broadcast_tick, 1001);
  EXPECT_EQ(low_wire.low_elapsed_s, 100);
  EXPECT_EQ(low_wire.low_block, 0);
  EXPECT_EQ(low_wire.low_mode_count, 225);
  EXPECT_EQ(std::memcmp(low_wire.low_sums, sums.sums.data(), sizeof low_wire.low_sums), 0);

  const auto rounded_wire = read_by_lcm<low_averages_t>(encoded(low_averages()));
  expect_header(rounded_wire.header, 3);
  EXPECT_EQ(rounded_wire.low_steps, 1000);
  EXPECT_EQ(rounded_wire.low_next_broadcast_tick, 1001);
  EXPECT_EQ(rounded_wire.low_elapsed_s, 100);
  EXPECT_EQ(rounded_wire.low_gained_steps, 10);
  EXPECT_EQ(rounded_wire.low_block, 0);
  EXPECT_EQ(rounded_wire.low_mode_count, 225);
  for (std::size_t k = 0; k < kLowModes; ++k) {
    EXPECT_EQ(rounded_wire.low_averages[k], averages_wire.averages[k]);
    EXPECT_EQ(rounded_wire.low_rates[k], averages_wire.rates[k]);
  }

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
  EXPECT_EQ(status_wire.contributions_relayed, 18);
  EXPECT_EQ(status_wire.missed_ticks, 10);
  EXPECT_TRUE(std::equal(std::begin(status_wire.refused), std::end(status_wire.refused),
                         agent_status().refused.begin()));
  EXPECT_EQ(status_wire.babbler, 22);
  EXPECT_EQ(status_wire.kernel_drops, 17);
  EXPECT_EQ(status_wire.loop_lag_s, 0.25);
  EXPECT_EQ(status_wire.blocked_by, 6);
  EXPECT_EQ(status_wire.blocked_now_ticks, 23);
  EXPECT_EQ(status_wire.blocked_ticks, 25);
  EXPECT_EQ(status_wire.longest_block_ticks, 24);
  EXPECT_EQ(status_wire.status_host, "host.example");

  const auto digest_wire = read_by_lcm<digest_t>(encoded(digest()));
  expect_header(digest_wire.header, 3);
  ASSERT_EQ(digest_wire.entry_count, 2);
  EXPECT_EQ(digest_wire.entries[0].digest_id, 0);
  EXPECT_EQ(digest_wire.entries[0].digest_incarnation, -1);
  EXPECT_EQ(digest_wire.entries[0].digest_steps, 0);
  EXPECT_EQ(digest_wire.entries[1].digest_id, 127);
  EXPECT_EQ(digest_wire.entries[1].digest_incarnation, 5);
  EXPECT_EQ(digest_wire.entries[1].digest_steps, 4711);
  EXPECT_EQ(static_cast<std::uint64_t>(digest_wire.entries[1].digest_mark), 0xfedcba9876543210);

  const auto beacon_wire = read_by_lcm<beacon_t>(encoded(beacon()));
  expect_header(beacon_wire.header, 3);
  EXPECT_EQ(beacon_wire.beacon_revision, 12);
  EXPECT_EQ(beacon_wire.beacon_position_m[0], 1.0 / 3);
  EXPECT_EQ(beacon_wire.beacon_velocity_mps[2], -6);
  EXPECT_EQ(static_cast<std::uint16_t>(beacon_wire.beacon_number), 65535);
  ASSERT_EQ(beacon_wire.echo_count, 3);
  EXPECT_EQ(static_cast<std::uint16_t>(beacon_wire.echoes[0]), 40000);
  EXPECT_EQ(beacon_wire.echoes[1], 0);
  EXPECT_EQ(beacon_wire.echoes[2], 1);

  const auto command_wire = read_by_lcm<command_t>(encoded(command()));
  expect_header(command_wire.header, 2);
  EXPECT_EQ(command_wire.command_position_m[0], 1.0 / 3);
  EXPECT_EQ(command_wire.command_position_m[1], 2);
  EXPECT_EQ(command_wire.command_position_m[2], 3);
  EXPECT_EQ(command_wire.command_velocity_mps[0], -4);
  EXPECT_EQ(command_wire.command_velocity_mps[1], 5);
  EXPECT_EQ(command_wire.command_velocity_mps[2], 6);
  EXPECT_EQ(static_cast<Incarnation>(command_wire.command_asked_by), 0xfeedfacecafebeef);
  EXPECT_EQ(command_wire.command_charge_ppm, 123456);
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
  EXPECT_FALSE(part_wire.roster[0].forgotten);
  EXPECT_EQ(part_wire.roster[1].active_until, 200);
  EXPECT_TRUE(part_wire.roster[1].forgotten);
  EXPECT_EQ(part_wire.roster[1].since_tick, 300);
  EXPECT_EQ(part_wire.roster[1].since_revision, 11);
  EXPECT_EQ(part_wire.roster[0].recall_revision, -1);
  EXPECT_EQ(part_wire.roster[1].recall_revision, 9);
  EXPECT_TRUE(part_wire.roster[1].leaves);
  ASSERT_EQ(part_wire.plan_size, 300);
  EXPECT_EQ(std::memcmp(part_wire.plan.data(), part.plan.data(), 300), 0);
  EXPECT_EQ(std::memcmp(part_wire.mission_signature, a_signature().data(), 64), 0);
  EXPECT_EQ(part_wire.stand_by_revision, 11);
  ASSERT_EQ(part_wire.amendments_size, 30);
  EXPECT_EQ(part_wire.amendments[29], 29 * 3);
  EXPECT_EQ(part_wire.reason, "because");

  const auto team_wire = read_by_lcm<team_status_t>(encoded(team_status()));
  expect_header(team_wire.header, kCoordinator);
  EXPECT_EQ(team_wire.mission_state, 2);
  EXPECT_EQ(team_wire.tick_count, 1500);
  EXPECT_EQ(team_wire.agents_alive, 3);
  EXPECT_EQ(team_wire.agents_expected, 4);
  EXPECT_EQ(team_wire.median_ergodic_metric, 1.0 / 7);
  EXPECT_EQ(team_wire.silent_agent, 2);
  EXPECT_EQ(team_wire.team_missed_deadlines, 9);
  EXPECT_EQ(team_wire.team_paused, 1);
  EXPECT_EQ(team_wire.team_host, "base.example");

  const auto stop_wire = read_by_lcm<stop_t>(encoded(stop()));
  expect_header(stop_wire.header, kOperator);
  EXPECT_EQ(std::memcmp(stop_wire.stop_signature, a_signature().data(), 64), 0);
  EXPECT_EQ(stop_wire.stop_failed, 1);
  EXPECT_EQ(stop_wire.stop_now, 1);
  EXPECT_EQ(stop_wire.stop_reason, "enough");

  const auto amend_wire = read_by_lcm<amend_t>(encoded(amend()));
  expect_header(amend_wire.header, kOperator);
  EXPECT_EQ(std::memcmp(amend_wire.amend_signature, a_signature().data(), 64), 0);
  EXPECT_EQ(amend_wire.amend_number, 3);
  EXPECT_EQ(amend_wire.amend_kind, 2);
  EXPECT_EQ(amend_wire.delay_ticks, 70);
  EXPECT_EQ(amend_wire.amend_part, 1);
  EXPECT_EQ(amend_wire.amend_parts, 4);
  ASSERT_EQ(amend_wire.amend_size, 400);
  EXPECT_EQ(amend_wire.amend_content[399], (399 * 5) % 256);
  EXPECT_EQ(amend_wire.operator_name, "anna@base");

  const auto recall_wire = read_by_lcm<recall_t>(encoded(recall()));
  expect_header(recall_wire.header, kOperator);
  EXPECT_EQ(std::memcmp(recall_wire.recall_signature, a_signature().data(), 64), 0);
  EXPECT_EQ(recall_wire.recalled_agent, 127);
  EXPECT_EQ(recall_wire.agent_leaves, 1);
}

TEST(Codec, LcmsOwnTypesReadWhatWeWroteOfTheWorld) {
  const auto wire = read_by_lcm<world_state_t>(encoded(world_state()));
  expect_header(wire.header, kWorld);
  EXPECT_EQ(wire.roster_revision, 3);
  EXPECT_EQ(wire.missed_deadlines, 4);
  EXPECT_EQ(wire.skipped_ticks, 5);
  EXPECT_EQ(wire.clamped_commands, 6);
  EXPECT_EQ(wire.uncounted_ticks, 7);
  EXPECT_EQ(static_cast<ObjectSet>(wire.found), 0x80000003);
  EXPECT_EQ(wire.state_part, 1);
  EXPECT_EQ(wire.state_parts, 8);
  ASSERT_EQ(wire.vehicle_count, 2);
  EXPECT_EQ(wire.vehicles[0].vehicle_id, 16);
  EXPECT_EQ(wire.vehicles[0].vehicle_answered_tick, 77);
  EXPECT_EQ(wire.vehicles[0].position_m[0], 1.0 / 3);
  EXPECT_EQ(wire.vehicles[0].position_m[1], -2);
  EXPECT_EQ(wire.vehicles[0].position_m[2], 3);
  EXPECT_EQ(wire.vehicles[0].velocity_mps[0], 4);
  EXPECT_EQ(static_cast<ObjectSet>(wire.vehicles[0].detected), 0x80000005);
  EXPECT_EQ(wire.vehicles[0].reported_cell, 4095);
  EXPECT_EQ(wire.vehicles[1].reported_cell, -1);
  EXPECT_EQ(wire.vehicles[0].charge_ppm, 654321);
  EXPECT_EQ(wire.vehicles[1].charge_ppm, -1);
  EXPECT_EQ(wire.vehicles[1].vehicle_id, 127);
  EXPECT_EQ(wire.vehicles[1].vehicle_answered_tick, -1);
  EXPECT_EQ(wire.vehicles[1].velocity_mps[1], -11);
  EXPECT_EQ(wire.vehicles[1].velocity_mps[2], 1e-300);

  const auto ack = read_by_lcm<record_ack_t>(encoded(record_ack()));
  expect_header(ack.ack_header, kLogger);
  EXPECT_EQ(ack.detection_probability, 0.25);
  EXPECT_EQ(ack.wrong_confirmations, 3);
  ASSERT_EQ(ack.find_count, 2);
  EXPECT_EQ(ack.finds[0].object, 31);
  EXPECT_EQ(ack.finds[0].find_agent, 127);
  EXPECT_EQ(ack.finds[0].find_tick, 4711);
  EXPECT_EQ(ack.finds[0].find_y_m, -2);
  ASSERT_EQ(ack.contact_count, 1);
  EXPECT_EQ(ack.contacts[0].contact_cell, 4095);
  EXPECT_EQ(ack.contacts[0].contact_reports, 3);
  EXPECT_EQ(ack.contacts[0].contact_newest, 4711);
  EXPECT_EQ(ack.contacts[0].contact_probability, 0.75);
  EXPECT_TRUE(ack.contacts[0].contact_confirmed);
}

TEST(Codec, EveryMessageComesBackAsTheSameMessage) {
  // LCM's types above show that every field is in the bytes, so equal bytes mean equal fields.
  for (const Message& message : every_message()) {
    const Bytes bytes = encoded(message);
    const Decoded decoded = decode(bytes, kRun);
    ASSERT_EQ(verdict(decoded), "accepted") << "message kind " << message.index();
    EXPECT_EQ(decoded->index(), message.index());
    EXPECT_EQ(encoded(*decoded), bytes) << "message kind " << message.index();
  }
}

TEST(Codec, StopKeepsWhetherTheMissionFailed) {
  Stop wanted = stop();
  wanted.failed = false;
  EXPECT_FALSE(decoded_as<Stop>(encoded(wanted)).failed);
  EXPECT_TRUE(decoded_as<Stop>(encoded(stop())).failed);
  wanted.now = false;
  EXPECT_FALSE(decoded_as<Stop>(encoded(wanted)).now);
  EXPECT_TRUE(decoded_as<Stop>(encoded(stop())).now);
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
  part.plan.assign(kMaxPlanBytesPerMessage - part.amendments.size(), std::byte{1});
  part.reason.assign(kMaxReasonLength, 'r');
  WorldState world = world_state();
  world.vehicle_count = kMaxVehiclesPerState;
  AgentStatus status = agent_status();
  status.host.assign(kMaxHostLength, 'h');
  TeamStatus team = team_status();
  team.host.assign(kMaxHostLength, 'h');
  Amend amendment = amend();
  amendment.content.assign(kMaxPlanBytesPerMessage, std::byte{1});
  amendment.by.assign(kMaxOperatorNameLength, 'a');
  for (const Message& message :
       {Message(part), Message(world), Message(status), Message(team), Message(amendment)}) {
    EXPECT_LE(encoded(message).size(), kMaxDatagramBytes);
    EXPECT_EQ(verdict(message), "accepted");
  }
  for (const int finds : {0, 16, 20, kMaxObjects}) {
    RecordAck ack = record_ack();
    ack.finds.fill(ack.finds[0]);
    ack.contacts.fill(ack.contacts[0]);
    ack.find_count = finds;
    ack.contact_count = ack.contact_room();
    EXPECT_GE(ack.contact_count, 4) << finds;
    EXPECT_LE(encoded(ack).size(), kMaxDatagramBytes) << finds;
    EXPECT_EQ(verdict(Message(ack)), "accepted") << finds;
  }
  EXPECT_LE(encoded(contribution()).size(), kMaxDatagramBytes);
  EXPECT_LE(encoded(averages()).size(), kMaxDatagramBytes);
  EXPECT_EQ(encoded(contribution()).size() - encoded(low_sums()).size(), 64 * sizeof(double));
  EXPECT_EQ(encoded(averages()).size() - encoded(low_averages()).size(), 2 * 192 * 2);
}

TEST(Codec, StringsAreCutAtTheirLimitsAndAtANul) {
  const Hello long_names{header_of_sender(-1), -1, std::string(500, 'h'), std::string(500, 'v')};
  const auto cut = decoded_as<Hello>(encoded(long_names));
  EXPECT_EQ(cut.host, std::string(kMaxHostLength, 'h'));
  EXPECT_EQ(cut.version, std::string(kMaxVersionLength, 'v'));
  // A text is not cut within a character.
  const std::string room(kMaxHostLength - 1, 'h');
  const Hello accent{header_of_sender(-1), -1, room + "\u00e9", ""};
  EXPECT_EQ(decoded_as<Hello>(encoded(accent)).host, room);
  const auto long_reason =
      decoded_as<Stop>(encoded(Stop{header_of_sender(kOperator), true, std::string(5000, 'r')}));
  EXPECT_EQ(long_reason.reason, std::string(kMaxReasonLength, 'r'));
  const auto nul = decoded_as<Stop>(
      encoded(Stop{header_of_sender(kOperator), true, std::string("one\0two", 7)}));
  EXPECT_EQ(nul.reason, "one");
  const auto escape = decoded_as<Stop>(
      encoded(Stop{header_of_sender(kOperator), true, "red \x1b[31m\nand bell\a"}));
  EXPECT_EQ(escape.reason, "red  [31m and bell ");
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
