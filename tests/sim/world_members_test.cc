// SPDX-License-Identifier: BSD-3-Clause
// The simulated world, driven by hand: which commands count, and which agents join and leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"
#include "core/base/noise.h"
#include "core/motion/starts.h"
#include "tests/sim/driven_world.h"

namespace ergocast {
namespace {

using namespace test;

TEST(WorldRefuses, CommandsThatAreNotAnAnswerOfAMemberToThisTick) {
  World world = running_world(small_mission(1));
  advance(world, at(0s));
  Command stranger = command_of(0, 0, {1, 1, 0});
  stranger.header.incarnation = 99;
  Command foreign = command_of(0, 0, {1, 1, 0});
  foreign.header.run = kRun + 1;
  const Command lies[] = {command_of(3, 0, {1, 1, 0}), stranger, foreign,
                          command_of(0, 1, {1, 1, 0}), command_of(0, Tick{1} << 48, {1, 1, 0})};
  for (const Command& lie : lies) {
    give(world, lie, at(0s));
    EXPECT_TRUE(advance(world, at(0s)).empty());
  }
  EXPECT_EQ(world.tick(), 0);
  // The real answer still counts after all of these.
  give(world, command_of(0, 0, {2, 0, 0}), at(0s));
  EXPECT_EQ(applied(state_after(world, at(0s))), Eigen::Vector3d(2, 0, 0));
  // An old one does not count as an answer to the new tick.
  give(world, command_of(0, 0, {9, 9, 0}), at(0s));
  EXPECT_TRUE(advance(world, at(0s)).empty());
}

TEST(WorldRefuses, TheCommandsOfAnEvictedAgentWhichStandsStill) {
  const Mission mission = small_mission(2);
  World world = running_world(mission);
  advance(world, at(0s));
  give(world, command_of(0, 0, {1, 0, 0}), at(0s));
  give(world, command_of(1, 0, {1, 0, 0}), at(0s));
  advance(world, at(0s));
  std::vector<RosterEntry> roster = roster_of(2);
  roster[1].active_until = 1;
  give(world, mission_part(1, MissionState::kRunning, roster), at(0s));
  give(world, command_of(1, 1, {5, 5, 0}), at(0s));
  give(world, command_of(0, 1, {1, 0, 0}), at(0s));
  const WorldState state = state_after(world, at(0s));
  EXPECT_EQ(state.header.tick, 2) << "no process waits for it any more";
  EXPECT_EQ(applied(state, 1), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(place(state, 1), mission.starts_m[1] + Eigen::Vector3d(1, 0, 0) * 0.1);
}

TEST(WorldRefuses, TheAnswerThatAnAgentGaveBeforeItWasEvicted) {
  const Mission mission = small_mission(2);
  World world = running_world(mission);
  advance(world, at(0s));
  give(world, command_of(1, 0, {5, 5, 0}), at(0s));
  std::vector<RosterEntry> roster = roster_of(2);
  roster[1].active_until = 0;
  give(world, mission_part(1, MissionState::kRunning, roster), at(0s));
  give(world, command_of(0, 0, {1, 0, 0}), at(0s));
  const WorldState state = state_after(world, at(0s));
  EXPECT_EQ(applied(state, 0), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(applied(state, 1), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(place(state, 1), mission.starts_m[1]);
}

TEST(WorldRefuses, TheFormerIncarnationOfARestartedAgentWhichGoesOnFromItsPlace) {
  const Mission mission = small_mission(1);
  World world = running_world(mission);
  advance(world, at(0s));
  give(world, command_of(0, 0, {10, 0, 0}), at(0s));
  advance(world, at(0s));
  std::vector<RosterEntry> roster = roster_of(1);
  roster[0].active_until = 1;
  roster.push_back({{0, 2000}, 1, -1});
  give(world, mission_part(1, MissionState::kRunning, roster), at(0s));
  give(world, command_of(0, 1, {-9, 0, 0}), at(0s));
  EXPECT_TRUE(advance(world, at(0s)).empty());
  EXPECT_EQ(world.tick(), 1);
  Command restarted = command_of(0, 1, {0, 10, 0});
  restarted.header.incarnation = 2000;
  give(world, restarted, at(0s));
  const WorldState state = state_after(world, at(0s));
  EXPECT_EQ(state.header.tick, 2);
  EXPECT_EQ(place(state), Eigen::Vector3d(101, 501, 0));
}

TEST(WorldRefuses, ToRunOnWithNoAgentLeft) {
  World world = running_world(small_mission(2));
  advance(world, at(0s));
  std::vector<RosterEntry> roster = roster_of(2);
  roster[0].active_until = roster[1].active_until = 0;
  give(world, mission_part(1, MissionState::kRunning, roster), at(0s));
  EXPECT_TRUE(advance(world, at(1ms)).empty());
  EXPECT_EQ(state_after(world, at(20ms)).header.tick, 0);
}

TEST(WorldAdmits, AgentsBeyondThePlanAtStartsDrawnFromTheSeed) {
  const auto strangers = [](std::uint64_t seed) {
    Mission mission = small_mission(1);
    mission.seed = seed;
    World world = running_world(mission);
    give(world, mission_part(1, MissionState::kRunning, roster_of(3)), at(0s));
    nobody_has_moved(world, 3, at(0s));
    const WorldState state = state_after(world, at(0s));
    EXPECT_EQ(state.vehicle_count, 3);
    EXPECT_EQ(place(state, 0), mission.starts_m[0]) << "a planned agent begins as planned";
    for (const int stranger : {1, 2}) {
      EXPECT_EQ(place(state, stranger), random_start(mission.domain, seed, stranger));
      EXPECT_TRUE(mission.domain.contains(place(state, stranger)));
    }
    EXPECT_NE(place(state, 1), place(state, 2));
    return std::pair(place(state, 1), place(state, 2));
  };
  EXPECT_EQ(strangers(7), strangers(7));
  EXPECT_NE(strangers(7), strangers(8));
}

TEST(WorldAdmits, ALateAgentAtItsOwnStart) {
  const Mission mission = small_mission(2);
  World world = world_of(mission);
  give(world, mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  nobody_has_moved(world, 1, at(0s));
  EXPECT_EQ(state_after(world, at(0s)).vehicle_count, 1);
  give(world, mission_part(1, MissionState::kRunning, roster_of(2)), at(0s));
  give(world, command_of(0, 0, {0, 0, 0}), at(0s));
  EXPECT_TRUE(advance(world, at(1ms)).empty()) << "the tick is the newcomer's too";
  const WorldState again = state_after(world, at(20ms));
  EXPECT_EQ(again.header.tick, 0);
  EXPECT_EQ(again.roster_revision, 0) << "a tick has one roster";
  ASSERT_EQ(again.vehicle_count, 2) << "which has to see where it is";
  EXPECT_EQ(place(again, 1), mission.starts_m[1]);
  give(world, command_of(1, 0, {0, 0, 0}), at(20ms));
  const WorldState state = state_after(world, at(20ms));
  EXPECT_EQ(state.header.tick, 1);
  EXPECT_EQ(state.roster_revision, 1);
  ASSERT_EQ(state.vehicle_count, 2);
  EXPECT_EQ(place(state, 1), mission.starts_m[1]);
}

TEST(WorldAdmits, ALateAgentInTheMiddleOfATickWhichItThenWaitsFor) {
  World world = running_world(small_mission(2));
  EXPECT_EQ(state_after(world, at(0s)).vehicle_count, 2);
  give(world, mission_part(2, MissionState::kRunning, roster_of(3)), at(1ms));
  give(world, command_of(0, 0, {1, 1, 0}), at(2ms));
  give(world, command_of(1, 0, {1, 1, 0}), at(2ms));
  const WorldState again = state_after(world, at(20ms));
  EXPECT_EQ(again.header.tick, 0);
  ASSERT_EQ(again.vehicle_count, 3) << "else it would never learn that it is waited for";
  EXPECT_EQ(again.vehicles[1].answered_tick, 0);
  EXPECT_EQ(again.vehicles[2].answered_tick, -1);
  give(world, command_of(2, 0, {1, 1, 0}), at(21ms));
  EXPECT_EQ(state_after(world, at(21ms)).header.tick, 1);
}

}  // namespace
}  // namespace ergocast
