// SPDX-License-Identifier: BSD-3-Clause
// When the orders to pause and to resume count as carried out.
#include "cli/operate/pause_order.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast::cli {
namespace {

using namespace test;
using State = OrderReport::State;

class Paused : public ::testing::Test {
 protected:
  Paused() {
    mission_.timing.pace = Pace::kRealtime;
    announce(mission_);
    list(only_pauses({{20, -1}}));
    move_to(30);
  }

  /// The coordinator announces the list.
  void list(const Amendments& amendments, MissionState state = MissionState::kRunning) {
    MissionPart part = mission_part(++revision_, state, roster_of(2), "mission complete");
    part.amendments = encode_amendments(amendments);
    part.content_hash = hash_of(part);
    give(team_, part, now_);
  }
  void move_to(Tick tick) { give(team_, world_state(tick, {{1, 1, 0}}), now_); }
  OrderReport report(PauseOrder& order) {
    Outbox out;
    order.send(team_, now_, out);
    return order.report(team_, now_);
  }

  Mission mission_ = small_mission(2);
  Instant now_ = at(1s);
  MonitoredRun team_{kRun, at(0s)};
  std::int64_t revision_ = -1;
  Tick tick_ = 30;
};

TEST_F(Paused, NothingIsResumedWhereThereWasNoPause) {
  list({});
  PauseOrder order(false, now_);
  EXPECT_EQ(report(order).state, State::kDone);
  EXPECT_EQ(report(order).text, "the mission is not paused");
}

TEST_F(Paused, AResumptionIsDoneAtItsTick) {
  PauseOrder order(false, now_);
  EXPECT_EQ(report(order).state, State::kSent);
  list(only_pauses({{20, 50}}));
  EXPECT_EQ(report(order).state, State::kAnswered);
  EXPECT_EQ(report(order).text,
            "the coordinator resumes the mission at tick 20, t = 2.0 s, in 2.0 s of wall time");
  move_to(49);
  EXPECT_EQ(report(order).state, State::kAnswered);
  move_to(50);
  EXPECT_EQ(report(order).state, State::kDone);
  EXPECT_EQ(report(order).text, "the mission goes on at tick 20, t = 2.0 s");
}

TEST_F(Paused, AResumptionOfAMissionThatEndsSoonIsDone) {
  PauseOrder order(false, now_);
  report(order);
  list(only_pauses({{20, 50}}));
  report(order);
  move_to(130);
  list(only_pauses({{20, 50}}), MissionState::kEnded);
  EXPECT_EQ(report(order).state, State::kDone);
  EXPECT_EQ(report(order).text, "the mission goes on at tick 20, t = 2.0 s");
}

TEST_F(Paused, AResumptionBesideAnotherOneWaitsForItsTick) {
  list(only_pauses({{20, 50}}));
  PauseOrder order(false, now_);
  EXPECT_EQ(report(order).state, State::kAnswered);
  move_to(50);
  EXPECT_EQ(report(order).text, "the mission is not paused");
}

// It moves on in a pause, as fast as before.
TEST_F(Paused, AVehicleThatLeavesAZoneIsNotStuck) {
  BrakingWatch watch(10);
  Amendments paused = only_pauses({{20, -1}});
  name_zone(paused, 20, 25, 100,
            {.until = 200, .corners_m = {{100, 100}, {900, 100}, {900, 900}, {100, 900}}});
  list(paused);
  const auto is_stuck_at = [&](double x_m) {
    WorldState world = world_state(++tick_, {{x_m, 500, 0}});
    world.vehicles[0].velocity_mps = {5, 0, 0};
    give(team_, world, now_);
    return watch.is_stuck(team_.standing());
  };
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(is_stuck_at(899)) << i;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(is_stuck_at(1000)) << i;
  EXPECT_TRUE(is_stuck_at(1000));
}

TEST(Braking, IsStuckOnceNoVehicleHasSlowedDownForLong) {
  BrakingWatch watch(10);
  const auto is_stuck_at = [&watch](double speed_mps) {
    return watch.is_stuck({.moving = {"agent 0"}, .speed_mps = speed_mps});
  };
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(is_stuck_at(20 - 0.1 * i));
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(is_stuck_at(11 + i % 2)) << i;
  EXPECT_TRUE(is_stuck_at(11));
  EXPECT_FALSE(is_stuck_at(5)) << "one of them stands now";
}

}  // namespace
}  // namespace ergocast::cli
