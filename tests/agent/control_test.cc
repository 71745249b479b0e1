// SPDX-License-Identifier: BSD-3-Clause
// The control step: when an agent samples, sends and answers, in lockstep and in real time.
#include "core/law/control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

// ---- the control step ----

TEST(AgentTick, FirstSampleIsWhereItStandsAtTheStart) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const auto sent = only<Contribution>(deliver(agent, world_state(0, {{100, 500, 0}})));
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].steps, 1);
  EXPECT_EQ(sent[0].elapsed_s, 0.1);
  EXPECT_EQ(sent[0].mode_count, 20);
  EXPECT_EQ(sent[0].author(), author_of(0));
  const Contribution expected = block_of(mission, 0, {{100, 500, 0}}, 1);
  EXPECT_EQ(sent[0].sums, expected.sums);
  EXPECT_EQ(sent[0].next_broadcast_tick, 1);
}

TEST(AgentTick, CommandIsTheControllersForTheTeamsCoverage) {
  Mission mission = small_mission(2);
  mission.law.noise_intensity = 0.5;
  mission.law.contraction_gain_per_s = 1e-3;
  mission.law.epsilon = 1e-4;
  Agent agent = running_agent(mission);
  const Contribution theirs = block_of(mission, 1, {{700, 900, 0}}, 1);
  give(agent, theirs, at(0s));
  const auto commands =
      only<Command>(deliver(agent, world_state(0, {{100, 500, 0}, {700, 900, 0}})));
  ASSERT_EQ(commands.size(), 1u);

  CoverageTable table(mission.basis, mission.timing.dt_s);
  const BasisAt here({100, 500, 0}, mission.domain, mission.basis);
  table.add_sample(author_of(0), here);
  table.merge(theirs, 10);
  Coefficients team = Coefficients::Zero(20);
  table.average(team);
  Controller controller(mission);
  controller.set_coverage(team);
  const Eigen::Vector3d expected = controller.command(0, 0, {100, 500, 0}, here);
  EXPECT_EQ(commands[0].velocity_mps, expected) << "bit for bit";
  EXPECT_EQ(commands[0].velocity_mps.z(), 0);
  EXPECT_EQ(commands[0].position_m, Eigen::Vector3d(100, 500, 0));
  EXPECT_EQ(commands[0].header.tick, 0);
  EXPECT_EQ(commands[0].header.sender, 0);
  EXPECT_EQ(commands[0].header.incarnation, incarnation_of(0));
}

TEST(AgentTick, SendsOnTheBusesOfTheProtocol) {
  Agent agent = running_agent(small_mission(1));
  for (const Outgoing& outgoing : deliver(agent, world_state(0, {{100, 500, 0}}))) {
    const bool command = std::holds_alternative<Command>(outgoing.message);
    EXPECT_EQ(outgoing.bus, command ? Bus::kCommand : Bus::kSwarm);
  }
}

TEST(AgentTick, ContributionsAreCumulative) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  std::vector<Eigen::Vector3d> path;
  for (Tick tick = 0; tick < 5; ++tick) {
    path.push_back({100.0 + 7 * static_cast<double>(tick), 500, 0});
    const auto sent = only<Contribution>(deliver(agent, world_state(tick, {path.back()})));
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_EQ(sent[0].steps, tick + 1);
    EXPECT_EQ(sent[0].sums, block_of(mission, 0, path, 0).sums);
  }
}

TEST(AgentTick, WhereAveragesAreSentAddsWhatItHasGainedSinceTheLastBroadcast) {
  Mission mission = two_block_mission(1);
  mission.timing.broadcast_period_ticks = 3;
  mission.timing.contribution_encoding = ContributionEncoding::kFixed16;
  Agent agent = running_agent(mission);
  Contribution last;
  for (Tick tick = 0; tick < 12; ++tick) {
    const auto sent = only<Contribution>(
        deliver(agent, world_state(tick, {{100 + 50 * static_cast<double>(tick), 500, 0}})));
    if (sent.empty()) continue;
    ASSERT_EQ(sent.size(), 1u) << "all 144 modes in one";
    EXPECT_EQ(sent[0].encoding, ContributionEncoding::kFixed16);
    EXPECT_EQ(sent[0].gained_steps, sent[0].steps - last.steps);
    for (std::size_t k = 0; k < 144; ++k) {
      ASSERT_EQ(sent[0].gains[k], sent[0].sums[k] - last.sums.data()[k]) << k;
    }
    last = sent[0];
  }
  EXPECT_GT(last.steps, 6);
}

