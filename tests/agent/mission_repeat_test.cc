// SPDX-License-Identifier: BSD-3-Clause
// Agents store the mission and repeat it to a restarted coordinator or world. They report their
// positions to the world, and ask for admission again when the roster has lost them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/agent/driven_agent.h"
#include "tests/support/bytes.h"

namespace ergocast {
namespace {

using namespace test;

/// A mission in two parts, as a coordinator sends it.
std::array<MissionPart, 2> two_parts(std::int64_t revision) {
  std::array<MissionPart, 2> parts;
  for (std::int32_t p = 0; p < 2; ++p) {
    MissionPart& part = parts[static_cast<std::size_t>(p)];
    part = mission_part(revision, MissionState::kRunning, {{author_of(p), 0, -1}}, "so far");
    part.header.sequence = 40 + p;
    part.header.tick = 17;
    part.part = p;
    if (p > 0) part.plan.clear();
    part.parts = 2;
  }
  return parts;
}

/// Agent 0 of two, which knows revision 3.
Agent informed_agent(const Mission& mission = small_mission(2)) {
  announce(mission);
  Agent agent(identity_of(0));
  for (const MissionPart& part : two_parts(3)) give(agent, part, at(0s));
  advance(agent, at(10s));
  return agent;
}

/// A question with a sequence above those of all former messages in the tests.
Hello question_of(AgentId who, Tick tick) {
  return {{kRun, who, who == kWorld ? kWorldLife : kCoordinatorLife, 1000 + next_sequence(), tick},
          kUnassigned,
          "",
          ""};
}

std::size_t repeated_after(Agent& agent, const Message& message) {
  give(agent, message, at(10s));
  return only<MissionPart>(advance(agent, at(10s + 50ms))).size();
}

TEST(MissionRepeat, IsEveryPartAsItsCoordinatorSentItOnBothBuses) {
  for (const AgentId asker : {kCoordinator, kWorld}) {
    Agent agent = informed_agent();
    give(agent, question_of(asker, -1), at(10s));
    std::vector<std::vector<std::byte>> repeated[kBusCount];
    for (const Outgoing& outgoing : advance(agent, at(10s + 50ms))) {
      if (!std::holds_alternative<MissionPart>(outgoing.message)) continue;
      repeated[static_cast<std::size_t>(outgoing.bus)].push_back(bytes_of(outgoing.message));
    }
    const auto parts = two_parts(3);
    const std::vector<std::vector<std::byte>> original{bytes_of(parts[0]), bytes_of(parts[1])};
    EXPECT_EQ(repeated[static_cast<std::size_t>(Bus::kSwarm)], original);
    EXPECT_EQ(repeated[static_cast<std::size_t>(Bus::kCommand)], original);
    EXPECT_TRUE(repeated[static_cast<std::size_t>(Bus::kWorld)].empty());
  }
}

TEST(MissionRepeat, ComesAfterAWaitOfItsOwnWithin50Milliseconds) {
  std::vector<Instant> due;
  for (const AgentId id : {0, 1}) {
    announce(small_mission(2));
    Agent agent(identity_of(id));
    for (const MissionPart& part : two_parts(3)) give(agent, part, at(0s));
    advance(agent, at(10s));
    give(agent, question_of(kCoordinator, -1), at(10s));
    due.push_back(agent.next_wakeup());
    EXPECT_GT(due.back(), at(10s));
    EXPECT_LE(due.back(), at(10s + 50ms));
    EXPECT_TRUE(only<MissionPart>(advance(agent, due.back() - 1ns)).empty());
    EXPECT_EQ(only<MissionPart>(advance(agent, due.back())).size(), 4u);
    EXPECT_TRUE(only<MissionPart>(advance(agent, at(20s))).empty()) << "once";
  }
  EXPECT_NE(due[0], due[1]) << "one of many answers first";
}

TEST(MissionRepeat, IsNotForAProcessThatKnowsTheMission) {
  Agent agent = informed_agent();
  EXPECT_EQ(repeated_after(agent, question_of(kWorld, 0)), 0u);
  EXPECT_EQ(repeated_after(agent, question_of(kCoordinator, 0)), 0u);
}

TEST(MissionRepeat, IsNotForAnAgentThatJoins) {
  Agent agent = informed_agent();
  for (const Tick tick : {-1, 0}) {
    EXPECT_EQ(repeated_after(agent, Hello{{kRun, kUnassigned, 71, 1, tick}, 1, "", ""}), 0u);
    EXPECT_EQ(repeated_after(agent, Hello{{kRun, 1, incarnation_of(1), 1, tick}, 1, "", ""}), 0u);
  }
}

TEST(MissionRepeat, IsNotGivenBeforeTheMissionIsKnown) {
  announce(small_mission(2));
  Agent agent(identity_of(0));
  give(agent, two_parts(3)[0], at(0s));
  EXPECT_EQ(repeated_after(agent, question_of(kCoordinator, -1)), 0u);
}

TEST(MissionRepeat, IsNotNeededIfAnotherProcessHasSentIt) {
  for (const std::int64_t revision : {3, 4}) {
    Agent agent = informed_agent();
    give(agent, question_of(kCoordinator, -1), at(10s));
    give(agent, two_parts(revision)[0], at(10s));
    EXPECT_TRUE(only<MissionPart>(advance(agent, at(10s + 50ms))).empty());
  }
}

TEST(MissionRepeat, IsNeededIfAnotherProcessKnowsLess) {
  Agent agent = informed_agent();
  give(agent, question_of(kCoordinator, -1), at(10s));
  give(agent, two_parts(2)[0], at(10s));
  EXPECT_EQ(only<MissionPart>(advance(agent, at(10s + 50ms))).size(), 4u);
}

/// How often the mission is repeated in 3 s to a process that sends something each millisecond.
template <class Say>
std::size_t repeats_to(Say request) {
  Agent agent = informed_agent();
  std::size_t parts = 0;
  for (int ms = 0; ms < 3000; ++ms) {
    give(agent, request(), at(10s + ms * 1ms));
    parts += only<MissionPart>(advance(agent, at(10s + ms * 1ms))).size();
  }
  return parts / 4;
}

TEST(MissionRepeat, ComesTwiceASecondAtMostToASenderOfAnOldOne) {
  EXPECT_EQ(repeats_to([] { return two_parts(2)[0]; }), 6u) << "every 500 ms and a little";
}

TEST(MissionRepeat, ComesTenTimesASecondAtMostToAProcessThatAsks) {
  const std::size_t answers = repeats_to([] { return question_of(kCoordinator, -1); });
  EXPECT_GE(answers, 20u);
  EXPECT_LE(answers, 30u);
}

// Recordings of an old mission must not use up the answers to mission requests.
TEST(MissionRepeat, ComesToAProcessThatAsksAlsoJustAfterAnOldOneWasCorrected) {
  Agent agent = informed_agent();
  EXPECT_EQ(repeated_after(agent, two_parts(2)[0]), 4u);
  give(agent, question_of(kCoordinator, -1), at(10s + 151ms));
  EXPECT_EQ(only<MissionPart>(advance(agent, at(10s + 201ms))).size(), 4u);
}

// ---- its position ----

TEST(WorldQuestion, GetsTheLastTwoCommandsWithTheirTicksAndPlaces) {
  Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  std::vector<Command> given;
  for (Tick tick = 0; tick < 3; ++tick) {
    const double x_m = 100.0 + static_cast<double>(tick);
    for (const Command& command :
         only<Command>(deliver(agent, world_state(tick, {{x_m, 500, 0}})))) {
      given.push_back(command);
    }
  }
  const Outbox out = deliver(agent, question_of(kWorld, 0));
  const auto sent = only<Command>(out);
  ASSERT_EQ(sent.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(sent[i].header.tick, given[i + 1].header.tick);
    EXPECT_EQ(sent[i].position_m, given[i + 1].position_m);
    EXPECT_EQ(sent[i].velocity_mps, given[i + 1].velocity_mps);
  }
  EXPECT_TRUE(only<Command>(advance(agent, at(1ms))).empty()) << "once for each question";
}

TEST(WorldQuestion, BeforeTheFirstTickIsAnsweredByNowhereYet) {
  Agent agent = running_agent(small_mission(1));
  for (const Command& command : only<Command>(deliver(agent, question_of(kWorld, 0)))) {
    EXPECT_EQ(command.header.tick, -1);
    EXPECT_EQ(command.asked_by, kWorldLife);
  }
  EXPECT_EQ(only<Command>(deliver(agent, question_of(kWorld, 0))).size(), 2u);
}

TEST(WorldQuestion, IsNotForTheCoordinatorToAsk) {
  Agent agent = running_agent(small_mission(1));
  EXPECT_TRUE(only<Command>(deliver(agent, question_of(kCoordinator, 0))).empty());
}

// ---- a restarted world that is behind ----

TEST(WorldBehind, GetsTheAnswerToItsTickAndTheTeamTheBlocksAgain) {
  Agent agent = running_agent(small_mission(1));
  for (Tick tick = 0; tick < 3; ++tick) {
    const double x_m = 100.0 + static_cast<double>(tick);
    deliver(agent, world_state(tick, {{x_m, 500, 0}}, tick - 1));
  }
  const WorldState behind = world_state(1, {{101, 500, 0}}, 0);
  EXPECT_TRUE(only<Command>(deliver(agent, behind, at(500ms))).empty())
      << "a world repeats old states for its logger";
  const Outbox out = deliver(agent, world_state(1, {{101, 500, 0}}, 0), at(1500ms));
  const auto sent = only<Command>(out);
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].header.tick, 1);
  EXPECT_EQ(sent[1].header.tick, 2);
  EXPECT_FALSE(only<Contribution>(out).empty());
}

