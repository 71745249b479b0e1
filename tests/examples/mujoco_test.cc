// SPDX-License-Identifier: BSD-3-Clause
// Tests the separation with robots in an independent physics engine: real agents command discs on
// wheels and quadrotors. These follow late, slip, and touch everything in their way.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "examples/mujoco/mujoco_physics.h"
#include "tests/support/simulated_team.h"

namespace ergocast::mujoco {
namespace {

const std::filesystem::path kFolder =
    std::filesystem::path(ERGOCAST_SOURCE_DIR) / "examples/mujoco";

struct Team {
  const char* scenario;
  RobotDesign design;
};
const std::array kTeams = {Team{"discs", kDiscs}, Team{"quadrotors", kQuadrotors}};

Mission mission_of(const Team& team, std::uint64_t seed, double duration_s) {
  Overrides overrides;
  overrides.seed = seed;
  overrides.duration_s = duration_s;
  const auto file = kFolder / (team.scenario + std::string(".textproto"));
  return Scenario::load(file, overrides).value().mission();
}

struct Outcome {
  Contacts contacts;
  RunFacts facts;
  std::string trajectory;
};

/// The whole team in one process; the engine steps with the world's ticks.
Outcome outcome_of(const Team& team, const Mission& mission) {
  std::ostringstream trajectory, metrics;
  MujocoPhysics* physics = nullptr;
  lab::Simulation simulation(
      {.plan = encode_plan(mission), .physics = mujoco_physics(team.design, &physics)}, trajectory,
      metrics);
  simulation.run(std::chrono::hours(1));
  EXPECT_EQ(simulation.coordinator().reason(), "mission complete");
  EXPECT_EQ(simulation.last_tick(), mission.timing.tick_count);
  return {physics->contacts(), simulation.recorder().facts(), trajectory.str()};
}

Outcome reported_outcome_of(const Team& team, const Mission& mission, const char* how) {
  const Outcome outcome = outcome_of(team, mission);
  std::printf(
      "%s, %s: D = %g m, T = %g s, seed %llu, %g s: %lld robot and %lld wall contacts, "
      "nearest %.3f m, phi^2 %.2e\n",
      team.scenario, how, mission.separation.distance_m, mission.separation.response_s,
      static_cast<unsigned long long>(mission.seed),
      static_cast<double>(mission.timing.tick_count) * mission.timing.dt_s,
      static_cast<long long>(outcome.contacts.robots),
      static_cast<long long>(outcome.contacts.walls),
      mission.separation.distance_m > 0 ? outcome.facts.nearest_m : 0,
      outcome.facts.ergodic_metric_last);
  return outcome;
}

class RobotsInPhysics : public testing::TestWithParam<int> {
 protected:
  static const Team& team() { return kTeams[static_cast<std::size_t>(GetParam())]; }
};
INSTANTIATE_TEST_SUITE_P(Of, RobotsInPhysics, testing::Values(0, 1), [](const auto& test) {
  return std::string(kTeams[static_cast<std::size_t>(test.param)].scenario);
});

TEST_P(RobotsInPhysics, HaveNoContactsWhereTheyCrowd) {
  constexpr double kDuration_s = 30;
  Mission free = mission_of(team(), 1, kDuration_s);
  free.separation = {};
  EXPECT_GE(reported_outcome_of(team(), free, "no separation").contacts.robots, 1000);
  Mission prompt = mission_of(team(), 1, kDuration_s);
  prompt.separation.response_s = 0;
  const Contacts late = reported_outcome_of(team(), prompt, "lag ignored").contacts;
  EXPECT_GE(late.robots, 50) << "the check is worth nothing if no lag touches a robot";
  EXPECT_GE(late.walls, 1);
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const Outcome outcome =
        reported_outcome_of(team(), mission_of(team(), seed, kDuration_s), "kept");
    EXPECT_EQ(outcome.contacts.robots, 0) << seed;
    EXPECT_EQ(outcome.contacts.walls, 0) << seed;
    EXPECT_GT(outcome.facts.ergodic_metric_last, 0);
    EXPECT_LT(outcome.facts.ergodic_metric_last, 0.05)
        << "they cover: standing still has more than 0.1";
  }
}

TEST_P(RobotsInPhysics, EqualMissionsMoveAlike) {
  const Mission mission = mission_of(team(), 5, 3);
  EXPECT_EQ(outcome_of(team(), mission).trajectory, outcome_of(team(), mission).trajectory);
}

/// T = lag + dt/2: the distance that a robot still moves after a command to stop, in seconds at V.
TEST_P(RobotsInPhysics, FollowAsLateAsTheirScenarioStates) {
  const Mission mission = mission_of(team(), 1, 10);
  MujocoPhysics physics(mission, team().design);
  physics.place(3, {2, 3, 0}, {0, 0, 0});
  const Eigen::Vector3d way(0.8, 0.6, 0);
  std::vector<PhysicalBody> body = {{3, mission.speed_limit_mps * way}};
  for (int tick = 0; tick < 50; ++tick) physics.pass_tick(body);
  EXPECT_NEAR(body[0].velocity_mps.norm(), mission.speed_limit_mps, 0.02);
  const Eigen::Vector3d reported_m = body[0].position_m;
  body[0].wanted_mps.setZero();
  for (int tick = 0; tick < 30; ++tick) physics.pass_tick(body);
  EXPECT_LT(body[0].velocity_mps.norm(), 0.01);
  const double lag_s = (body[0].position_m - reported_m).norm() / mission.speed_limit_mps;
  EXPECT_NEAR(lag_s + mission.timing.dt_s / 2, mission.separation.response_s, 0.02);
}

TEST_P(RobotsInPhysics, ThatAreDrivenIntoEachOtherOrAWallAreCounted) {
  const Mission mission = mission_of(team(), 1, 10);
  MujocoPhysics physics(mission, team().design);
  physics.place(0, {4, 5, 0}, {0, 0, 0});
  physics.place(1, {5, 5, 0}, {0, 0, 0});
  std::vector<PhysicalBody> bodies = {{0, {1, 0, 0}}, {1, {0, 0, 0}}};
  for (int tick = 0; tick < 20; ++tick) physics.pass_tick(bodies);
  EXPECT_GE(physics.contacts().robots, 1);
  EXPECT_EQ(physics.contacts().walls, 0);
  EXPECT_GT(bodies[1].position_m.x(), 5.05) << "it is pushed";
  physics.place(2, {9.5, 2, 0}, {0, 0, 0});  // a new robot: the others continue
  const Eigen::Vector3d before_m = bodies[1].position_m;
  bodies.push_back({2, {1, 0, 0}});
  physics.pass_tick(bodies);
  EXPECT_LT((bodies[1].position_m - before_m).norm(), 0.15);
  for (int tick = 0; tick < 20; ++tick) physics.pass_tick(bodies);
  EXPECT_GE(physics.contacts().walls, 1);
  EXPECT_NEAR(bodies[2].position_m.x(), 10, 0.03) << "walls stand a radius outside of the domain";
}

/// Walls of the mission stand in the physics, too.
TEST(RobotsOfPhysics, TouchNoWallOfTheMission) {
  const Team rooms = {"two_rooms", kDiscs};
  Mission prompt = mission_of(rooms, 1, 30);
  ASSERT_EQ(prompt.walls.size(), 2u);
  prompt.separation.response_s = 0;
  prompt.wall_clearance_m = 0.2;
  EXPECT_GE(reported_outcome_of(rooms, prompt, "lag ignored").contacts.walls, 1);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Outcome outcome = reported_outcome_of(rooms, mission_of(rooms, seed, 30), "kept");
    EXPECT_EQ(outcome.contacts.robots, 0) << seed;
    EXPECT_EQ(outcome.contacts.walls, 0) << seed;
  }
}

