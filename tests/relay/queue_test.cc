// SPDX-License-Identifier: BSD-3-Clause
// What a full link carries: newer messages in the place of older ones, never another part, orders
// first, and no kind not at all.
#include <algorithm>
#include <map>

#include "relay/gate.h"
#include "relay/outbound_queue.h"
#include "relay/packets.h"
#include "tests/relay/small_network.h"

namespace ergocast::relay {
namespace {

struct Queue : ::testing::Test {
  Gate gate{key(1), false};
  OutboundQueue queue;

  void add(const Message& message, AgentId relayer = kUnassigned, bool full = true) {
    const Datagram datagram = datagram_of(message, key(1), relayer);
    const auto admitted = gate.admit(Bus::kSwarm, datagram);
    ASSERT_TRUE(admitted.has_value());
    queue.add(*admitted, Bus::kSwarm, datagram, full);
  }
  Message take() {
    const auto parsed = parse_datagram(queue.next().datagram);
    const Message message = decode(parsed->message, 0, key(1), parsed->channel).value();
    queue.pop();
    return message;
  }
  std::vector<Message> all() {
    std::vector<Message> messages;
    while (!queue.empty()) messages.push_back(take());
    return messages;
  }
  /// How many beacons of ten agents, added last, are among the next 20 messages.
  std::int64_t early_of_ten_beacons() {
    for (int agent = 0; agent < 10; ++agent) {
      Beacon beacon = test::beacon();
      beacon.header.sender = agent;
      add(beacon);
    }
    const auto sent = all();
    return std::count_if(sent.begin(), sent.begin() + 20,
                         [](const Message& one) { return std::holds_alternative<Beacon>(one); });
  }
};

Contribution block(std::int32_t block, std::int64_t steps) {
  Contribution contribution = test::contribution();
  contribution.mode_count = 400;
  contribution.block = block;
  contribution.sums = BlockSums();
  contribution.sums.set_all(128);
  contribution.steps = steps;
  contribution.elapsed_s = static_cast<double>(steps);
  return contribution;
}

TEST_F(Queue, ANewerMessageReplacesAnOlderOneOnlyWhileTheLinkIsFull) {
  add(status(1)), add(status(2));
  ASSERT_EQ(queue.dropped().replaced, 1);
  const auto sent = all();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(header_of(sent[0]).sequence, 2);
  add(status(3), kUnassigned, false), add(status(4), kUnassigned, false);
  EXPECT_EQ(all().size(), 2U);
}

TEST_F(Queue, AnOlderMessageNeverReplacesANewerOne) {
  add(status(5)), add(status(4));
  EXPECT_EQ(queue.dropped().overtaken, 1);
  EXPECT_EQ(header_of(all().at(0)).sequence, 5);
}

TEST_F(Queue, PartsBlocksAuthorsAndRelayersStaySeparate) {
  add(block(0, 10)), add(block(1, 10)), add(block(0, 10), 9);
  add(status(1, 3)), add(status(1, 4));
  MissionPart part = test::mission_part();
  add(part);
  part.part = 3;
  add(part);
  part.revision = 13;
  add(part);
  EXPECT_EQ(queue.dropped().total(), 0);
  add(block(1, 11)), add(block(1, 9));
  EXPECT_EQ(queue.dropped().replaced, 1);
  EXPECT_EQ(queue.dropped().overtaken, 1);
  EXPECT_EQ(all().size(), 8U);
}

TEST_F(Queue, BothCommandsThatAnswerANewWorldAreSent) {
  Command command = test::command();
  command.asked_by = 7;
  add(command);
  ++command.header.sequence;
  add(command);
  EXPECT_EQ(all().size(), 2U);
}

TEST_F(Queue, OrdersComeFirst) {
  for (int i = 0; i < 50; ++i) add(status(1, i));
  add(test::beacon());
  Amend pause = test::amend();
  pause.part = 0, pause.parts = 1;
  add(test::stop()), add(pause), add(test::recall());
  const auto sent = all();
  EXPECT_TRUE(std::holds_alternative<Stop>(sent.at(0)));
  EXPECT_TRUE(std::holds_alternative<Amend>(sent.at(1)));
  EXPECT_TRUE(std::holds_alternative<Recall>(sent.at(2)));
}

TEST_F(Queue, NoKindStarvesWhereAnotherFillsTheLink) {
  std::map<std::size_t, int> sent;
  for (int turn = 0; turn < 400; ++turn) {
    for (int agent = 0; agent < 8; ++agent) {
      Beacon beacon = test::beacon();
      beacon.header.sender = agent;
      beacon.header.sequence = turn;
      add(beacon);
      Contribution contribution = block(0, turn + 1);
      contribution.header.sender = agent;
      add(contribution);
      add(status(turn, agent));
    }
    ++sent[static_cast<std::size_t>(decode(parse_datagram(queue.next().datagram)->message, 0,
                                           key(1), parse_datagram(queue.next().datagram)->channel)
                                        .value()
                                        .index())];
    queue.pop();
  }
  EXPECT_GT(sent[type_index<Beacon>()], sent[type_index<Contribution>()]);
  EXPECT_GT(sent[type_index<Contribution>()], 20);
  EXPECT_GT(sent[type_index<AgentStatus>()], 20);
}

TEST_F(Queue, ALineThatHadTheLinkAloneKeepsItsShare) {
  for (std::int64_t i = 0; i < 500; ++i) {
    Beacon beacon = test::beacon();
    beacon.header.sequence = i;
    add(beacon);
    all();
  }
  for (int agent = 0; agent < 100; ++agent) add(status(1, agent));
  EXPECT_GE(early_of_ten_beacons(), 8);
}

TEST_F(Queue, AMissionOfManyPartsAndALongTargetDelayNoBeacon) {
  MissionPart mission = test::mission_part();
  mission.parts = 500;
  for (mission.part = 0; mission.part < mission.parts; ++mission.part) add(mission);
  Amend target = test::amend();
  for (target.part = 0; target.part < target.parts; ++target.part) add(target);
  EXPECT_EQ(early_of_ten_beacons(), 10);
}

/// How many of 60 states in three parts are sent whole by a link for two parts of three.
/// @param after  how many datagrams the link takes after each part
int whole_states(Queue& test, const std::array<int, 3>& after) {
  std::map<Tick, int> parts_sent;
  WorldState state = test::world_state();
  state.parts = 3;
  state.uncounted_ticks = 0;
  for (Vehicle& vehicle : state.vehicles_in_part()) vehicle.answered_tick = 0;
  for (state.header.tick = 1; state.header.tick <= 60; ++state.header.tick) {
    for (state.part = 0; state.part < state.parts; ++state.part) {
      ++state.header.sequence;
      test.add(state);
      for (int i = 0; i < after[static_cast<std::size_t>(state.part)]; ++i) {
        ++parts_sent[header_of(test.take()).tick];
      }
    }
  }
  EXPECT_LE(test.all().size(), 6U) << "the queue does not grow";
  return static_cast<int>(std::count_if(parts_sent.begin(), parts_sent.end(),
                                        [](const auto& one) { return one.second == 3; }));
}

TEST_F(Queue, TheWorldsStatesAreSentWholeAtAnyMoment) {
  for (const std::array<int, 3>& after :
       std::vector<std::array<int, 3>>{{0, 0, 2}, {0, 2, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}) {
    EXPECT_GE(whole_states(*this, after), 20) << after[0] << after[1] << after[2];
  }
}

TEST_F(Queue, BeyondItsLimitTheLeastUrgentGoesFirst) {
  for (std::int64_t i = 0; i < 6000; ++i) add(status(i), kUnassigned, false);
  add(test::stop());
  EXPECT_GT(queue.dropped().overflow, 0);
  std::size_t bytes = 0;
  EXPECT_TRUE(
      std::holds_alternative<Stop>(decode(parse_datagram(queue.next().datagram)->message, 0, key(1),
                                          parse_datagram(queue.next().datagram)->channel)
                                       .value()));
  for (; !queue.empty(); queue.pop()) bytes += queue.next().datagram.size();
  EXPECT_LE(bytes, OutboundQueue::kMostBytes);
}

TEST(SenderOfAFlow, KeepsItsRate) {
  Gate gate(key(1), false);
  Sender sender(10000);
  Instant now{100s};
  std::size_t bytes = 0;
  constexpr std::chrono::milliseconds kTurn(1);
  for (std::int64_t i = 0; i < 10000; ++i, now += kTurn) {
    const Datagram datagram = datagram_of(status(i, static_cast<AgentId>(i % 50)), key(1));
    sender.add(*gate.admit(Bus::kSwarm, datagram), Bus::kSwarm, datagram);
    while (const auto packet = sender.next_packet(now)) bytes += packet->size() + 28;
  }
  EXPECT_LE(bytes, 10U * 10000 + 3000 + 1400);
  EXPECT_GE(bytes, 10U * 10000 - 1400);
  EXPECT_GT(sender.dropped().replaced, 5000);
}

TEST(SenderOfAFlow, BundlesNoMoreThanEveryPathTakes) {
  constexpr std::size_t kLeastMtuBytes = 1280, kIpv6AndUdpBytes = 48;
  Gate gate(key(1), false);
  Sender sender(0);
  for (AgentId agent = 0; agent < 100; ++agent) {
    const Datagram datagram = datagram_of(status(1, agent), key(1));
    sender.add(*gate.admit(Bus::kSwarm, datagram), Bus::kSwarm, datagram);
  }
  while (const auto packet = sender.next_packet(Instant{})) {
    EXPECT_LE(packet->size() + kIpv6AndUdpBytes, kLeastMtuBytes);
  }
}

// ---- the gate ----

TEST(TheGate, RefusesWhatHasAnotherKeyOrNone) {
  Gate gate(key(1), false);
  EXPECT_TRUE(gate.admit(Bus::kSwarm, datagram_of(status(1), key(1))));
  EXPECT_FALSE(gate.admit(Bus::kSwarm, datagram_of(status(1), key(2))));
  EXPECT_FALSE(gate.admit(Bus::kSwarm, datagram_of(status(1), {})));
  EXPECT_EQ(gate.refused()[static_cast<std::size_t>(Refusal::kTag)], 1);
  EXPECT_EQ(gate.refused()[static_cast<std::size_t>(Refusal::kUnkeyed)], 1);
  const std::string fragment = "LC03 and more than a header of a fragment";
  EXPECT_FALSE(gate.admit(Bus::kSwarm, std::as_bytes(std::span(fragment))));
  Gate insecure({}, true);
  EXPECT_TRUE(insecure.admit(Bus::kSwarm, std::as_bytes(std::span(fragment))));
}

TEST(DataPackets, CarryTheLongestDatagramOfUdpUnchanged) {
  Datagram longest(kMaxGroupBytes, std::byte{9});
  for (const char* magic : {"LC02", "LC03"}) {
    std::copy_n(reinterpret_cast<const std::byte*>(magic), 4, longest.begin());
    std::vector<std::byte> packet;
    append_frame(packet, Bus::kCommand, longest);
    EXPECT_LE(packet.size(), kMaxGroupBytes);
    const auto frames = frames_of(packet);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].bus, Bus::kCommand);
    EXPECT_EQ(frames[0].bytes, longest);
  }
}

}  // namespace
}  // namespace ergocast::relay
