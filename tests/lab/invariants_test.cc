// SPDX-License-Identifier: BSD-3-Clause
// Every invariant can fail: states that violate it, and the same states without the violation.
#include "lab/invariants.h"

#include <limits>

#include "tests/lab/invariants_fixture.h"

namespace ergocast::test {
namespace {

TEST_F(InvariantsTest, PositionsAreInTheDomain) {
  EXPECT_EQ(violated(), "");
  team_.sent(1, world(1, {10.1, 5, 0}), nullptr);
  EXPECT_EQ(violated(), "positions are in the domain");
}

TEST_F(InvariantsTest, BodiesKeepOutOfWalls) {
  mission_.walls = {{{2, 2}, {8, 2}, {8, 8}, {2, 8}}, {{4, 4}, {6, 4}, {6, 6}, {4, 6}}};
  mission_.wall_clearance_m = 0.5;
  for (const Eigen::Vector3d& x_m : {Eigen::Vector3d(1.5, 5, 0), Eigen::Vector3d(1.7, 1.5, 0),
                                     Eigen::Vector3d(5, 4.5, 0), Eigen::Vector3d(9, 9, 0)}) {
    Invariants team(mission_);
    team.sent(0, world(1, x_m), nullptr);
    EXPECT_EQ(violated_by(team), "") << x_m.transpose();
  }
  for (const Eigen::Vector3d& x_m : {Eigen::Vector3d(1.6, 5, 0), Eigen::Vector3d(1.7, 1.7, 0),
                                     Eigen::Vector3d(5, 4.4, 0), Eigen::Vector3d(3, 5, 0)}) {
    Invariants team(mission_);
    team.sent(0, world(1, x_m), nullptr);
    EXPECT_EQ(violated_by(team), "bodies keep out of walls") << x_m.transpose();
  }
}

TEST_F(InvariantsTest, InputsAreBounded) {
  const TableView one = answering();
  team_.sent(1, command(2), &one);
  EXPECT_EQ(violated(), "");
  team_.sent(1, command(2.0001), &one);
  EXPECT_EQ(violated(), "|u| <= u_max");
}

TEST_F(InvariantsTest, InputsAreBoundedByTheLawThatHolds) {
  Amendments list;
  LawChange law = plans_law(mission_);
  law.kinds[0].u_max_mps = 1;
  name_law(list, 0, law);
  TableView one = answering();
  one.amendments = &list;
  team_.sent(1, command(1), &one);
  EXPECT_EQ(violated(), "");
  Invariants other(mission_);
  other.sent(1, command(1.0001), &one);
  EXPECT_EQ(violated_by(other), "|u| <= u_max");
  list.laws[0].from = 1'000'000;
  Invariants before(mission_);
  before.sent(1, command(2), &one);
  EXPECT_EQ(violated_by(before), "");
}

TEST_F(InvariantsTest, NotANumberIsNoInput) {
  const TableView one = answering();
  team_.sent(1, command(std::numeric_limits<double>::quiet_NaN()), &one);
  EXPECT_EQ(violated(), "|u| <= u_max");
}

TEST_F(InvariantsTest, SumsAreAtMostTheTimeCovered) {
  CoverageTable table(mission_.basis, 0.1);
  cover(table, kOne, 20);
  Contribution block = table.block(kOne, 0);
  team_.sent(1, {Bus::kSwarm, block}, nullptr);
  EXPECT_EQ(violated(), "");
  block.sums.edit()[5] = 2.1;
  team_.sent(1, {Bus::kSwarm, block}, nullptr);
  EXPECT_EQ(violated(), "S_00 = time covered, |S_mn| <= S_00, or 3 S_00 after a change");
}

TEST_F(InvariantsTest, RelaysAnswerDigests) {
  CoverageTable table(mission_.basis, 0.1);
  cover(table, kTwo, 20);
  const TableView one = holder(table, c_one_);
  Digest asks;
  asks.entry_count = 1;
  team_.digest_received(kOne, asks);
  const Outgoing relay{Bus::kSwarm, table.block(kTwo, 0), 0};
  team_.sent(1, relay, &one);
  team_.sent(1, relay, &one);
  EXPECT_EQ(violated(), "");
  team_.sent(1, relay, &one);
  EXPECT_EQ(violated(), "a relay answers a digest");
}

TEST_F(InvariantsTest, DigestsListWhatIsHeld) {
  CoverageTable table(mission_.basis, 0.1);
  cover(table, kOne, 20);
  const TableView one = holder(table, c_one_);
  Digest digest;
  digest.entry_count = 3;
  digest.entries[0] = {kOne, 20, 0};
  digest.entries[1] = {kLeft, 0, 0};
  digest.entries[2] = {kTwo, 0, 0};
  team_.sent(1, {Bus::kSwarm, digest}, &one);
  EXPECT_EQ(violated(), "");
  digest.entries[0].steps = 21;
  team_.sent(1, {Bus::kSwarm, digest}, &one);
  EXPECT_EQ(violated(), "a digest lists what is held");
}

TEST_F(InvariantsTest, DamagedMessagesAreRefusedAndOthersAreNot) {
  team_.decoded(1, failure(Refusal::kTag), true);
  team_.decoded(1, RecordAck{}, false);
  EXPECT_EQ(violated(), "");
  Invariants other(mission_);
  other.decoded(1, RecordAck{}, true);
  EXPECT_EQ(violated_by(other), "no damaged message is accepted");
  team_.decoded(1, failure(Refusal::kRange), false);
  EXPECT_EQ(violated(), "no whole message is refused");
}

TEST_F(InvariantsTest, HonestMessagesAreNotRefused) {
  RefusalCounts counts{};
  team_.refused(1, kOne, counts);
  EXPECT_EQ(violated(), "");
  counts[static_cast<std::size_t>(Refusal::kRange)] = 1;
  team_.refused(1, kOne, counts);
  EXPECT_EQ(violated(), "no honest message is refused");
}

TEST_F(InvariantsTest, NoAgentEndsBeforeTheMission) {
  team_.finished(1, kOne, "mission complete", true);
  EXPECT_EQ(violated(), "");
  team_.finished(1, kOne, "lonely", false);
  EXPECT_EQ(violated(), "no agent ends before the mission");
}

TEST_F(InvariantsTest, NoProcessAsksForThePast) {
  team_.wakeup(1, "agent 0", false);
  EXPECT_EQ(violated(), "");
  team_.wakeup(1, "agent 0", true);
  EXPECT_EQ(violated(), "no process asks to be woken in the past");
}

TEST_F(InvariantsTest, EveryProcessIsBack) {
  TableView outside;
  outside.self = kOne;
  team_.recovered(1, {outside});
  EXPECT_EQ(violated(), "every process is back in the mission");
}

TEST_F(InvariantsTest, RelaysStopOnceAllKnowAll) {
  CoverageTable table(mission_.basis, 0.1);
  cover(table, kTwo, 20);
  const TableView one = holder(table, c_one_);
  Digest asks;
  asks.entry_count = 10;
  team_.digest_received(kOne, asks);
  const Outgoing relay{Bus::kSwarm, table.block(kTwo, 0), 0};
  team_.sent(1, relay, &one);
  team_.recovered(2, {one});
  EXPECT_EQ(violated(), "");
  team_.sent(3, relay, &one);
  team_.recovered(4, {one});
  EXPECT_EQ(violated(), "relays stop once all know all");
}

TEST_F(InvariantsTest, TheMissionEndsWell) {
  RunFacts good;
  good.ergodic_metric_last = 0.1;
  const auto sent = [&](const std::string& running, const std::string& failure, Tick tick,
                        double metric, Tick recorded = 100, Tick excused = 0) {
    Invariants team(mission_);
    team.sent(0, world(tick, {1, 1, 0}), nullptr);
    RunFacts facts;
    facts.ergodic_metric_last = metric;
    facts.ticks = recorded;
    team.ended(1, running, failure, facts, excused);
    return violated_by(team);
  };
  EXPECT_EQ(sent("", "", 100, 0.1), "");
  EXPECT_EQ(sent("agent 1", "", 100, 0.1), "every process ends");
  EXPECT_EQ(sent("", "bad luck", 100, 0.1), "the mission does not fail");
  EXPECT_EQ(sent("", "", 99, 0.1), "the mission reaches its last tick");
  EXPECT_EQ(sent("", "", 100, 0.1, 0), "the record has every tick");
  EXPECT_EQ(sent("", "", 100, 0.1, 79, 20), "the record has every tick");
  EXPECT_EQ(sent("", "", 100, 0.1, 80, 20), "");
  EXPECT_EQ(sent("", "", 100, 0.2), "the goal is reached");
}

}  // namespace
}  // namespace ergocast::test
