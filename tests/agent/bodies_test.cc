// SPDX-License-Identifier: BSD-3-Clause
// An agent whose body keeps a distance: what it waits for, commands and reports.
#include <gtest/gtest.h>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

/// The whole target is to the right, and all agents keep 30 m.
Mission apart(int agents, Pace pace) {
  Mission mission = small_mission(agents);
  mission.target_coefficients[4] = -0.5;
  mission.timing.pace = pace;
  mission.speed_limit_mps = 40;
  mission.separation.distance_m = 30;
  mission.separation.guard = true;
  return mission;
}

std::vector<Command> commands(Agent& agent, const WorldState& state, Instant now = at(0s)) {
  return only<Command>(deliver(agent, state, now));
}

Eigen::Vector3d command_among(const Mission& mission,
                              const std::vector<Eigen::Vector3d>& places_m) {
  Agent agent = running_agent(mission);
  const auto sent = commands(agent, world_state(0, places_m));
  return sent.empty() ? Eigen::Vector3d(kNan, 0, 0) : sent[0].velocity_mps;
}

TEST(AgentKeepsApart, FromWhereItWantsToGo) {
  const Mission mission = apart(2, Pace::kRealtime);
  const Eigen::Vector3d free = command_among(mission, {{500, 500, 0}, {900, 900, 0}});
  ASSERT_GT(free.norm(), 5);
  const Eigen::Vector3d ahead(500 + 30.5 * free.x() / free.norm(),
                              500 + 30.5 * free.y() / free.norm(), 0);
  const Eigen::Vector3d cut = command_among(mission, {{500, 500, 0}, ahead});
  EXPECT_LE(cut.dot(free) / free.norm(), 2.5) << "half of the 0.5 m, in 0.1 s";
}

/// A state of 17 vehicles has two parts; the vehicle ahead is in the second.
TEST(AgentKeepsApart, AnswersOnlyOnceAllPartsOfATickAreThere) {
  for (const Pace pace : {Pace::kRealtime, Pace::kLockstep}) {
    Mission mission = apart(1, pace);
    Agent agent = running_agent(mission);
    WorldState first = world_state(0, {{500, 500, 0}});
    for (int i = 1; i < kMaxVehiclesPerState; ++i) {
      first.vehicles[static_cast<std::size_t>(i)] = {i, -1, {1900, 100.0 * i, 0}, {0, 0, 0}};
    }
    first.vehicle_count = kMaxVehiclesPerState;
    first.parts = 2;
    WorldState second = world_state(0, {{530.1, 500, 0}});
    second.vehicles[0].id = kMaxVehiclesPerState;
    second.part = 1;
    second.parts = 2;
    EXPECT_TRUE(commands(agent, first).empty());
    EXPECT_EQ(status_after(agent, at(1s)).waiting_for, kWorld);
    const auto sent = commands(agent, second, at(2s));
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_LE(sent[0].velocity_mps.x(), 0.5);
    // A part of another tick does not replace it.
    first.header.tick = 1;
    first.header.sequence = next_sequence();
    EXPECT_TRUE(commands(agent, first, at(3s)).empty());

    Agent other = running_agent(mission);
    first.header.tick = 0;
    EXPECT_TRUE(commands(other, second).empty());
    const auto turned_round = commands(other, first);
    ASSERT_EQ(turned_round.size(), 1u);
    EXPECT_EQ(turned_round[0].velocity_mps, sent[0].velocity_mps) << "whatever their order";
  }
}

