// SPDX-License-Identifier: BSD-3-Clause
// Bodies that keep a distance, in the world: where they appear, what a restarted world knows, and
// how commands are filtered in real time.
#include <gtest/gtest.h>

#include "core/motion/starts.h"
#include "tests/sim/driven_world.h"

namespace ergocast {
namespace {

using namespace test;

/// Agents are 100 m apart on a line and keep 30 m.
Mission apart(int agents, Pace pace) {
  Mission mission = small_mission(agents);
  mission.timing.pace = pace;
  mission.speed_limit_mps = 40;
  mission.separation.distance_m = 30;
  mission.separation.guard = true;
  return mission;
}

double nearest_m(const WorldState& state) {
  std::vector<Eigen::Vector3d> places_m;
  for (int i = 0; i < state.vehicle_count; ++i) places_m.push_back(place(state, i));
  return least_distance_m(places_m);
}

TEST(WorldKeepsBodiesApart, WhateverTheirAgentsCommand) {
  World world = running_world(apart(3, Pace::kRealtime));
  state_after(world, at(1ms));
  // One command towards each other, which is held for 0.5 s; no other one follows.
  give(world, command_of(0, 0, {40, 0, 0}), at(2ms));
  give(world, command_of(1, 0, {0, 0, 0}), at(2ms));
  give(world, command_of(2, 0, {-40, 1, 0}), at(2ms));
  for (int tick = 1; tick <= 20; ++tick) {
    const WorldState state = state_after(world, at(1ms + tick * 100ms));
    EXPECT_GE(nearest_m(state), 30) << tick;
    EXPECT_EQ(place(state, 1), Eigen::Vector3d(200, 500, 0)) << "a standing body is not pushed";
  }
}

TEST(WorldKeepsBodiesApart, OnlyIfTheMissionRequiresIt) {
  for (const bool guard : {true, false}) {
    Mission mission = apart(2, Pace::kRealtime);
    mission.timing.command_hold_s = 0;
    mission.starts_m[1].x() = 131;
    mission.separation.guard = guard;
    World world = running_world(mission);
    state_after(world, at(1ms));
    give(world, command_of(0, 0, {40, 0, 0}), at(2ms));
    const double x_m = place(state_after(world, at(101ms))).x();
    EXPECT_NEAR(x_m, guard ? 100.5 : 104, 1e-3) << "half the gap, or all that was commanded";
  }
}

TEST(WorldKeepsBodiesApart, ANewcomerAppearsWhereThereIsRoom) {
  Mission mission = apart(2, Pace::kLockstep);
  World world = world_of(mission);
  give(world, mission_part(0, MissionState::kRunning, {{author_of(0), 0, -1}}), at(0s));
  nobody_has_moved(world, 1, at(0s));
  EXPECT_EQ(state_after(world, at(1ms)).vehicle_count, 1);
  // Agent 0 goes to the start of the other one, (200, 500).
  for (Tick tick = 0; tick < 30; ++tick) {
    give(world, command_of(0, tick, {33, 0, 0}), at(2ms));
    advance(world, at(2ms));
  }
  give(world, mission_part(1, MissionState::kRunning, roster_of(2)), at(3ms));
  const WorldState state = state_after(world, at(1s));
  ASSERT_EQ(state.vehicle_count, 2);
  EXPECT_GE(nearest_m(state), join_distance_m(mission, 1, 0));
  EXPECT_NE(place(state, 1), mission.starts_m[1]);
}

// ---- a world that begins anew ----

/// A former world's state of vehicles 0 to 2 at `tick`.
WorldState state_before(Tick tick, double shift_m) {
  WorldState state = world_state(
      tick, {{300 + shift_m, 400, 0}, {340 + shift_m, 400, 0}, {400 + shift_m, 400, 0}});
  state.header.incarnation = kWorldLife - 1;
  return state;
}

Command answer(AgentId id, Tick tick, double x_m) {
  Command command = command_of(id, tick, {40, 0, 0});
  command.position_m = {x_m, 400, 0};
  command.asked_by = kWorldLife;
  return command;
}

/// A world of agents 0 and 1; 2 has left the roster at tick 5.
World asking(const Mission& mission) {
  World world = world_of(mission);
  std::vector<RosterEntry> roster = roster_of(3);
  roster[2].active_until = 5;
  give(world, mission_part(0, MissionState::kRunning, roster), at(0s));
  advance(world, at(0s));
  return world;
}

TEST(RestartedWorld, KnowsTheBodiesOfAgentsThatHaveLeft) {
  World world = asking(apart(3, Pace::kLockstep));
  for (const Tick tick : {8, 9}) {
    give(world, answer(0, tick, 300), at(1ms));
    give(world, answer(1, tick, 340), at(1ms));
  }
  EXPECT_TRUE(states_after(world, at(2ms)).empty()) << "no answer has the place of agent 2";
  EXPECT_EQ(only<Hello>(advance(world, at(150ms))).size(), 1u) << "it asks again";
  give(world, state_before(9, 0), at(151ms), 0);
  const WorldState state = state_after(world, at(152ms));
  ASSERT_EQ(state.vehicle_count, 3);
  EXPECT_EQ(place(state, 2), Eigen::Vector3d(400, 400, 0));
}

/// The former world had taken its step with the answers to tick 9. Agent 1 has crashed since.
TEST(RestartedWorld, GoesOnFromTheNewestStateThatAnyAgentKnows) {
  World world = asking(apart(3, Pace::kLockstep));
  for (const Tick tick : {8, 9}) give(world, answer(0, tick, 300), at(1ms));
  nobody_has_moved(world, 2, at(1ms));
  give(world, state_before(9, 0), at(1ms), 0);
  give(world, state_before(10, 4), at(1ms), 0);
  const WorldState state = state_after(world, at(2ms));
  EXPECT_EQ(state.header.tick, 10);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(place(state, i),
              state_before(10, 4).vehicles[static_cast<std::size_t>(i)].position_m);
}

/// Answers of two ticks are of two times, at which distances differed.
TEST(RestartedWorld, InRealTimePutsAllWhereOneStateHasThemAndLetsThemStand) {
  World world = asking(apart(3, Pace::kRealtime));
  give(world, state_before(7, 0), at(1ms), 0);
  give(world, state_before(8, 4), at(1ms), 1);
  for (const Tick tick : {7, 8}) give(world, answer(1, tick, 344), at(1ms));
  for (const Tick tick : {3, 4}) give(world, answer(0, tick, 330), at(1ms));
  const WorldState state = state_after(world, at(2ms));
  EXPECT_EQ(state.header.tick, 8);
  ASSERT_EQ(state.vehicle_count, 3);
  EXPECT_EQ(place(state, 0), Eigen::Vector3d(304, 400, 0));
  EXPECT_EQ(place(state, 1), Eigen::Vector3d(344, 400, 0));
  EXPECT_EQ(place(state, 2), Eigen::Vector3d(404, 400, 0));
  // The commands that it holds were for other places.
  const auto later = states_after(world, at(302ms));
  ASSERT_FALSE(later.empty());
  EXPECT_GT(later.back().header.tick, state.header.tick);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(place(later.back(), i), place(state, i)) << i;
}

TEST(RestartedWorld, BelievesNoStateOnceItHasBegun) {
  World world = asking(apart(3, Pace::kRealtime));
  nobody_has_moved(world, 2, at(1ms));
  EXPECT_EQ(state_after(world, at(2ms)).vehicle_count, 2);
  give(world, state_before(0, 0), at(3ms), 0);
  const WorldState state = state_after(world, at(103ms));
  EXPECT_EQ(state.vehicle_count, 2);
  EXPECT_EQ(place(state, 0), Eigen::Vector3d(100, 500, 0));
}

/// A wing does not move exactly as commanded, so commands do not determine its way near a wall.
TEST(RestartedWorld, TakesPlacesAndVelocitiesAmongWallsFromAState) {
  Mission mission = small_mission(3);
  mission.timing.pace = Pace::kRealtime;
  mission.speed_limit_mps = 10;
  mission.walls = {{{1000, 1000}, {1100, 1000}, {1100, 1100}, {1000, 1100}}};
  mission.wall_clearance_m = 10;
  World world = asking(mission);
  WorldState before = state_before(8, 0);
  before.vehicles[1].velocity_mps = {3, 4, 0};
  for (const AgentId id : {0, 1}) {
    for (const Tick tick : {7, 8}) give(world, answer(id, tick, 300), at(1ms));
  }
  EXPECT_TRUE(states_after(world, at(2ms)).empty()) << "no answer has all places";
  give(world, before, at(3ms), 0);
  const WorldState state = state_after(world, at(4ms));
  EXPECT_EQ(state.header.tick, 8);
  EXPECT_EQ(place(state, 1), before.vehicles[1].position_m);
  EXPECT_EQ(applied(state, 1), Eigen::Vector3d(3, 4, 0));
}

}  // namespace
}  // namespace ergocast