TEST(RobotsOfPhysics, AreStoppedByAWallThatTheyAreDrivenInto) {
  const Mission mission = mission_of({"two_rooms", kDiscs}, 1, 10);
  MujocoPhysics physics(mission, kDiscs);
  physics.place(0, {4, 2, 0}, {0, 0, 0});
  std::vector<PhysicalBody> body = {{0, {1, 0, 0}}};
  for (int tick = 0; tick < 30; ++tick) physics.pass_tick(body);
  EXPECT_NEAR(body[0].position_m.x(), 4.9 - kDiscs.radius_m, 0.02);
  EXPECT_GE(physics.contacts().walls, 5);
}

TEST(RobotsOfPhysics, RefuseMissionsThatTheyCannotRun) {
  const auto problem_of = [](const Mission& mission) {
    const auto made = mujoco_physics(kDiscs)(mission);
    return made ? "" : made.error();
  };
  const Mission mission = mission_of(kTeams[0], 1, 10);
  EXPECT_EQ(problem_of(mission), "");
  Mission other = mission;
  other.domain.size_m.z() = 5;
  EXPECT_NE(problem_of(other).find("remove domain.size_z_m"), std::string::npos);
  other = mission;
  other.vehicle = {VehicleKind::kUnicycle, 0, 2};
  EXPECT_NE(problem_of(other).find("vehicle { kind: POINT }"), std::string::npos);
  other = mission;
  other.separation.distance_m = 0.39;
  EXPECT_NE(problem_of(other).find("less than a robot's diameter"), std::string::npos);
  other = mission_of({"two_rooms", kDiscs}, 1, 10);
  other.wall_clearance_m = 0.19;
  EXPECT_NE(problem_of(other).find("less than a robot's radius"), std::string::npos);
  other = mission;
  other.starts_m.resize(129);
  EXPECT_NE(problem_of(other).find("use fewer"), std::string::npos);
}

}  // namespace
}  // namespace ergocast::mujoco
