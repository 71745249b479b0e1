// SPDX-License-Identifier: BSD-3-Clause
// Another end of the mission: from when agents rest by it, and which ends a coordinator refuses.
#include "core/mission/end_schedule.h"

#include <gtest/gtest.h>

#include "core/mission/station.h"
#include "core/motion/end_rules.h"
#include "plan/amendment_list.h"
#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

/// 1000 ticks of 0.1 s. Agent 0 has to be at its station 20 s before the end; agent 1 has none.
Mission with_a_station() {
  Mission mission = small_mission(2);
  mission.timing.tick_count = 1000;
  mission.timing.broadcast_period_ticks = 10;
  mission.kinds = {{"a", 1, 8, 0, 0}, {"b", 1, 8, 0, 0}};
  mission.kinds[0].stations_m = {{30, 20, 0}};
  mission.kinds[0].reserve_s = 20;
  return mission;
}

Amendments ends(std::initializer_list<std::pair<Tick, Tick>> all) {
  Amendments list;
  for (const auto& [from, tick_count] : all) name_end(list, from, tick_count);
  return list;
}

TEST(EndSchedule, WithoutAmendmentsIsThePlans) {
  const Mission mission = with_a_station();
  const EndSchedule schedule(mission, {});
  EXPECT_TRUE(schedule.is_plans());
  EXPECT_EQ(schedule.tick_count(), 1000);
  EXPECT_EQ(schedule.rest_from(mission, 0, 500), rest_from(mission, 0));
}

TEST(EndSchedule, AnEndHoldsFromItsTickOn) {
  const Mission mission = with_a_station();
  const EndSchedule schedule(mission, ends({{300, 700}, {400, 2000}}));
  EXPECT_EQ(schedule.tick_count_at(299), 1000);
  EXPECT_EQ(schedule.tick_count_at(300), 700);
  EXPECT_EQ(schedule.tick_count_at(400), 2000);
  EXPECT_EQ(schedule.tick_count(), 2000);
  EXPECT_EQ(schedule.rest_from(mission, 0, 299), 800);
  EXPECT_EQ(schedule.rest_from(mission, 0, 399), 500);
  EXPECT_EQ(schedule.rest_from(mission, 0, 400), 1800);
  EXPECT_FALSE(schedule.rests(mission, 1, 1999)) << "it has no station";
}

TEST(EndSchedule, WhoRestsGoesOnResting) {
  const Mission mission = with_a_station();
  const EndSchedule schedule(mission, ends({{800, 1500}, {900, 1200}}));
  EXPECT_EQ(schedule.rest_from(mission, 0, 1400), 800);
  EXPECT_TRUE(schedule.rests(mission, 0, 1100));
  const EndSchedule before(mission, ends({{799, 1500}}));
  EXPECT_EQ(before.rest_from(mission, 0, 1400), 1300);
  EXPECT_FALSE(before.rests(mission, 0, 1299));
}

TEST(EndSchedule, APauseDelaysAnEnd) {
  const Mission mission = with_a_station();
  Amendments list = ends({{300, 700}});
  list.holds = {{100, 150}};
  const EndSchedule schedule(mission, list);
  EXPECT_EQ(schedule.tick_count_at(249), 1000);
  EXPECT_EQ(schedule.tick_count_at(250), 700);
}

TEST(EndSchedule, BroadcastsGoByTheEndThatHolds) {
  const Mission mission = with_a_station();
  const EndSchedule schedule(mission, ends({{300, 700}}));
  EXPECT_EQ(next_broadcast(mission, schedule, 0, 495, 0), 499) << "the last before it rests";
  EXPECT_EQ(next_broadcast(mission, schedule, 0, 499, 0), 700);
  EXPECT_EQ(next_broadcast(mission, 0, 495), 500);
}

TEST(Ends, TravelWithTheList) {
  const Mission mission = with_a_station();
  const Amendments list = ends({{300, 700}, {400, 2000}});
  EXPECT_EQ(list.recent[1], (Amendment{1, AmendmentKind::kEnd, 400, 2000}));
  EXPECT_EQ(decode_amendments(encode_amendments(list), mission), list);
  EXPECT_EQ(decode_end(encode_end(77), mission), 77);
}