TEST(AgentTick, BroadcastsOncePerPeriodAndNamesTheNextTimeTruthfully) {
  Mission mission = small_mission(4);
  mission.timing.broadcast_period_ticks = 4;
  mission.timing.pace = Pace::kRealtime;
  std::vector<Tick> second_broadcast;
  for (AgentId id = 0; id < 4; ++id) {
    Agent agent = running_agent(mission, id);
    Tick announced = 0;
    for (Tick tick = 0; tick < 40; ++tick) {
      const auto sent = only<Contribution>(
          deliver(agent, world_state(tick, {{1, 1, 0}, {2, 2, 0}, {3, 3, 0}, {4, 4, 0}})));
      ASSERT_EQ(sent.size(), tick == announced ? 1u : 0u) << "agent " << id << " at " << tick;
      if (sent.empty()) continue;
      if (tick == 0) second_broadcast.push_back(sent[0].next_broadcast_tick);
      EXPECT_LE(sent[0].next_broadcast_tick, tick + 4);
      if (tick > 0) {
        EXPECT_EQ(sent[0].next_broadcast_tick, tick + 4);
      }
      announced = sent[0].next_broadcast_tick;
    }
  }
  std::sort(second_broadcast.begin(), second_broadcast.end());
  EXPECT_EQ(second_broadcast, (std::vector<Tick>{1, 2, 3, 4})) << "spread over the period";
}

/// The blocks that an agent sends at each tick, and when it sends them again.
struct Sent {
  int block;
  Tick next;
  bool operator==(const Sent&) const = default;
};
std::map<Tick, std::vector<Sent>> sent_by(const Mission& mission, AgentId id, Tick ticks) {
  Agent agent = running_agent(mission, id);
  std::map<Tick, std::vector<Sent>> all;
  for (Tick tick = 0; tick < ticks; ++tick) {
    const Outbox out =
        deliver(agent, world_state(tick, {{1, 1, 0}, {2, 2, 0}, {3, 3, 0}, {4, 4, 0}}));
    for (const Contribution& sent : only<Contribution>(out)) {
      all[tick].push_back({sent.block, sent.next_broadcast_tick});
      EXPECT_EQ(sent.steps, tick + 1);
    }
  }
  return all;
}

TEST(AgentTick, SendsHighModesEverySoManyPeriodsAndNamesTheirNextTimeTruthfully) {
  Mission mission = two_block_mission(4);
  mission.timing.broadcast_period_ticks = 4;
  mission.timing.high_mode_period_factor = 3;
  mission.timing.pace = Pace::kRealtime;
  std::vector<Tick> second_broadcast;
  for (AgentId id = 0; id < 4; ++id) {
    std::map<int, Tick> announced;
    for (const auto& [tick, blocks] : sent_by(mission, id, 60)) {
      ASSERT_EQ(blocks.front().block, 0) << "high modes go along with low ones";
      for (const auto& [block, next] : blocks) {
        EXPECT_EQ(announced[block], tick);
        EXPECT_LE(next, tick + (block == 0 ? 4 : 12));
        if (tick > 0) {
          EXPECT_EQ(next, tick + (block == 0 ? 4 : 12));
        }
        if (tick == 0 && block == 1) second_broadcast.push_back(next);
        announced[block] = next;
      }
    }
    EXPECT_GE(announced[0], 60);
    EXPECT_GE(announced[1], 60);
  }
  EXPECT_EQ(second_broadcast, (std::vector<Tick>{12, 1, 6, 11})) << "spread over three periods";
}

