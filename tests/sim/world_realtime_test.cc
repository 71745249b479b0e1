// SPDX-License-Identifier: BSD-3-Clause
// The simulated world in real time, driven by hand: ticks follow the clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"
#include "core/base/noise.h"
#include "tests/sim/driven_world.h"

namespace ergocast {
namespace {

using namespace test;

Mission realtime_mission(double factor = 1) {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.realtime_factor = factor;
  return mission;
}

TEST(WorldInRealTime, GoesByTheClockTimesAFactor) {
  for (const double factor : {1.0, 0.5, 10.0}) {
    World world = running_world(realtime_mission(factor), at(7s));
    EXPECT_EQ(state_after(world, at(7s)).header.tick, 0);
    const auto period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e8 / factor));
    for (int tick = 1; tick <= 5; ++tick) {
      EXPECT_EQ(world.next_wakeup(), at(7s + tick * period));
      EXPECT_TRUE(advance(world, at(7s + tick * period - 1ns)).empty());
      EXPECT_EQ(state_after(world, at(7s + tick * period)).header.tick, tick);
    }
  }
}

TEST(WorldInRealTime, MovesNothingBeforeItMayBegin) {
  World world = world_of(realtime_mission());
  world.begin_not_before(at(700ms));
  give(world, mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  EXPECT_EQ(world.newest_answer(), std::nullopt);
  nobody_has_moved(world, 1, at(0s));
  EXPECT_EQ(world.newest_answer(), std::optional<Tick>(-1));
  for (const auto time : {0ms, 300ms, 699ms}) {
    EXPECT_TRUE(states_after(world, at(time)).empty());
    EXPECT_FALSE(world.begun_at().has_value());
    EXPECT_LE(world.next_wakeup(), at(time + 100ms));
  }
  EXPECT_EQ(state_after(world, at(700ms)).header.tick, 0);
}

TEST(WorldInRealTime, CountsAndShowsEveryMissedDeadline) {
  World world = running_world(realtime_mission());
  advance(world, at(0s));
  give(world, command_of(0, 0, {1, 0, 0}), at(99ms));
  EXPECT_EQ(state_after(world, at(100ms)).missed_deadlines, 0);
  EXPECT_EQ(state_after(world, at(200ms)).missed_deadlines, 1);
  give(world, command_of(0, 1, {1, 0, 0}), at(201ms));
  EXPECT_EQ(state_after(world, at(300ms)).missed_deadlines, 2) << "an answer to 1 is none to 2";
  give(world, command_of(0, 3, {1, 0, 0}), at(301ms));
  EXPECT_EQ(state_after(world, at(400ms)).missed_deadlines, 2);
  EXPECT_EQ(world.missed_deadlines(), 2);
}

TEST(WorldInRealTime, HoldsAnOldCommandForALimitAndThenStops) {
  Mission mission = realtime_mission();
  mission.timing.command_hold_s = 0.35;
  World world = running_world(mission);
  advance(world, at(0s));
  give(world, command_of(0, 0, {10, 0, 0}), at(0s));
  for (int tick = 1; tick <= 8; ++tick) {
    const WorldState state = state_after(world, at(tick * 100ms));
    // The step from tick n uses a command that is n·0.1 s old: 0, 0.1, 0.2, 0.3, and no more.
    EXPECT_EQ(applied(state), tick <= 4 ? Eigen::Vector3d(10, 0, 0) : Eigen::Vector3d(0, 0, 0))
        << tick;
    EXPECT_NEAR(place(state).x(), 100 + std::min(tick, 4), 1e-9);
  }
}

TEST(WorldInRealTime, CatchesUpABoundedNumberOfTicksAndCountsTheRest) {
  World world = running_world(realtime_mission());
  advance(world, at(0s));
  advance(world, at(100ms));
  // 18 ticks late: 5 are caught up, 1 is due anyway, 13 are skipped.
  const auto states = states_after(world, at(2s));
  ASSERT_EQ(states.size(), 6u);
  EXPECT_EQ(states.back().header.tick, 7);
  EXPECT_EQ(states.back().skipped_ticks, 13);
  EXPECT_EQ(world.skipped_ticks(), 13);
  EXPECT_EQ(world.missed_deadlines(), 7) << "none of its steps had an answer";
  EXPECT_EQ(world.next_wakeup(), at(2100ms)) << "back on the beat";
}

TEST(WorldInRealTime, MakesUpForSmallDelaysWithoutLosingATick) {
  World world = running_world(realtime_mission());
  advance(world, at(0s));
  EXPECT_EQ(states_after(world, at(350ms)).size(), 3u);
  EXPECT_EQ(states_after(world, at(400ms)).size(), 1u);
  EXPECT_EQ(world.skipped_ticks(), 0);
}

TEST(WorldInRealTime, WaitsForTheLoggersFirstMessageWithoutSpinning) {
  Mission mission = realtime_mission();
  mission.wait_for_logger = true;
  World world = running_world(mission);
  EXPECT_TRUE(advance(world, at(1s)).empty());
  EXPECT_GT(world.next_wakeup(), at(1s));
  give(world, ack_of(-1), at(2s));
  EXPECT_EQ(state_after(world, at(2s)).header.tick, 0);
  EXPECT_EQ(state_after(world, at(2100ms)).header.tick, 1);
  EXPECT_EQ(world.skipped_ticks(), 0) << "the wait is no delay";
}

TEST(WorldInRealTime, EndsAfterItsLastTick) {
  Mission mission = realtime_mission();
  mission.timing.tick_count = 2;
  World world = running_world(mission);
  advance(world, at(0s));
  advance(world, at(100ms));
  EXPECT_EQ(state_after(world, at(200ms)).header.tick, 2);
  EXPECT_EQ(state_after(world, at(500ms)).header.tick, 2) << "repeated, it goes no further";
  advance(world, at(2201ms));
  EXPECT_TRUE(world.finished());
}

}  // namespace
}  // namespace ergocast
