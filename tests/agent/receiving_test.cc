// SPDX-License-Identifier: BSD-3-Clause
// Which messages an agent accepts, and how its status reports them.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/law/control.h"
#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

// ---- what is refused ----

/// Sends one false contribution and expects: no row, no block, one more refusal for `why`.
void expect_refused(const Contribution& lie, Refusal why) {
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  deliver(agent, world_state(0, {{100, 500, 0}}));
  deliver(agent, lie);
  EXPECT_EQ(agent.coverage()->row_count(), 1u) << "only its own";
  RefusalCounts expected{};
  expected[static_cast<std::size_t>(why)] = 1;
  EXPECT_EQ(status_after(agent, at(0s)).refused, expected);
}

// Its author may know of a new target first; also in lockstep, if its team goes on without us.
TEST(AgentIgnores, ASumThatOnlyANewTargetAllows) {
  for (const Pace pace : {Pace::kLockstep, Pace::kRealtime}) {
    Mission mission = small_mission(2);
    mission.timing.pace = pace;
    Agent agent = running_agent(mission);
    deliver(agent, world_state(0, {{100, 500, 0}}));
    Contribution shifted = block_of(mission, 1, {{200, 500, 0}}, 1);
    shifted.sums.edit()[3] = 0.2;
    deliver(agent, shifted);
    EXPECT_EQ(agent.coverage()->row_count(), 1u) << "only its own";
    EXPECT_EQ(agent.refused()[static_cast<std::size_t>(Refusal::kRange)], 0);
  }
}

TEST(AgentRefuses, UntrueContributionsAndCountsThem) {
  const Mission mission = small_mission(2);
  const Contribution honest = block_of(mission, 1, {{200, 500, 0}}, 1);
  Contribution lie = honest;
  lie.sums.edit()[3] = kNan;
  expect_refused(lie, Refusal::kRange);
  lie = honest;
  lie.sums.edit()[3] = 0.3 * (1 + 1e-8);
  expect_refused(lie, Refusal::kRange);
  lie = honest;
  lie.mode_count = 21;
  expect_refused(lie, Refusal::kRange);
  lie = honest;
  lie.block = 1;
  expect_refused(lie, Refusal::kRange);
  lie = honest;
  lie.header.run = kRun + 1;
  expect_refused(lie, Refusal::kRun);
}

TEST(AgentRefuses, CoverageFromTheFuture) {
  // A lead of a minute is allowed, because clocks of several hosts may differ. A larger one would
  // never be replaced.
  const Mission mission = small_mission(2);
  Contribution future = block_of(mission, 1, {{200, 500, 0}}, 1);
  const auto claim = [&future](std::int64_t steps) {
    future.steps = steps;
    future.elapsed_s = 0.1 * static_cast<double>(steps);
    std::ranges::fill(future.sums.edit(), 0);
    future.sums.edit()[0] = future.elapsed_s;
  };
  claim(602);
  expect_refused(future, Refusal::kRange);
  claim(std::numeric_limits<std::int64_t>::max());
  expect_refused(future, Refusal::kRange);
  Agent agent = running_agent(mission);
  deliver(agent, world_state(0, {{100, 500, 0}}));
  claim(601);
  deliver(agent, future);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), 601);
}

TEST(AgentRefuses, NothingForItsStepsBeforeItKnowsTheTick) {
  // A late joiner receives the others' steps before the world's tick.
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.tick_count = 1000;
  const auto row_of_1 = block_of(mission, 1, std::vector<Eigen::Vector3d>(700, {200, 500, 0}), 700);
  Agent agent = running_agent(mission);
  deliver(agent, row_of_1);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), std::nullopt)
      << "it may be from the future";
  EXPECT_EQ(agent.refused(), RefusalCounts{}) << "or not";
  deliver(agent, world_state(699, {{100, 500, 0}}));
  deliver(agent, row_of_1);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), 700);
}

TEST(AgentRefuses, APlaceOutsideTheDomain) {
  Agent agent = running_agent(small_mission(1));
  const Outbox out = deliver(agent, world_state(0, {{-1, 500, 0}}));
  EXPECT_TRUE(only<Command>(out).empty());
  EXPECT_EQ(agent.tick(), -1);
  EXPECT_EQ(status_after(agent, at(0s)).refused[static_cast<std::size_t>(Refusal::kRange)], 1);
}

TEST(AgentRefuses, AndShowsWhatTheTransportRefused) {
  Agent agent = running_agent(small_mission(1));
  agent.count_refused(Refusal::kTag);
  agent.count_refused(Refusal::kTag);
  agent.count_refused(Refusal::kSize);
  agent.set_kernel_drops(8);
  const AgentStatus status = status_after(agent, at(0s));
  EXPECT_EQ(status.refused, (RefusalCounts{1, 0, 2, 0, 0, 0}));
  EXPECT_EQ(status.kernel_drops, 8);
}