TEST(AgentTick, SendsAllModesAsOftenWhereThereAreOnlyLowOnes) {
  Mission rare = small_mission(4);
  rare.timing.broadcast_period_ticks = 4;
  Mission usual = rare;
  rare.timing.high_mode_period_factor = 3;
  EXPECT_EQ(sent_by(rare, 2, 40), sent_by(usual, 2, 40));
}

TEST(AgentInRealTime, WithoutNewTicksSendsAllModes) {
  Mission mission = two_block_mission(1);
  mission.timing.broadcast_period_ticks = 4;
  mission.timing.high_mode_period_factor = 3;
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  for (Tick tick = 0; tick < 6; ++tick) deliver(agent, world_state(tick, {{1, 1, 0}}));
  const auto sent = only<Contribution>(advance(agent, at(2s)));
  ASSERT_EQ(sent.size(), 2u);
  for (const Contribution& block : sent) EXPECT_EQ(block.steps, 6);
  EXPECT_EQ(sent[0].next_broadcast_tick, 8);
  EXPECT_EQ(sent[1].next_broadcast_tick, 12);
}

TEST(AgentTick, EndsByItselfAtThePlansLastTick) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const Outbox out = deliver(agent, world_state(mission.timing.tick_count, {{100, 500, 0}}));
  EXPECT_TRUE(agent.finished());
  EXPECT_FALSE(agent.failed());
  EXPECT_EQ(agent.reason(), "mission complete");
  EXPECT_TRUE(only<Command>(out).empty());
  EXPECT_TRUE(only<Contribution>(out).empty());
}

// ---- lockstep ----

TEST(AgentInLockstep, WaitsForHighModesOnlyWhenTheyAreDue) {
  Mission mission = two_block_mission(2);
  mission.timing.high_mode_period_factor = 3;
  Agent agent = running_agent(mission), other = running_agent(mission, 1);
  for (Tick tick = 0; tick < 9; ++tick) {
    const WorldState world = world_state(tick, {{100, 500, 0}, {200, 500, 0}});
    const auto sent = only<Contribution>(deliver(other, world));
    bool answered = !only<Command>(deliver(agent, world)).empty();
    ASSERT_FALSE(answered) << "low ones are due at " << tick;
    ASSERT_EQ(sent.size(), tick == 0 || tick % 3 == 1 ? 2u : 1u) << tick;
    for (const Contribution& block : sent) {
      EXPECT_FALSE(answered) << tick;
      answered = !only<Command>(deliver(agent, block)).empty();
      deliver(other, world);  // it answers, too
    }
    EXPECT_TRUE(answered) << tick;
    for (const Contribution& block : only<Contribution>(deliver(agent, world)))
      deliver(other, block);
  }
}

TEST(AgentInLockstep, AnswersOnlyWhenEveryDueBlockOfEveryTeammateIsThere) {
  const Mission mission = two_block_mission(3);
  Agent agent = running_agent(mission);
  const std::vector<Eigen::Vector3d> places{{100, 500, 0}, {200, 500, 0}, {300, 500, 0}};
  const auto one = blocks_of(mission, author_of(1), {places[1]}, 1);
  const auto two = blocks_of(mission, author_of(2), {places[2]}, 1);
  ASSERT_EQ(one.size(), 2u);

  EXPECT_TRUE(only<Command>(deliver(agent, world_state(0, places))).empty());
  EXPECT_TRUE(only<Command>(deliver(agent, two[1])).empty());
  EXPECT_TRUE(only<Command>(deliver(agent, one[0])).empty());
  EXPECT_TRUE(only<Command>(deliver(agent, two[0])).empty());
  const auto answer = only<Command>(deliver(agent, one[1]));
  ASSERT_EQ(answer.size(), 1u);
  EXPECT_EQ(answer[0].header.tick, 0);

  // The next tick needs their next blocks.
  EXPECT_TRUE(only<Command>(deliver(agent, world_state(1, places))).empty());
}

