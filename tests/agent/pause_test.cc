// SPDX-License-Identifier: BSD-3-Clause
// What an agent sends in real time while no ticks arrive, in a mission that is paused or not, and
// once it learns of the pause.
#include <gtest/gtest.h>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

/// The contributions sent in three seconds after tick 0, the only tick that arrives.
std::vector<Contribution> sent_in_silence(std::vector<Hold> holds) {
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  announce(mission);
  Agent agent(identity_of(0));
  MissionPart part = mission_part(0, MissionState::kRunning, roster_of(2));
  part.amendments = pauses(std::move(holds));
  give(agent, part, at(0s));
  deliver(agent, world_state(0, {{100, 500, 0}, {200, 500, 0}}));
  Outbox sent;
  for (int i = 1; i <= 30; ++i) agent.advance(at(i * 100ms), sent);
  EXPECT_FALSE(agent.finished()) << agent.reason();
  return only<Contribution>(sent);
}

TEST(AgentWithoutTicks, RepeatsOnceASecondWhatItHas) {
  const auto sent = sent_in_silence({});
  ASSERT_EQ(sent.size(), 3u);
  for (const Contribution& one : sent) EXPECT_EQ(one.steps, 1);
}

TEST(AgentWithoutTicks, SendsNoCoverageWhileTheMissionIsPaused) {
  // It joined in the pause and has covered nothing. Others would refuse a row without steps.
  EXPECT_TRUE(sent_in_silence({{0, -1}}).empty());
}

TEST(AgentThatLearnsLateOfAPause, DoesNotWaitForTheTickThatItAnnouncedMeanwhile) {
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  announce(mission);
  Agent agent(identity_of(0));
  MissionPart part = mission_part(0, MissionState::kRunning, roster_of(2));
  give(agent, part, at(0s));
  const auto steps_sent_at = [&](Tick tick) {
    Outbox sent;
    give(agent, world_state(tick, {{100, 500, 0}, {200, 500, 0}}), at(tick * 100ms));
    agent.advance(at(tick * 100ms), sent);
    std::vector<std::int64_t> steps;
    for (const Contribution& one : only<Contribution>(sent)) steps.push_back(one.steps);
    return steps;
  };
  for (Tick tick = 0; tick < 20; ++tick) EXPECT_EQ(steps_sent_at(tick).size(), 1u) << tick;
  ++part.revision;
  part.amendments = pauses({{2, 20}});
  give(agent, part, at(2s));
  EXPECT_EQ(steps_sent_at(20), std::vector<std::int64_t>{21}) << "no other process can send it";
  EXPECT_EQ(steps_sent_at(21), std::vector<std::int64_t>{22});
}

}  // namespace
}  // namespace ergocast