TEST(AgentRefuses, ItsOwnEcho) {
  // Multicast returns an agent's own messages to it.
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const auto sent = only<Contribution>(deliver(agent, world_state(0, {{100, 500, 0}})));
  deliver(agent, sent.at(0));
  const AgentStatus status = status_after(agent, at(0s));
  EXPECT_EQ(status.contributions_received, 0);
  EXPECT_EQ(agent.coverage()->row_count(), 1u);
}

// ---- what the status counts ----

TEST(AgentStatusReport, CountsGapsInATeammatesSequenceAsLost) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  Contribution theirs = block_of(mission, 1, {{200, 500, 0}}, 1);
  for (const std::int64_t sequence : {11, 12, 15, 14}) {
    theirs.header.sequence = sequence;
    give(agent, theirs, at(0s));
  }
  const AgentStatus status = status_after(agent, at(0s));
  EXPECT_EQ(status.contributions_received, 4);
  EXPECT_EQ(status.contributions_lost, 1) << "13; what came before 11 was before its time";
}

TEST(AgentStatusReport, MeasuresStalenessByTheOldestTeammate) {
  Mission mission = small_mission(3);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  deliver(agent, world_state(0, {{100, 500, 0}}));
  give(agent, block_of(mission, 1, {{200, 500, 0}}, 1), at(0s));
  give(agent, block_of(mission, 2, {{300, 500, 0}}, 1), at(0s));
  deliver(agent, world_state(9, {{100, 500, 0}}));
  give(agent, block_of(mission, 1, {{200, 500, 0}, {200, 500, 0}, {200, 500, 0}}, 3), at(0s));
  // The last message of teammate 2 is of tick 0. The number of samples does not matter: a teammate
  // that was delayed once does not stay out of date.
  EXPECT_DOUBLE_EQ(status_after(agent, at(0s)).max_staleness_s, 0.9);
}

TEST(AgentStatusReport, ShowsPhiSquaredOfTheTeamAsItKnowsIt) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  deliver(agent, world_state(0, {{100, 500, 0}}));
  const double expected =
      Controller(mission).metric(basis_values({100, 500, 0}, mission.domain, mission.basis));
  EXPECT_NEAR(status_after(agent, at(0s)).ergodic_metric, expected, 1e-14 * expected);
}

TEST(AgentStatusReport, ComesTwiceASecondAndOnceAMissionSecond) {
  Agent agent = running_agent(small_mission(1));
  EXPECT_EQ(only<AgentStatus>(advance(agent, at(0s))).size(), 1u);
  EXPECT_TRUE(only<AgentStatus>(advance(agent, at(499ms))).empty());
  EXPECT_EQ(agent.next_wakeup(), at(500ms));
  EXPECT_EQ(only<AgentStatus>(advance(agent, at(500ms))).size(), 1u);
  int statuses = 0;
  for (Tick tick = 0; tick < 40; ++tick) {
    statuses += static_cast<int>(
        only<AgentStatus>(deliver(agent, world_state(tick, {{100, 500, 0}}), at(501ms))).size());
  }
  EXPECT_EQ(statuses, 4) << "40 ticks of 0.1 s without any time on the clock";
}

TEST(AgentStatusReport, CountsItsOwnMessages) {
  Agent agent = running_agent(small_mission(1));
  std::size_t sent = advance(agent, at(0s)).size();
  sent += deliver(agent, world_state(0, {{100, 500, 0}})).size();
  sent += deliver(agent, world_state(0, {{100, 500, 0}})).size();
  const AgentStatus status = status_after(agent, at(0s));
  EXPECT_EQ(status.messages_sent, static_cast<std::int64_t>(sent));
  EXPECT_EQ(status.messages_received, 3) << "the mission and two states";
}

TEST(AgentStatusReport, SequencesGrowByOneOnEachBus) {
  Agent agent = running_agent(small_mission(1));
  std::int64_t last[kBusCount] = {0, 0, 0};
  for (Tick tick = 0; tick < 20; ++tick) {
    for (const Outgoing& out :
         deliver(agent, world_state(tick / 2, {{100, 500, 0}}), at(tick * 200ms))) {
      EXPECT_EQ(header_of(out.message).sequence, ++last[static_cast<std::size_t>(out.bus)]);
    }
  }
  EXPECT_GT(last[static_cast<std::size_t>(Bus::kSwarm)], 20);
  EXPECT_GE(last[static_cast<std::size_t>(Bus::kCommand)], 20);
}

TEST(AgentRefuses, CoverageInAnotherEncodingThanThePlan) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  Contribution theirs = block_of(mission, 1, {{700, 900, 0}}, 1);
  theirs.encoding = ContributionEncoding::kFixed16;
  give(agent, theirs, at(0s));
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), std::nullopt);
  EXPECT_EQ(agent.refused()[static_cast<std::size_t>(Refusal::kEncoding)], 1);
}

}  // namespace
}  // namespace ergocast