TEST(AgentInLockstep, StatusNamesTheTeammateItWaitsFor) {
  const Mission mission = small_mission(3);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, {{200, 500, 0}}, 1), at(0s));
  deliver(agent, world_state(0, {{100, 500, 0}, {200, 500, 0}, {300, 500, 0}}));
  const AgentStatus waiting = status_after(agent, at(0s));
  EXPECT_EQ(waiting.waiting_for, 2);
  EXPECT_EQ(waiting.answered_tick, -1);
  deliver(agent, block_of(mission, 2, {{300, 500, 0}}, 1), at(500ms));
  const AgentStatus answered = status_after(agent, at(500ms));
  EXPECT_EQ(answered.waiting_for, kUnassigned);
  EXPECT_EQ(answered.answered_tick, 0);
}

TEST(AgentInLockstep, StatusNamesTheWorldOnceItHasBeenSilentForThreeSeconds) {
  Agent agent = running_agent(small_mission(2));
  const auto world = [] { return world_state(0, {{100, 500, 0}, {200, 500, 0}}); };
  const WorldState first = world();
  deliver(agent, first, at(5s));
  EXPECT_EQ(status_after(agent, at(5s)).waiting_for, 1) << "whose block the tick waits for";
  EXPECT_EQ(status_after(agent, at(7499ms)).waiting_for, 1) << "not yet";
  EXPECT_EQ(status_after(agent, at(8s)).waiting_for, kWorld) << "whatever else is missing";
  deliver(agent, first, at(8900ms));
  EXPECT_EQ(status_after(agent, at(9s)).waiting_for, kWorld) << "any process may have recorded it";
  deliver(agent, world(), at(10s));
  EXPECT_EQ(status_after(agent, at(10s)).waiting_for, 1) << "a repeat of its own is a word, too";
}

TEST(AgentInLockstep, DoesNotWaitForWhatIsNotDue) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 1, {{200, 500, 0}}, 3), at(0s));
  for (Tick tick = 0; tick < 3; ++tick) {
    EXPECT_EQ(only<Command>(deliver(agent, world_state(tick, {{100, 500, 0}}))).size(), 1u) << tick;
  }
  EXPECT_TRUE(only<Command>(deliver(agent, world_state(3, {{100, 500, 0}}))).empty());
}

TEST(AgentInLockstep, DoesNotWaitForMembersThatHaveLeftOrAreYetToCome) {
  const Mission mission = small_mission(3);
  announce(mission);
  Agent agent(identity_of(0));
  std::vector<RosterEntry> roster = roster_of(3);
  roster[1].active_until = 0;
  roster[2].active_from = 5;
  give(agent, mission_part(0, MissionState::kRunning, roster), at(0s));
  EXPECT_EQ(only<Command>(deliver(agent, world_state(0, {{100, 500, 0}}))).size(), 1u);
  EXPECT_TRUE(only<Command>(deliver(agent, world_state(5, {{100, 500, 0}}))).empty());
}

TEST(AgentInLockstep, GoesOnWhenARosterRevisionRemovesTheOneItWaitedFor) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  EXPECT_TRUE(only<Command>(deliver(agent, world_state(0, {{100, 500, 0}}))).empty());
  std::vector<RosterEntry> roster = roster_of(2);
  roster[1].active_until = 0;
  EXPECT_EQ(only<Command>(deliver(agent, mission_part(1, MissionState::kRunning, roster))).size(),
            1u);
}

TEST(AgentInLockstep, ARepeatedTickIsAnsweredAgainWithTheSameBlocksAndCommand) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const Outbox first = deliver(agent, world_state(0, {{100, 500, 0}}));
  const Outbox again = deliver(agent, world_state(0, {{100, 500, 0}}), at(20ms));
  ASSERT_EQ(only<Command>(again).size(), 1u);
  EXPECT_EQ(only<Command>(again)[0].velocity_mps, only<Command>(first)[0].velocity_mps);
  EXPECT_EQ(only<Command>(again)[0].header.tick, 0);
  ASSERT_EQ(only<Contribution>(again).size(), 1u);
  EXPECT_EQ(only<Contribution>(again)[0].sums, only<Contribution>(first)[0].sums);
  EXPECT_EQ(only<Contribution>(again)[0].steps, 1) << "a repeat is no new sample";
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 1);
  EXPECT_GT(only<Command>(again)[0].header.sequence, only<Command>(first)[0].header.sequence);
}