TEST(AgentKeepsApart, ReportsWhichAgentBlocksIt) {
  const Mission mission = apart(7, Pace::kRealtime);
  Agent agent = running_agent(mission);
  std::vector<Eigen::Vector3d> ring = {{500, 500, 0}};
  for (int i = 0; i < 6; ++i) {
    const double angle = i * M_PI / 3;
    ring.emplace_back(500 + 30 * std::cos(angle), 500 + 30 * std::sin(angle), 0);
  }
  for (Tick tick = 0; tick < 3; ++tick) commands(agent, world_state(tick, ring));
  AgentStatus status = status_after(agent, at(1s));
  EXPECT_GE(status.blocked_by, 1);
  EXPECT_EQ(status.blocked_now_ticks, 3);
  EXPECT_EQ(status.blocked_ticks, 3);
  for (int i = 1; i <= 6; ++i) ring[static_cast<std::size_t>(i)].x() += 500;
  commands(agent, world_state(3, ring), at(2s));
  status = status_after(agent, at(3s));
  EXPECT_EQ(status.blocked_by, kUnassigned);
  EXPECT_EQ(status.blocked_now_ticks, 0);
  EXPECT_EQ(status.blocked_ticks, 3);
  EXPECT_EQ(status.longest_block_ticks, 3);
}

/// How far from home an agent is in the end that is recalled in front of two bodies, 38 m apart.
double apart_from_home_m(bool others_sent_out) {
  Mission mission = apart(3, Pace::kRealtime);
  mission.timing.tick_count = 1000;
  announce(mission);
  Agent agent(identity_of(0));
  std::vector<RosterEntry> roster = roster_of(3);
  roster[0].recall_revision = 0;
  for (std::size_t i = 1; others_sent_out && i < roster.size(); ++i) {
    roster[i].recall_revision = 0;
    roster[i].active_until = 0;
    roster[i].leaves = true;
  }
  give(agent, mission_part(0, MissionState::kRunning, roster), at(0s));
  std::vector<Eigen::Vector3d> places_m = {{500, 500, 0}, {440, 520, 0}, {446, 482, 0}};
  for (Tick tick = 0; tick < 600; ++tick) {
    const auto sent = commands(agent, world_state(tick, places_m), at(tick * 100ms));
    if (!sent.empty()) places_m[0] += mission.timing.dt_s * sent[0].velocity_mps;
  }
  return (places_m[0] - mission.starts_m[0]).norm();
}

TEST(AgentKeepsApart, GoesHomeRoundBodiesThatNoAgentDrives) {
  EXPECT_GT(apart_from_home_m(false), 300) << "they may drive away";
  EXPECT_LT(apart_from_home_m(true), 1e-6);
}

TEST(AgentKeepsApart, SendsARestartedWorldThePlacesOfAllBodies) {
  Agent agent = running_agent(apart(2, Pace::kRealtime));
  const WorldState state = world_state(4, {{500, 500, 0}, {900, 900, 0}});
  commands(agent, state);
  Hello question;
  question.header = {kRun, kWorld, kWorldLife + 1, next_sequence(), 0};
  const Outbox sent = deliver(agent, question, at(1s));
  const auto states = only<WorldState>(sent);
  ASSERT_EQ(states.size(), 1u);
  EXPECT_EQ(states[0].header.tick, 4);
  EXPECT_EQ(states[0].vehicles[1].position_m, Eigen::Vector3d(900, 900, 0));
  EXPECT_EQ(only<Command>(sent).size(), 2u);
}

/// A robot that has overshot is outside of the domain. Its true position counts.
TEST(AgentKeepsApart, AlsoBesideTheDomain) {
  const Mission mission = apart(2, Pace::kRealtime);
  const Eigen::Vector3d v_mps = command_among(mission, {{-3, 500, 0}, {900, 900, 0}});
  EXPECT_TRUE(v_mps.allFinite());
  EXPECT_GE(v_mps.x(), 0) << "never further out";
}

TEST(AgentKeepsApart, OnlyWhereTheMissionRequiresIt) {
  Mission mission = apart(2, Pace::kRealtime);
  mission.separation = {};
  const Eigen::Vector3d free = command_among(mission, {{500, 500, 0}, {900, 900, 0}});
  EXPECT_EQ(command_among(mission, {{500, 500, 0}, {505, 500, 0}}), free);
}

}  // namespace
}  // namespace ergocast