// ---- lost from the roster ----

TEST(LostFromTheRoster, AnAgentAsksAgainUnderItsNumberAndGoesOn) {
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  deliver(agent, world_state(0, {{100, 500, 0}}), at(1s));
  EXPECT_TRUE(only<Hello>(advance(agent, at(10s))).empty());

  // A coordinator took over from an old revision in which agent 0 was not yet a member.
  give(agent, mission_part(1000, MissionState::kRunning, {{author_of(1), 0, -1}}), at(11s));
  const auto hellos = only<Hello>(advance(agent, at(11s)));
  ASSERT_EQ(hellos.size(), 1u);
  EXPECT_EQ(hellos[0].requested_id, 0);
  EXPECT_EQ(hellos[0].header.incarnation, incarnation_of(0));
  EXPECT_TRUE(only<Hello>(advance(agent, at(11s + 249ms))).empty());
  EXPECT_EQ(only<Hello>(advance(agent, at(11s + 250ms))).size(), 1u);
  EXPECT_LE(agent.next_wakeup(), at(11s + 500ms));
  EXPECT_EQ(only<Command>(deliver(agent, world_state(1, {{101, 500, 0}}), at(11s + 300ms))).size(),
            1u);

  auto roster = roster_of(2);
  roster[0].active_from = 1;
  give(agent, mission_part(1001, MissionState::kRunning, roster), at(12s));
  EXPECT_TRUE(only<Hello>(advance(agent, at(13s))).empty());
  EXPECT_EQ(agent.phase(), AgentPhase::kRunning);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 2) << "and has lost nothing";
}

}  // namespace
}  // namespace ergocast
