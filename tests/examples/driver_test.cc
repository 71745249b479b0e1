// SPDX-License-Identifier: BSD-3-Clause
// The example driver gets single messages and ticks from the test.
#include "examples/driver/driver.h"

#include <gtest/gtest.h>

#include "core/motion/vehicle.h"
#include "tests/support/team.h"

namespace ergocast::example {
namespace {

using namespace test;

constexpr double kSpeedLimit_mps = 5;

Mission mission_of(Pace pace, double command_hold_s = 0.5) {
  Mission mission = small_mission(2);
  mission.timing.pace = pace;
  mission.timing.command_hold_s = command_hold_s;
  return mission;
}

/// A driver that learned at 0 s that the mission of two agents runs.
Driver running_driver(const Mission& mission, double speed_limit_mps = kSpeedLimit_mps) {
  announce(mission);
  Driver driver(kRun, kWorldLife, speed_limit_mps);
  give(driver, mission_part(1, MissionState::kRunning, roster_of(2)), at(0s));
  return driver;
}

WorldState state_at(Driver& driver, Instant now) {
  const auto states = only<WorldState>(advance(driver, now));
  EXPECT_EQ(states.size(), 1u);
  return states.empty() ? WorldState{} : states.front();
}

TEST(ExampleDriver, SendsThePlacesOfItsRobotsEachTick) {
  Driver driver = running_driver(mission_of(Pace::kRealtime));
  const WorldState first = state_at(driver, at(0s));
  EXPECT_EQ(first.header.tick, 0);
  EXPECT_EQ(first.vehicle_count, 2);
  EXPECT_EQ(first.vehicles[1].position_m, Eigen::Vector3d(200, 500, 0));
  EXPECT_EQ(first.vehicles[1].answered_tick, -1);
  EXPECT_EQ(driver.next_wakeup(), at(100ms));
  EXPECT_TRUE(advance(driver, at(99ms)).empty());
  give(driver, command_of(1, 0, {4, 0, 0}), at(99ms));
  const WorldState second = state_at(driver, at(100ms));
  EXPECT_EQ(second.header.tick, 1);
  EXPECT_EQ(second.vehicles[1].answered_tick, 0);
  EXPECT_NEAR(second.vehicles[1].position_m.x(), 200.4, 1e-9);
  EXPECT_EQ(second.vehicles[1].velocity_mps, Eigen::Vector3d(4, 0, 0));
  EXPECT_EQ(second.vehicles[0].position_m, first.vehicles[0].position_m) << "no driver moved it";
  EXPECT_EQ(second.missed_deadlines, 1);
}

TEST(ExampleDriver, ObeysOnlyTheAgentOfTheRobotAndNothingOld) {
  Driver driver = running_driver(mission_of(Pace::kRealtime));
  advance(driver, at(0s));
  advance(driver, at(100ms));
  Command stranger = command_of(0, 1, {5, 0, 0});
  stranger.header.incarnation = 99;
  give(driver, stranger, at(101ms));
  give(driver, command_of(0, 2, {5, 0, 0}), at(102ms));  // of a future tick
  EXPECT_EQ(state_at(driver, at(200ms)).vehicles[0].position_m.x(), 100);
  give(driver, command_of(0, 2, {5, 0, 0}), at(201ms));
  give(driver, command_of(0, 1, {0, 0, 0}), at(202ms));  // out of order
  EXPECT_NEAR(state_at(driver, at(300ms)).vehicles[0].position_m.x(), 100.5, 1e-9);
}

TEST(ExampleDriver, StopsARobotWhoseCommandsDoNotComeAnyMore) {
  Driver driver = running_driver(mission_of(Pace::kRealtime, 0.25));
  advance(driver, at(0s));
  give(driver, command_of(0, 0, {5, 0, 0}), at(0s));
  for (int tick = 1; tick <= 6; ++tick) {
    const WorldState state = state_at(driver, at(tick * 100ms));
    EXPECT_EQ(state.vehicles[0].velocity_mps.x(), tick <= 3 ? 5 : 0) << tick;
  }
}

TEST(ExampleDriver, ARobotThatOvershootsIsReportedAtTheEdge) {
  Driver driver = running_driver(mission_of(Pace::kRealtime), 50);
  WorldState state = state_at(driver, at(0s));
  for (int tick = 1; tick <= 60; ++tick) {
    give(driver, command_of(0, tick - 1, {-1e6, 0, 0}), at(tick * 1s));
    state = state_at(driver, at(tick * 1s));
    EXPECT_GE(state.vehicles[0].position_m.x(), 0);
  }
  EXPECT_LT(driver.robot(0).position_m().x(), -10);
  EXPECT_EQ(state.vehicles[0].position_m.x(), 0);
}

Mission apart() {
  Mission mission = mission_of(Pace::kRealtime);
  mission.timing.tick_count = 400;
  mission.speed_limit_mps = kSpeedLimit_mps;
  mission.separation.distance_m = 30;
  mission.separation.guard = true;
  return mission;
}

/// Uses the true positions of all robots, for any command and any time for which it is held.
TEST(ExampleDriver, HoldsRobotsApart) {
  Driver driver = running_driver(apart());
  advance(driver, at(0s));
  for (int tick = 1; tick <= 200; ++tick) {
    give(driver, command_of(0, tick - 1, {5, 0, 0}), at(tick * 100ms));
    const WorldState state = state_at(driver, at(tick * 100ms));
    const double apart_m = (state.vehicles[0].position_m - state.vehicles[1].position_m).norm();
    ASSERT_GE(apart_m, 30) << tick;
  }
  EXPECT_GT(driver.robot(0).position_m().x(), 169) << "it comes near, and looks for a way around";
}

TEST(ExampleDriver, WhereADistanceIsKeptReportsWhereARobotThatOvershootsIs) {
  Driver driver = running_driver(apart());
  WorldState state = state_at(driver, at(0s));
  for (int tick = 1; tick <= 300; ++tick) {
    give(driver, command_of(0, tick - 1, {-5, -1, 0}), at(tick * 100ms));
    state = state_at(driver, at(tick * 100ms));
  }
  EXPECT_EQ(state.vehicles[0].position_m, driver.robot(0).position_m());
  EXPECT_GE(state.vehicles[0].position_m.x(), -1) << "the filter holds it at the edge";
}

TEST(ExampleDriver, GoesOnAtTheTickThatTheCoordinatorNames) {
  announce(mission_of(Pace::kRealtime));
  Driver driver(kRun, kWorldLife, kSpeedLimit_mps);
  MissionPart part = mission_part(7, MissionState::kRunning, roster_of(2));
  part.header.tick = 41;
  give(driver, part, at(3s));
  EXPECT_EQ(state_at(driver, at(3s)).header.tick, 41);
  EXPECT_EQ(state_at(driver, at(3100ms)).header.tick, 42);
}

TEST(ExampleDriver, EndsWithTheMissionAndStopsItsRobots) {
  Driver driver = running_driver(mission_of(Pace::kRealtime));
  advance(driver, at(0s));
  give(driver, command_of(0, 0, {5, 0, 0}), at(0s));
  give(driver, mission_part(2, MissionState::kEnded, roster_of(2), "mission complete"), at(1s));
  EXPECT_TRUE(driver.finished());
  EXPECT_FALSE(driver.failed());
  EXPECT_EQ(driver.reason(), "mission complete");
}

TEST(ExampleDriver, AStopAtOnceStopsItsRobotsAndItReportsTheirPlaces) {
  Driver driver = running_driver(mission_of(Pace::kRealtime));
  advance(driver, at(0s));
  give(driver, command_of(0, 0, {5, 0, 0}), at(0s));
  Stop stop{{kRun, kOperator, 1, 1, 0}, false, "enough"};
  give(driver, stop, at(1ms));
  EXPECT_FALSE(driver.finished()) << "in order, the coordinator ends the mission";
  stop.now = true;
  give(driver, stop, at(2ms));
  EXPECT_FALSE(driver.finished()) << "some states may be lost";
  EXPECT_EQ(driver.reason(), "enough");
  const WorldState last = state_at(driver, at(2ms));
  EXPECT_EQ(last.header.tick, 1);
  EXPECT_EQ(last.vehicles[0].velocity_mps, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(last.vehicles[0].position_m, Eigen::Vector3d(100, 500, 0));
  for (int i = 1; i < 5; ++i) state_at(driver, at(i * 1s));
  EXPECT_TRUE(driver.finished());
  EXPECT_TRUE(advance(driver, at(9s)).empty());
}

TEST(ExampleDriver, AnAgentMayTakeItsAnswerBackToStandStill) {
  Driver driver = running_driver(mission_of(Pace::kRealtime));
  advance(driver, at(0s));
  give(driver, command_of(0, 0, {5, 0, 0}), at(1ms));
  give(driver, command_of(0, 0, {4, 0, 0}), at(2ms));
  give(driver, command_of(0, 0, {0, 0, 0}), at(3ms));
  EXPECT_EQ(state_at(driver, at(100ms)).vehicles[0].velocity_mps, Eigen::Vector3d(0, 0, 0));
}

TEST(ExampleDriver, ObeysTheScenariosSpeedLimitToo) {
  Mission mission = mission_of(Pace::kRealtime);
  mission.speed_limit_mps = 2;
  Driver driver = running_driver(mission);
  advance(driver, at(0s));
  give(driver, command_of(0, 0, {4, 0, 0}), at(1ms));
  const WorldState state = state_at(driver, at(100ms));
  EXPECT_EQ(state.vehicles[0].velocity_mps, Eigen::Vector3d(2, 0, 0));
  EXPECT_EQ(state.clamped_commands, 1);
}

TEST(ExampleDriver, RefusesAMissionInLockstep) {
  Driver driver = running_driver(mission_of(Pace::kLockstep));
  EXPECT_TRUE(driver.failed());
  EXPECT_NE(driver.reason().find("REALTIME"), std::string::npos);
}

Mission mission_of(const VehicleLimits& vehicle) {
  Mission mission = mission_of(Pace::kRealtime);
  mission.speed_limit_mps = 20;
  mission.vehicle = vehicle;
  return mission;
}

TEST(ExampleDriver, MovesUnicyclesAsTheirAgentsExpectIt) {
  const Mission mission = mission_of(VehicleLimits{VehicleKind::kUnicycle, 0, 2});
  const Motion motion = motion_of(mission, 1);
  Driver driver = running_driver(mission, 20);
  state_at(driver, at(0s));
  Eigen::Vector3d x_m = driver.robot(1).position_m(), v_mps(0, 0, 0);
  for (int tick = 0; tick < 12; ++tick) {
    const Eigen::Vector3d wanted_mps(-3, 4, 0);
    give(driver, command_of(1, tick, wanted_mps), at(100ms * tick + 50ms));
    const WorldState state = state_at(driver, at(100ms * (tick + 1)));
    const Eigen::Vector3d next_mps = executed(motion, v_mps, wanted_mps);
    x_m += mean_velocity(motion, v_mps, next_mps) * 0.1;
    v_mps = next_mps;
    EXPECT_EQ(state.vehicles[1].velocity_mps, v_mps);
    EXPECT_EQ(state.vehicles[1].position_m, x_m);
  }
  EXPECT_EQ(v_mps, Eigen::Vector3d(-3, 4, 0)) << "it has turned round";
}

TEST(ExampleDriver, RefusesVehiclesThatItsRobotsAreNot) {
  for (const VehicleLimits& vehicle :
       {VehicleLimits{VehicleKind::kUnicycle, 0, 2.1}, VehicleLimits{VehicleKind::kAcceleration, 9},
        VehicleLimits{VehicleKind::kFixedWing, 0, 1, 3}}) {
    const Driver driver = running_driver(mission_of(vehicle));
    EXPECT_TRUE(driver.failed());
    EXPECT_NE(driver.reason().find("POINT"), std::string::npos);
  }
}

// ---- a driver of one robot ----

Mission leased() {
  Mission mission = apart();
  mission.timing.command_hold_s = 0.5;
  mission.separation.guard = false;
  mission.separation.lease_s = 3;
  return mission;
}

Driver driver_of(AgentId id, const Mission& mission, Incarnation life = kWorldLife) {
  announce(mission);
  Driver driver(kRun, life, kSpeedLimit_mps, id);
  give(driver, mission_part(1, MissionState::kRunning, roster_of(2)), at(0s));
  return driver;
}

WorldState sent_by(Incarnation life, AgentId id, Tick tick) {
  WorldState state = world_state(tick, {{100, 500, 0}});
  state.header.incarnation = life;
  state.vehicles[0].id = id;
  return state;
}

TEST(DriverOfOneRobot, SendsItsPartOfTheState) {
  Driver driver = driver_of(1, leased());
  EXPECT_TRUE(advance(driver, at(999ms)).empty()) << "it listens first";
  const WorldState state = state_at(driver, at(1s));
  EXPECT_EQ(state.vehicle_count, 1);
  EXPECT_EQ(state.vehicles[0].id, 1);
  EXPECT_EQ(state.part, 1);
  EXPECT_EQ(state.parts, 2);
  give(driver, command_of(0, 0, {4, 0, 0}), at(1001ms));
  EXPECT_EQ(state_at(driver, at(1100ms)).vehicles[0].velocity_mps.x(), 0) << "another's command";
  give(driver, command_of(1, 1, {4, 0, 0}), at(1101ms));
  EXPECT_EQ(state_at(driver, at(1200ms)).vehicles[0].velocity_mps.x(), 4);
}

TEST(DriverOfOneRobot, RefusesARobotThatAnotherOneDrives) {
  Driver driver = driver_of(1, leased());
  give(driver, sent_by(77, 0, 5), at(500ms));
  EXPECT_FALSE(driver.finished()) << "another robot";
  give(driver, sent_by(77, 1, 5), at(500ms));
  EXPECT_TRUE(driver.failed());
  EXPECT_NE(driver.reason().find("robot 1 is driven by another driver already"), std::string::npos);
  EXPECT_TRUE(advance(driver, at(2s)).empty());
}

TEST(DriverOfAllRobots, RefusesRobotsThatAnotherOneDrives) {
  announce(leased());
  Driver driver(kRun, kWorldLife, kSpeedLimit_mps, std::nullopt);
  give(driver, mission_part(1, MissionState::kRunning, roster_of(2)), at(0s));
  give(driver, sent_by(77, 1, 5), at(500ms));
  EXPECT_TRUE(driver.failed());
  EXPECT_NE(driver.reason().find("robot 1 is driven by another driver already"), std::string::npos);
}

TEST(DriverOfOneRobot, ADriverThatRunsAlreadyGoesOn) {
  Driver driver = driver_of(1, leased());
  for (int tick = 0; tick < 12; ++tick) state_at(driver, at(1s + tick * 100ms));
  give(driver, sent_by(1, 1, 5), at(2200ms));
  EXPECT_FALSE(driver.finished());
}

TEST(DriverOfOneRobot, OfTwoThatBeginTogetherOneGivesWay) {
  Driver less = driver_of(1, leased(), 5), greater = driver_of(1, leased(), 6);
  const WorldState one = state_at(less, at(1s)), other = state_at(greater, at(1s));
  give(less, other, at(1001ms));
  give(greater, one, at(1001ms));
  EXPECT_FALSE(less.finished());
  EXPECT_TRUE(greater.failed());
}

TEST(DriverOfOneRobot, CatchesUpWithTheOthers) {
  Driver driver = driver_of(1, leased());
  const auto receive = [&](Tick tick, Instant now) {
    MissionPart part = mission_part(1, MissionState::kRunning, roster_of(2));
    part.header.tick = tick;
    give(driver, part, now);
  };
  EXPECT_EQ(state_at(driver, at(1s)).header.tick, 0);
  receive(1, at(1050ms));
  EXPECT_EQ(state_at(driver, at(1100ms)).header.tick, 1) << "the others began a little earlier";
  receive(9, at(1150ms));
  const WorldState state = state_at(driver, at(1200ms));
  EXPECT_EQ(state.header.tick, 10);
  EXPECT_EQ(state.skipped_ticks, 8);
  receive(1000000, at(1250ms));
  EXPECT_LE(state_at(driver, at(1300ms)).header.tick, 400) << "the mission's end";
}

TEST(DriverOfOneRobot, RefusesAMissionInWhichItWouldHaveToKnowTheOthers) {
  const Driver driver = driver_of(1, apart());
  EXPECT_TRUE(driver.failed());
  EXPECT_NE(driver.reason().find("lease_s"), std::string::npos);
}

TEST(ExampleRobot, TurnsBeforeItDrivesAndNeverExceedsItsSpeed) {
  Robot robot({0, 0, 0}, kSpeedLimit_mps);
  robot.drive({-100, 0, 0});
  robot.move(0.1);
  EXPECT_EQ(robot.velocity_mps().norm(), 0) << "it looks the other way";
  for (int i = 0; i < 40; ++i) {
    robot.move(0.1);
    EXPECT_LE(robot.velocity_mps().norm(), kSpeedLimit_mps * (1 + 1e-12));
  }
  EXPECT_NEAR(robot.velocity_mps().x(), -kSpeedLimit_mps, 1e-9);
  robot.drive({0, 0, 0});
  for (int i = 0; i < 40; ++i) robot.move(0.1);
  EXPECT_EQ(robot.velocity_mps().norm(), 0);
  robot.drive({-1, 0, 0});
  robot.move(0.1);
  EXPECT_NEAR(robot.velocity_mps().x(), -1, 1e-9) << "it looks where it looked when it stopped";
}

}  // namespace
}  // namespace ergocast::example
