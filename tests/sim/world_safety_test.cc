// SPDX-License-Identifier: BSD-3-Clause
// The simulated world, driven by hand: its limits keep vehicles slow, finite and still.
#include <gtest/gtest.h>

#include <limits>

#include "tests/sim/driven_world.h"

namespace ergocast {
namespace {

using namespace test;

constexpr double kHuge = std::numeric_limits<double>::max();

Mission limited_mission(double speed_limit_mps) {
  Mission mission = small_mission(2);
  mission.speed_limit_mps = speed_limit_mps;
  return mission;
}

Stop stop_now(bool failed = false) {
  return {{kRun, kOperator, 1, 1, 0}, failed, "stopped at once by hand", true};
}

/// The state after both agents have answered `tick`.
WorldState answered(World& world, Tick tick, const Eigen::Vector3d& first,
                    const Eigen::Vector3d& second) {
  give(world, command_of(0, tick, first), at(0s));
  give(world, command_of(1, tick, second), at(0s));
  return state_after(world, at(0s));
}

// ---- speed limit ----

TEST(WorldSpeedLimit, CutsWhatIsFasterCountsItAndReportsWhatItApplied) {
  World world = running_world(limited_mission(5));
  advance(world, at(0s));
  WorldState state = answered(world, 0, {6, 8, 0}, {3, 4, 0});
  EXPECT_LT((applied(state, 0) - Eigen::Vector3d(3, 4, 0)).norm(), 1e-14);
  EXPECT_LT((place(state, 0) - Eigen::Vector3d(100.3, 500.4, 0)).norm(), 1e-12);
  EXPECT_EQ(applied(state, 1), Eigen::Vector3d(3, 4, 0)) << "bit for bit";
  EXPECT_EQ(state.clamped_commands, 1);
  state = answered(world, 1, {0, -50, 0}, {-500, 0, 0});
  EXPECT_EQ(state.clamped_commands, 3);
  EXPECT_EQ(world.clamped_commands(), 3);
}

TEST(WorldSpeedLimit, IsNoneUnlessTheScenarioSetsOne) {
  World world = running_world(limited_mission(0));
  advance(world, at(0s));
  const WorldState state = answered(world, 0, {6e5, 8e5, 0}, {3, 4, 0});
  EXPECT_EQ(applied(state, 0), Eigen::Vector3d(6e5, 8e5, 0));
  EXPECT_EQ(state.clamped_commands, 0);
}

TEST(WorldSpeedLimit, HoldsForAWorldThatRemembersByTheAgentsCommands) {
  const Mission mission = limited_mission(5);
  World first = running_world(mission), second = world_of(mission);
  advance(first, at(0s));
  answered(first, 0, {6, 8, 0}, {1, 0, 0});
  const WorldState before = answered(first, 1, {0, 7, 0}, {1, 0, 0});
  give(second, mission_part(0, MissionState::kRunning, roster_of(2)), at(0s));
  for (const AgentId id : {0, 1}) {
    for (const Tick tick : {1, 2}) {  // the last two of each, with where it was
      Command command =
          command_of(id, tick, tick == 1 ? Eigen::Vector3d(0, 7, 0) : Eigen::Vector3d(1, 0, 0));
      command.position_m = before.vehicles[static_cast<std::size_t>(id)].position_m;
      command.asked_by = kWorldLife;
      give(second, command, at(0s));
    }
  }
  EXPECT_EQ(applied(state_after(second, at(0s))), applied(before));
}

// ---- numbers ----

TEST(WorldNumbers, WhateverFiniteCommandComesThePlacesStayInTheDomain) {
  for (const double limit_mps : {0.0, 5.0}) {
    Mission mission = limited_mission(limit_mps);
    mission.disturbance_intensity = 1e3;
    mission.domain.origin_m = {-2e8, 1e8, 0};  // 100 000 sizes away
    for (Eigen::Vector3d& x_m : mission.starts_m) x_m += mission.domain.origin_m;
    World world = running_world(mission);
    advance(world, at(0s));
    Tick tick = 0;
    for (const double v : {kHuge, -kHuge, 1e300, 1e17, 5e-324}) {
      const WorldState state = answered(world, tick++, {v, -v, 0}, {-v, 0, 0});
      for (int i = 0; i < 2; ++i) EXPECT_TRUE(mission.domain.contains(place(state, i))) << v;
    }
  }
}

TEST(WorldNumbers, CountsTheCommandsThatCannotBeTrue) {
  Mission mission = small_mission(1);
  mission.timing.dt_s = 10;
  World world = running_world(mission);
  advance(world, at(0s));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector3d& v : {Eigen::Vector3d(kHuge, 0, 0), {nan, 0, 0}, {0, -2 * kHuge, 0}}) {
    give(world, command_of(0, 0, v), at(0s));
  }
  EXPECT_EQ(world.refused(), 3);
  give(world, command_of(0, 1, {1, 0, 0}), at(0s));
  EXPECT_EQ(world.refused(), 4) << "a tick that was not sent";
  EXPECT_TRUE(advance(world, at(0s)).empty()) << "unanswered";
  give(world, command_of(0, 0, {1, 0, 0}), at(0s));
  EXPECT_EQ(applied(state_after(world, at(0s))), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(world.refused(), 4);
}

TEST(WorldNumbers, OfAPlaceOutsideTheDomainAWorldThatBeginsTakesNothing) {
  World world = world_of(small_mission(1));
  give(world, mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double x_m : {-1.0, 2001.0, kHuge, nan}) {
    Command command = command_of(0, 7, {1, 0, 0});
    command.position_m = {x_m, 500, 0};
    command.asked_by = kWorldLife;
    give(world, command, at(0s));
  }
  EXPECT_EQ(world.refused(), 4);
}

// ---- emergency stop ----

TEST(WorldHalt, SetsAllVelocitiesToZeroAtOnceAndReportsIt) {
  for (const Pace pace : {Pace::kLockstep, Pace::kRealtime}) {
    Mission mission = small_mission(2);
    mission.timing.pace = pace;
    mission.disturbance_intensity = 10;
    World world = running_world(mission);
    const WorldState before = state_after(world, at(0s));
    give(world, command_of(0, 0, {9, 0, 0}), at(1ms));
    give(world, stop_now(), at(2ms));
    const WorldState halt = state_after(world, at(2ms));
    EXPECT_EQ(halt.header.tick, before.header.tick + 1);
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(applied(halt, i), Eigen::Vector3d(0, 0, 0));
      EXPECT_EQ(place(halt, i), place(before, i)) << "not even the disturbance moves it";
    }
    for (AgentId id : {0, 1}) give(world, command_of(id, 1, {9, 0, 0}), at(3ms));
    give(world, mission_part(1, MissionState::kEnded, roster_of(2), "later"), at(3ms));
    EXPECT_EQ(place(state_after(world, at(1s))), place(before))
        << "sent again, and no vehicle moves";
    EXPECT_FALSE(world.finished());
    advance(world, at(2100ms));
    EXPECT_TRUE(world.finished());
    EXPECT_EQ(world.reason(), "stopped at once by hand");
  }
}

TEST(WorldHalt, SendsFirstWhereTheLastStepLed) {
  Mission mission = small_mission(1);
  mission.wait_for_logger = true;
  World world = running_world(mission);
  give(world, ack_of(-1), at(0s));
  Tick tick = 0;
  // Until the world is as far ahead of the record as it may be: the next state is not sent.
  for (advance(world, at(0s)); tick < kRecordWindowTicks; ++tick) {
    give(world, command_of(0, tick, {1, 0, 0}), at(0s));
    if (advance(world, at(0s)).empty()) break;
  }
  give(world, stop_now(), at(1ms));
  const auto states = states_after(world, at(1ms));
  ASSERT_EQ(states.size(), 2u);
  EXPECT_EQ(applied(states[0]), Eigen::Vector3d(1, 0, 0)) << "it had moved so far";
  EXPECT_EQ(states[1].header.tick, states[0].header.tick + 1);
  EXPECT_EQ(applied(states[1]), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(place(states[1]), place(states[0]));
}

TEST(WorldHalt, EndsAsSoonAsTheRecordIsComplete) {
  Mission mission = small_mission(1);
  mission.wait_for_logger = true;
  World world = running_world(mission);
  give(world, ack_of(-1), at(0s));
  advance(world, at(0s));
  give(world, stop_now(), at(1ms));
  EXPECT_EQ(state_after(world, at(1ms)).header.tick, 1);
  EXPECT_FALSE(world.finished());
  give(world, ack_of(0), at(50ms));
  EXPECT_TRUE(world.finished());
}

TEST(WorldHalt, BeforeItHasBegunItJustEnds) {
  World world = world_of(small_mission(1));
  give(world, stop_now(), at(0s));
  EXPECT_TRUE(world.finished());
  EXPECT_TRUE(advance(world, at(0s)).empty());
}

TEST(WorldHalt, AStopInOrderIsTheCoordinatorsToObey) {
  World world = running_world(small_mission(1));
  advance(world, at(0s));
  Stop in_order = stop_now();
  in_order.now = false;
  give(world, in_order, at(0s));
  give(world, command_of(0, 0, {1, 0, 0}), at(0s));
  EXPECT_EQ(applied(state_after(world, at(0s))), Eigen::Vector3d(1, 0, 0)) << "it goes on";
}

TEST(WorldHalt, AnAgentMayStillCommandItsVehicleToStand) {
  World world = running_world(small_mission(2));
  advance(world, at(0s));
  give(world, command_of(0, 0, {9, 0, 0}), at(0s));
  give(world, command_of(0, 0, {0, 0, 0}), at(0s));
  give(world, command_of(1, 0, {1, 0, 0}), at(0s));
  EXPECT_EQ(applied(state_after(world, at(0s))), Eigen::Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace ergocast
