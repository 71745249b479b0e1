// SPDX-License-Identifier: BSD-3-Clause
// The invariants of what agents hold, compute and learn: states that violate each, and the same
// states without the violation.
#include "core/law/forecast.h"
#include "tests/lab/invariants_fixture.h"

namespace ergocast::test {
namespace {

class InvariantsKnown : public InvariantsTest {
 protected:
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
};

TEST_F(InvariantsKnown, WhatIsHeldNeverShrinks) {
  CoverageTable much(mission_.basis, 0.1), less(mission_.basis, 0.1);
  cover(much, kTwo, 20);
  cover(less, kTwo, 19);
  team_.answered(1, holder(much, c_one_));
  EXPECT_EQ(violated(), "");
  team_.answered(2, holder(less, c_one_));
  EXPECT_EQ(violated(), "what is held never shrinks");
}

TEST_F(InvariantsKnown, NoStepCountsTwice) {
  CoverageTable table(mission_.basis, 0.1);
  cover(table, kTwo, 60);
  cover(table, kLeft, 41);  // 100 ticks, and one sampled by both
  team_.answered(1, holder(table, c_one_));
  EXPECT_EQ(violated(), "");
  cover(table, kLeft, 1);
  team_.answered(2, holder(table, c_one_));
  EXPECT_EQ(violated(), "no step counts twice");
}

TEST_F(InvariantsKnown, ATickCountsUnlessTheMissionIsPausedAsFarAsTheAgentKnows) {
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

TEST_F(InvariantsKnown, TheAverageIsWeightedByTime) {
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

TEST_F(InvariantsKnown, WhatIsForeseenFollowsFromWhatIsKnown) {
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

TEST_F(InvariantsKnown, WhatIsForeseenIsTheSameWhenAnAdmissionIsLostWithItsCoordinator) {
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

TEST_F(InvariantsKnown, ANewcomerCoversNothingBeforeItsFirstTickEvenIfItsAdmissionIsLost) {
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

TEST_F(InvariantsKnown, EveryAgentLearnsEveryRow) {
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

TEST_F(InvariantsKnown, ViewsAgreeWithinTheirStaleness) {
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

}  // namespace
}  // namespace ergocast::test
