// SPDX-License-Identifier: BSD-3-Clause
// Every invariant can fail: states that violate it, and the same states without the violation.
#include "lab/invariants.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/law/forecast.h"
#include "tests/support/team.h"

namespace ergocast::test {
namespace {

using lab::Invariants;
using lab::TableView;

/// The name of what was violated.
std::string violated_by(const Invariants& team) {
  return team.violation() ? std::string(name_of(team.violation()->invariant)) : "";
}

class InvariantsTest : public ::testing::Test {
 protected:
  InvariantsTest() : mission_(mission()), team_(mission_) {
    for (const Author& author : {kOne, kTwo, kLeft}) {
      team_.started(author);
      roster_.push_back({author, 0, author == kLeft ? 10 : -1});
    }
    team_.sent(0, world(99, {5, 5, 0}), nullptr);
  }

  static Mission mission() {
    Mission m;
    m.domain = {{0, 0, 0}, {10, 10, 0}};
    m.basis.modes_x = m.basis.modes_y = 12;
    m.target_coefficients = Coefficients::Zero(144);
    m.law.u_max_mps = 2;
    m.timing.dt_s = 0.1;
    m.timing.tick_count = 100;
    m.starts_m.resize(2);
    m.goal_ergodic_metric = 0.1;
    return m;
  }

  static Outgoing world(Tick tick, const Eigen::Vector3d& x_m) {
    WorldState state;
    state.header.tick = tick;
    state.vehicle_count = 1;
    state.vehicles[0].position_m = x_m;
    return {Bus::kWorld, state};
  }
  static Outgoing command(double speed_mps) {
    Command c;
    c.header.tick = 3;
    c.velocity_mps = {speed_mps, 0, 0};
    return {Bus::kCommand, c};
  }
  void cover(CoverageTable& table, const Author& author, int steps, double x_m = 3) {
    for (int i = 0; i < steps; ++i) {
      table.add_sample(author, BasisAt({x_m, 4, 0}, mission_.domain, mission_.basis));
    }
  }
  /// An agent that holds coverage of all agents.
  TableView holder(const CoverageTable& table, Coefficients& c, const Author& self = kOne) {
    c = Coefficients::Zero(144);
    table.average(c);
    TableView view{self, &table, &c, &roster_, 88};
    view.counted = 88;
    return view;
  }
  /// An agent that answers the tick of command().
  static TableView answering() {
    TableView view;
    view.self = kOne;
    view.answered = view.counted = 3;
    return view;
  }
  std::string violated() const { return violated_by(team_); }
  /// The invariant that a ĉ violates which is wrong by `off`. Before, two blocks of a teammate have
  /// arrived, and then its place.
  /// @param later  the roster from the admission on
  std::string violated_by_forecast(double off, const std::vector<RosterEntry>& later) {
    Invariants team(mission_);
    team.started(kOne);
    team.started(kTwo);
    team.sent(0, world(99, {5, 5, 0}), nullptr);
    CoverageTable table(mission_.basis, 0.1), other(mission_.basis, 0.1);
    Forecast forecast(mission_, kOne);
    TableView one = holder(table, c_one_);
    team.received(one, MissionPart());
    one.roster = &later;
    team.received(one, MissionPart());
    const auto receive = [&](Tick tick, std::int64_t steps) {
      cover(other, kTwo, 1, static_cast<double>(steps) / 10);
      for (const int b : {1, 0}) {
        Contribution block = other.block(kTwo, b);
        block.header.tick = tick;
        block.next_broadcast_tick = tick + 1;
        table.merge(block, 100);
        team.received(one, block);
      }
    };
    cover(table, kOne, 80);
    cover(other, kTwo, 50);
    receive(83, 51);
    cover(other, kTwo, 3, 9);
    receive(86, 55);
    const Outgoing seen = world(88, {7, 3, 0});
    WorldState state = std::get<WorldState>(seen.message);
    state.vehicles[0].id = kTwo.agent;
    team.received(one, state);
    forecast.see(kTwo.agent, 88, {7, 3, 0});
    one = holder(table, c_one_);
    one.roster = &later;
    c_two_ = Coefficients::Zero(144);
    forecast.look_ahead(table, later, one.answered, c_two_);
    c_two_[47] += off;
    one.foreseen = &c_two_;
    team.answered(1, one);
    return violated_by(team);
  }

