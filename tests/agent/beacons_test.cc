// SPDX-License-Identifier: BSD-3-Clause
// Agents that know their teammates' positions only from beacons.
#include <gtest/gtest.h>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

/// The whole target is to the right, and all agents keep 30 m.
Mission leased(int agents) {
  Mission mission = small_mission(agents);
  mission.target_coefficients[4] = -0.5;
  mission.timing.pace = Pace::kRealtime;
  mission.timing.command_hold_s = 0;
  mission.speed_limit_mps = 40;
  mission.separation.distance_m = 30;
  mission.separation.lease_s = 2;
  return mission;
}

/// Two agents, each with a driver of its own, whose beacons may be lost.
class Pair {
 public:
  Pair() {
    announce(leased(2));
    for (AgentId id = 0; id < 2; ++id) agents_.push_back(running_agent(leased(2), id));
  }

  /// The velocities that both agents command at the next tick.
  std::vector<Eigen::Vector3d> pass(bool first_is_heard = true) {
    const Instant now = at(tick_ * 100ms);
    std::vector<Eigen::Vector3d> velocities_mps;
    for (AgentId id = 0; id < 2; ++id) {
      WorldState state = world_state(tick_, {places_m_[static_cast<std::size_t>(id)]}, tick_ - 1);
      state.vehicles[0].id = id;
      const Outbox sent = deliver(agents_[static_cast<std::size_t>(id)], state, now);
      const auto commands = only<Command>(sent);
      EXPECT_EQ(commands.size(), 1u);
      velocities_mps.push_back(commands.empty() ? Eigen::Vector3d(kNan, 0, 0)
                                                : commands[0].velocity_mps);
      for (const Beacon& beacon : only<Beacon>(sent)) {
        if (id == 1 || first_is_heard) give(agents_[static_cast<std::size_t>(1 - id)], beacon, now);
      }
    }
    ++tick_;
    return velocities_mps;
  }
  Eigen::Vector3d& place_m(AgentId id) { return places_m_[static_cast<std::size_t>(id)]; }

 private:
  std::vector<Agent> agents_;
  std::vector<Eigen::Vector3d> places_m_ = {{500, 500, 0}, {900, 900, 0}};
  Tick tick_ = 0;
};

TEST(AgentsWithBeacons, StandUntilTheyReceiveEachOther) {
  Pair pair;
  EXPECT_EQ(pair.pass()[0].norm(), 0);
  for (int i = 0; i < 6; ++i) pair.pass();
  EXPECT_GT(pair.pass()[0].norm(), 5);
  EXPECT_GT(pair.pass()[1].norm(), 5);
}

TEST(AgentsWithBeacons, KeepTheirDistanceFromTheReportedPlace) {
  Pair pair;
  for (int i = 0; i < 10; ++i) pair.pass();
  const Eigen::Vector3d free_mps = pair.pass()[0];
  pair.place_m(1) = pair.place_m(0) + 60 * free_mps.normalized();
  for (int i = 0; i < 6; ++i) pair.pass();
  const double closing_mps = pair.pass()[0].dot(free_mps.normalized());
  // From 60 m subtract D, and what the other may have gone: 40 m/s for two ticks and more. Half of
  // the rest may be used in a tick.
  EXPECT_LE(closing_mps, (60 - 30 - 2 * 4) / 2 / 0.1);
  EXPECT_LT(closing_mps, free_mps.norm() + 1e-9);
  pair.place_m(1) = pair.place_m(0) + 33 * free_mps.normalized();
  for (int i = 0; i < 6; ++i) pair.pass();
  EXPECT_LE(pair.pass()[0].dot(free_mps.normalized()), 1e-9) << "nearer than it may have come";
}

TEST(AgentsWithBeacons, AnAgentWithoutEchoesStandsAfterTheLease) {
  Pair pair;
  for (int i = 0; i < 10; ++i) pair.pass();
  int moved = 0;
  for (int i = 0; i < 40; ++i) moved += pair.pass(false)[0].norm() > 0 ? 1 : 0;
  EXPECT_GE(moved, 10);
  EXPECT_LE(moved, 20);
  EXPECT_EQ(pair.pass(false)[0].norm(), 0);
  for (int i = 0; i < 6; ++i) pair.pass();
  EXPECT_GT(pair.pass()[0].norm(), 5) << "received again";
}

/// A newer roster may have a body that the agent does not know of.
TEST(AgentsWithBeacons, StandWhileTheirRosterIsOld) {
  Mission mission = leased(1);
  Agent agent = running_agent(mission);
  const auto commanded = [&](Tick tick, std::int64_t revision) {
    WorldState state = world_state(tick, {{500, 500, 0}}, tick - 1);
    state.roster_revision = revision;
    const auto commands = only<Command>(deliver(agent, state, at(tick * 100ms)));
    return commands.empty() ? kNan : commands[0].velocity_mps.norm();
  };
  EXPECT_GT(commanded(0, 0), 5);
  EXPECT_EQ(commanded(1, 1), 0);
  give(agent, mission_part(1, MissionState::kRunning, roster_of(1)), at(150ms));
  EXPECT_GT(commanded(2, 1), 5);
}

TEST(AgentsWithBeacons, SendNoneWhereTheWorldSendsAllPlaces) {
  Mission mission = leased(2);
  mission.separation.lease_s = 0;
  Agent agent = running_agent(mission);
  for (Tick tick = 0; tick < 9; ++tick) {
    const Outbox sent = deliver(agent, world_state(tick, {{500, 500, 0}, {900, 900, 0}}, tick - 1),
                                at(tick * 100ms));
    EXPECT_TRUE(only<Beacon>(sent).empty());
  }
}

}  // namespace
}  // namespace ergocast