TEST(AgentInLockstep, BetweenBroadcastsARepeatEqualsTheLastBroadcast) {
  Mission mission = small_mission(1);
  mission.timing.broadcast_period_ticks = 4;
  Agent agent = running_agent(mission);
  const auto broadcast = only<Contribution>(deliver(agent, world_state(0, {{100, 500, 0}})));
  deliver(agent, world_state(1, {{150, 500, 0}}));
  const auto repeated =
      only<Contribution>(deliver(agent, world_state(1, {{150, 500, 0}}), at(20ms)));
  ASSERT_EQ(repeated.size(), 1u);
  EXPECT_EQ(repeated[0].steps, 1) << "newer sums would make a tick depend on what was lost";
  EXPECT_EQ(repeated[0].sums, broadcast[0].sums);
}

TEST(AgentInLockstep, AReplayedTickIsNotAnsweredAgain) {
  Agent agent = running_agent(small_mission(1));
  const WorldState world = world_state(0, {{100, 500, 0}});
  EXPECT_FALSE(only<Command>(deliver(agent, world)).empty());
  for (int i = 0; i < 10; ++i) {
    const Outbox again = deliver(agent, world, at(20ms));
    EXPECT_TRUE(only<Command>(again).empty() && only<Contribution>(again).empty());
  }
}

TEST(AgentInLockstep, ARepeatedTickThatWaitsRepeatsOnlyTheBlocks) {
  Agent agent = running_agent(small_mission(2));
  deliver(agent, world_state(0, {{100, 500, 0}}));
  const Outbox again = deliver(agent, world_state(0, {{100, 500, 0}}), at(20ms));
  EXPECT_EQ(only<Contribution>(again).size(), 1u);
  EXPECT_TRUE(only<Command>(again).empty());
}

TEST(AgentInLockstep, OldTicksOfTheWorldHaveNoEffect) {
  Agent agent = running_agent(small_mission(1));
  deliver(agent, world_state(0, {{100, 500, 0}}));
  deliver(agent, world_state(1, {{110, 500, 0}}));
  const Outbox out = deliver(agent, world_state(0, {{1900, 500, 0}}));
  EXPECT_TRUE(only<Command>(out).empty());
  EXPECT_TRUE(only<Contribution>(out).empty());
  EXPECT_EQ(agent.tick(), 1);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 2);
}

TEST(AgentInLockstep, LateOldBlocksChangeNothing) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  const Contribution old_block = block_of(mission, 1, {{200, 500, 0}}, 1);
  give(agent, block_of(mission, 1, {{200, 500, 0}, {210, 500, 0}}, 2), at(0s));
  give(agent, old_block, at(0s));
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), 2);
  EXPECT_EQ(status_after(agent, at(0s)).refused, RefusalCounts{}) << "stale is not refused";
}

// ---- real time ----

TEST(AgentInRealTime, AnswersWithWhatItHas) {
  Mission mission = small_mission(4);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  EXPECT_EQ(only<Command>(deliver(agent, world_state(0, {{100, 500, 0}}))).size(), 1u);
}

TEST(AgentInRealTime, CountsTheTicksThatWentByWithoutIt) {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  deliver(agent, world_state(3, {{100, 500, 0}}));
  EXPECT_EQ(status_after(agent, at(0s)).missed_ticks, 0) << "it was not there before";
  deliver(agent, world_state(4, {{100, 500, 0}}));
  deliver(agent, world_state(9, {{100, 500, 0}}));
  EXPECT_EQ(status_after(agent, at(2h)).missed_ticks, 4);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 7) << "and was on a line meanwhile";
}

TEST(AgentInRealTime, TakesTheNewestOfSeveralStatesThatArriveTogether) {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  give(agent, world_state(2, {{300, 500, 0}}), at(0s));
  give(agent, world_state(1, {{200, 500, 0}}), at(0s));
  const auto commands = only<Command>(advance(agent, at(0s)));
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].header.tick, 2);
  EXPECT_EQ(commands[0].position_m.x(), 300);
}

}  // namespace
}  // namespace ergocast