  static constexpr Author kOne{0, 11}, kTwo{1, 22}, kLeft{1, 21};
  Mission mission_;
  Invariants team_;
  std::vector<RosterEntry> roster_;
  Coefficients c_one_, c_two_;
};

/// The invariant that the last state of a mission violates. In this state agent 0 is at `x_m`, and
/// its station is at (10, 10). The other agents are at `others_m`. If `sent_out`, they have left
/// the mission, and their vehicles stand there for good.
std::string violated_at_home(const Eigen::Vector2d& x_m,
                             const std::vector<Eigen::Vector2d>& others_m, bool sent_out = true) {
  const int agents = 1 + static_cast<int>(others_m.size());
  Mission mission = small_mission(agents);
  mission.domain.size_m = {60, 40, 0};
  mission.law.u_max_mps = 3;
  mission.speed_limit_mps = 4;
  mission.timing.dt_s = 0.1;
  mission.separation.distance_m = 2;
  for (int i = 0; i < agents; ++i) mission.starts_m[static_cast<std::size_t>(i)] = {5.0 * i, 5, 0};
  mission.kinds = {{"a", 1, 3, 0, 0}, {"b", agents - 1, 3, 0, 0}};
  mission.kinds[0].stations_m = {{10, 10, 0}};
  mission.kinds[0].reserve_s = 1;
  announce(mission);
  std::vector<RosterEntry> roster = roster_of(agents);
  std::vector<Eigen::Vector3d> places_m = {{x_m.x(), x_m.y(), 0}};
  for (std::size_t i = 0; i < others_m.size(); ++i) {
    places_m.emplace_back(others_m[i].x(), others_m[i].y(), 0);
    if (!sent_out) continue;
    roster[i + 1].recall_revision = 0;
    roster[i + 1].active_until = 50;
    roster[i + 1].leaves = true;
  }
  Invariants team(mission);
  team.sent(0, {Bus::kSwarm, mission_part(0, MissionState::kRunning, roster)}, nullptr);
  team.sent(1, {Bus::kWorld, world_state(mission.timing.tick_count, places_m)}, nullptr);
  return violated_by(team);
}

TEST(InvariantsOfHome, AnAgentIsAtItsStationInTheEnd) {
  EXPECT_EQ(violated_at_home({10.5, 10}, {{40, 30}}), "");
  EXPECT_EQ(violated_at_home({10.7, 10}, {{40, 30}}), "agents are home in time");
}

TEST(InvariantsOfHome, OrAsNearAsItCanGetIfAVehicleStandsThereForGood) {
  EXPECT_EQ(violated_at_home({8.7, 10}, {{10.7, 10}}), "");
  EXPECT_EQ(violated_at_home({7.9, 10}, {{10.7, 10}}), "agents are home in time");
  EXPECT_EQ(violated_at_home({8.7, 10}, {{10.7, 10}}, false), "agents are home in time")
      << "that vehicle could go away";
}

TEST(InvariantsOfHome, OrEnclosedByVehiclesThatStandForGood) {
  const std::vector<Eigen::Vector2d> fence = {{55.6, 38.6}, {56, 36.2}, {58.4, 35.6}};
  EXPECT_EQ(violated_at_home({57.5, 37.8}, fence), "");
  EXPECT_EQ(violated_at_home({58.5, 38.5}, fence), "agents are home in time")
      << "it could be nearer";
  EXPECT_EQ(violated_at_home({57.5, 37.8}, {{55, 38.6}, {58.4, 35}}), "agents are home in time")
      << "there is a gap";
}

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

TEST_F(InvariantsTest, WhatIsHeldNeverShrinks) {
  CoverageTable much(mission_.basis, 0.1), less(mission_.basis, 0.1);
  cover(much, kTwo, 20);
  cover(less, kTwo, 19);
  team_.answered(1, holder(much, c_one_));
  EXPECT_EQ(violated(), "");
  team_.answered(2, holder(less, c_one_));
  EXPECT_EQ(violated(), "what is held never shrinks");
}

TEST_F(InvariantsTest, NoStepCountsTwice) {
  CoverageTable table(mission_.basis, 0.1);
  cover(table, kTwo, 60);
  cover(table, kLeft, 41);  // 100 ticks, and one sampled by both
  team_.answered(1, holder(table, c_one_));
  EXPECT_EQ(violated(), "");
  cover(table, kLeft, 1);
  team_.answered(2, holder(table, c_one_));
  EXPECT_EQ(violated(), "no step counts twice");
}

TEST_F(InvariantsTest, ATickCountsUnlessTheMissionIsPausedAsFarAsTheAgentKnows) {
  mission_.timing.pace = Pace::kRealtime;
  const std::vector<Hold> paused{{4, 7}};
  // The argument has the number of steps that each tick adds, from tick 0 on.
  const auto violated_by_steps = [&](const std::vector<int>& steps) {
    Invariants team(mission_);
    CoverageTable table(mission_.basis, 0.1);
    for (std::size_t tick = 0; tick < steps.size(); ++tick) {
      cover(table, kOne, steps[tick]);
      TableView view = holder(table, c_one_);
      view.answered = static_cast<Tick>(tick);
      view.holds = paused;
      team.began(1, view);
    }
    return violated_by(team);
  };
  EXPECT_EQ(violated_by_steps({0, 0, 1, 1, 0, 0, 0, 1}), "") << "admitted at tick 2";
  EXPECT_EQ(violated_by_steps({1, 1, 1, 1, 0, 0, 1}), "nothing counts while paused or at rest");
  EXPECT_EQ(violated_by_steps({1, 1, 1, 1, 0, 0, 0, 0}),
            "every tick counts unless paused or at rest");
}

TEST_F(InvariantsTest, TheAverageIsWeightedByTime) {
  CoverageTable table(mission_.basis, 0.1), one(mission_.basis, 0.1), two(mission_.basis, 0.1);
  for (CoverageTable* rows : {&table, &one}) cover(*rows, kOne, 30, 2);
  for (CoverageTable* rows : {&table, &two}) cover(*rows, kTwo, 10, 8);
  const TableView right = holder(table, c_one_);
  team_.answered(1, right);
  EXPECT_EQ(violated(), "");
  Coefficients a = Coefficients::Zero(144), b = a;
  one.average(a);
  two.average(b);
  c_one_ = (a + b) / 2;
  team_.answered(2, right);
  EXPECT_EQ(violated(), "c_k = sum S / sum elapsed of what is held");
}

TEST_F(InvariantsTest, WhatIsForeseenFollowsFromWhatIsKnown) {
  mission_.target_coefficients[0] = 1;
  for (const bool dead_reckons : {false, true}) {
    mission_.dead_reckoning = dead_reckons;
    mission_.law.anticipation = 2;
    EXPECT_EQ(violated_by_forecast(0, roster_), "") << dead_reckons;
    EXPECT_EQ(violated_by_forecast(1e-9, roster_), "forecast of what is known") << dead_reckons;
    mission_.law.anticipation = 0;
    EXPECT_EQ(violated_by_forecast(1e-9, roster_), "")
        << dead_reckons << ": this law foresees nothing";
  }
}

TEST_F(InvariantsTest, WhatIsForeseenIsTheSameWhenAnAdmissionIsLostWithItsCoordinator) {
  mission_.target_coefficients[0] = 1;
  mission_.law.anticipation = 2;
  const std::vector<RosterEntry> lost(roster_.begin() + 1, roster_.end());
  std::vector<RosterEntry> anew = roster_;
  anew.front().active_from = 89;
  for (const bool dead_reckons : {false, true}) {
    mission_.dead_reckoning = dead_reckons;
    for (const auto& later : {lost, anew}) {
      EXPECT_EQ(violated_by_forecast(0, later), "") << dead_reckons << ", " << later.size();
      EXPECT_EQ(violated_by_forecast(1e-9, later), "forecast of what is known")
          << dead_reckons << ", " << later.size();
    }
  }
}

TEST_F(InvariantsTest, ANewcomerCoversNothingBeforeItsFirstTickEvenIfItsAdmissionIsLost) {
  const CoverageTable nothing(mission_.basis, 0.1);
  for (const Tick first : {89, 88}) {
    Invariants team(mission_);
    roster_.insert(roster_.begin(), {{0, 12}, first});
    const TableView newcomer = holder(nothing, c_one_, {0, 12});
    team.received(newcomer, MissionPart());
    roster_.erase(roster_.begin());
    team.answered(1, newcomer);
    EXPECT_EQ(violated_by(team), newcomer.answered < first ? "" : "c_00 = 1");
  }
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

TEST_F(InvariantsTest, EveryAgentLearnsEveryRow) {
  CoverageTable one(mission_.basis, 0.1), two(mission_.basis, 0.1);
  for (CoverageTable* table : {&one, &two}) cover(*table, kTwo, 20);
  cover(one, kLeft, 10);
  cover(two, kLeft, 10);
  team_.recovered(1, {holder(one, c_one_), holder(two, c_two_, kTwo)});
  EXPECT_EQ(violated(), "");
  cover(one, kLeft, 1);
  team_.recovered(2, {holder(one, c_one_), holder(two, c_two_, kTwo)});
  EXPECT_EQ(violated(), "every agent learns every row");
}

TEST_F(InvariantsTest, ViewsAgreeWithinTheirStaleness) {
  CoverageTable one(mission_.basis, 0.1);
  cover(one, kTwo, 50);
  const TableView right = holder(one, c_one_);
  team_.recovered(1, {right});
  EXPECT_EQ(violated(), "");
  CoverageTable other(mission_.basis, 0.1);
  cover(other, kTwo, 50, 7);  // as many steps, elsewhere
  team_.recovered(2, {right, holder(other, c_two_, kTwo)});
  EXPECT_EQ(violated(), "all agree on c_k within their staleness");
  EXPECT_GT(team_.largest_view_error(), 0);
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