TEST(Ends, ImpossibleOnesAreRefused) {
  const Mission mission = with_a_station();
  const Amendments good = ends({{300, 700}, {400, 2000}});
  const auto passes = [&](auto change) {
    Amendments list = good;
    change(list);
    return decode_amendments(encode_amendments(list), mission).has_value();
  };
  EXPECT_TRUE(passes([](Amendments&) {}));
  EXPECT_FALSE(passes([](Amendments& list) { list.ends[1].tick_count = 0; }));
  EXPECT_FALSE(passes([](Amendments& list) { list.ends[1].tick_count = 1'000'000'000'000; }));
  EXPECT_FALSE(passes([](Amendments& list) { list.ends[1].from = 299; }));
  EXPECT_FALSE(passes([](Amendments& list) { list.ends[1].number = 0; }));
  EXPECT_FALSE(passes([](Amendments& list) { list.ends[1].number = 2; }));
  EXPECT_FALSE(passes([](Amendments& list) {
    list.named = 100;
    for (int i = 2; i < 33; ++i) list.ends.push_back({i, 400, 2000});
  }));
  for (const Tick tick_count : {Tick{-1}, Tick{0}, Tick{1'000'000'000'000}})
    EXPECT_EQ(decode_end(encode_end(tick_count), mission), std::nullopt);
  EXPECT_EQ(decode_end(encode_target({}), mission), std::nullopt);
}

class EndRulesOfATeam : public ::testing::Test {
 protected:
  EndProblem problem(Tick from, Tick tick_count, double x_m = 30) {
    return rules_.problem(mission_, list_, from - 2, from, tick_count,
                          std::vector<AgentPlace>{{0, Eigen::Vector3d(x_m, 20, 0)},
                                                  {1, Eigen::Vector3d(190, 90, 0)}});
  }

  Mission mission_ = with_a_station();
  Amendments list_;
  EndRules rules_;
};

TEST_F(EndRulesOfATeam, ALaterEndIsNamedInTime) {
  EXPECT_EQ(problem(900, 2000), EndProblem::kNone);
  EXPECT_EQ(problem(901, 2000), EndProblem::kTooLate);
  EXPECT_EQ(problem(1001, 2000), EndProblem::kPassed);
  EXPECT_EQ(problem(900, 1000), EndProblem::kSame);
  list_ = ends({{100, 500}});
  EXPECT_EQ(problem(401, 1000), EndProblem::kTooLate);
  EXPECT_EQ(problem(400, 1000), EndProblem::kNone);
  for (Tick tick_count = 501; list_.ends.size() < kMaxEnds; ++tick_count)
    name_end(list_, 200, tick_count);
  EXPECT_EQ(problem(300, 1000), EndProblem::kFull);
}

TEST_F(EndRulesOfATeam, AnEarlierEndLeavesTimeToGoHome) {
  EXPECT_EQ(problem(300, 300, 30), EndProblem::kPassed);
  // 160 m at 8 m/s are 200 ticks; slack and notice are 4 more.
  EXPECT_EQ(problem(300, 300 + 200 + 204, 190), EndProblem::kNone);
  EXPECT_EQ(problem(300, 300 + 200 + 203, 190), EndProblem::kTooFar);
  EXPECT_EQ(rules_.too_far(), 0);
  EXPECT_EQ(rules_.problem(mission_, list_, 298, 300, 990, std::vector<AgentPlace>{{0, {}}}),
            EndProblem::kTooFar)
      << "its place is not known";
  EXPECT_EQ(problem(850, 851, 190), EndProblem::kNone) << "it rests, wherever it is";
}

TEST_F(EndRulesOfATeam, AnEarlierEndLeavesTimeForTheWayRoundAZone) {
  Tick earliest = 300;
  while (earliest < 1000 && problem(100, earliest, 330) != EndProblem::kNone) ++earliest;
  ASSERT_LT(earliest, 1000);
  Zone zone;
  zone.until = 500;
  zone.corners_m = {{100, 5}, {250, 5}, {250, 300}, {100, 300}};
  list_.zones = {zone};
  EXPECT_EQ(problem(100, earliest, 330), EndProblem::kTooFar);
  list_.zones[0].until = 98;  // it has ended
  EXPECT_EQ(problem(100, earliest, 330), EndProblem::kNone);
}

}  // namespace
}  // namespace ergocast
