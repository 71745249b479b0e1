// One agent, driven by hand: what it says, when it answers, what it refuses, how it ends.
#include "agent/agent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

AgentIdentity identity_of(AgentId id) { return {kRun, id, life_of(id), "here", "1.2.3"}; }

/// 12 × 12 modes: two blocks.
Mission two_block_mission(int agents) {
  Mission mission = small_mission(agents);
  mission.basis.modes_x = mission.basis.modes_y = 12;
  mission.target_coefficients = Coefficients::Zero(12, 12);
  mission.target_coefficients(0, 0) = 1;
  return mission;
}

/// Agent `id` of a team that has been told to run.
Agent running_agent(const Mission& mission, AgentId id = 0) {
  Agent agent(identity_of(id), decoder_of(mission));
  const auto team = static_cast<int>(mission.starts_m.size());
  agent.receive(mission_part(0, MissionState::kRunning, roster_of(team)), at(0s));
  return agent;
}

/// What `author` says after it has been at these places, one a tick.
std::vector<Contribution> blocks_of(const Mission& mission, const Author& author,
                                    const std::vector<Eigen::Vector2d>& path_m,
                                    Tick next_broadcast_tick) {
  CoverageTable table(mission.basis, mission.timing.dt_s);
  for (const Eigen::Vector2d& x_m : path_m) {
    table.add_sample(author, BasisAt(x_m, mission.domain, mission.basis));
  }
  std::vector<Contribution> blocks;
  for (int b = 0; b < table.block_count(); ++b) {
    blocks.push_back(table.block(author, b));
    blocks.back().header.run = kRun;
    blocks.back().header.sequence =
        static_cast<std::int64_t>(path_m.size() - 1) * table.block_count() + b + 1;
    blocks.back().next_broadcast_tick = next_broadcast_tick;
  }
  return blocks;
}

Contribution block_of(const Mission& mission, AgentId id, const std::vector<Eigen::Vector2d>& path_m,
                      Tick next_broadcast_tick) {
  return blocks_of(mission, author_of(id), path_m, next_broadcast_tick).front();
}

Outbox tell(Agent& agent, const Message& message, Instant now = at(0s)) {
  agent.receive(message, now);
  return advance(agent, now);
}

/// The agent's status, which is never older than the next half second.
AgentStatus status_after(Agent& agent, Instant now) {
  const auto statuses = only<AgentStatus>(advance(agent, now + 1h));
  EXPECT_EQ(statuses.size(), 1u);
  return statuses.empty() ? AgentStatus{} : statuses.back();
}

// ---- joining -------------------------------------------------------------------------------------

TEST(AgentJoining, AsksFourTimesASecondUntilTheRosterNamesIt) {
  Agent agent(identity_of(3), decoder_of(small_mission(4)));
  const auto hellos = only<Hello>(advance(agent, at(0s)));
  ASSERT_EQ(hellos.size(), 1u);
  EXPECT_EQ(hellos[0].requested_id, 3);
  EXPECT_EQ(hellos[0].header.incarnation, life_of(3));
  EXPECT_EQ(hellos[0].host, "here");
  EXPECT_EQ(hellos[0].version, "1.2.3");
  EXPECT_TRUE(advance(agent, at(249ms)).empty());
  EXPECT_EQ(agent.next_wakeup(), at(250ms));
  EXPECT_EQ(only<Hello>(advance(agent, at(250ms))).size(), 1u);

  // A roster that names only others changes nothing.
  EXPECT_EQ(only<Hello>(tell(agent, mission_part(0, MissionState::kWaiting, roster_of(3)), at(500ms)))
                .size(), 1u);
  EXPECT_EQ(agent.phase(), AgentPhase::kJoining);

  tell(agent, mission_part(1, MissionState::kWaiting, roster_of(4)), at(600ms));
  EXPECT_EQ(agent.phase(), AgentPhase::kWaiting);
  EXPECT_TRUE(only<Hello>(advance(agent, at(10s))).empty());
}

TEST(AgentJoining, TakesTheNumberThatTheRosterGivesItsIncarnation) {
  AgentIdentity anybody = identity_of(0);
  anybody.requested_id = kUnassigned;
  anybody.incarnation = life_of(2);
  Agent agent(anybody, decoder_of(small_mission(3)));
  EXPECT_EQ(agent.id(), kUnassigned);
  agent.receive(mission_part(0, MissionState::kRunning, roster_of(3)), at(0s));
  EXPECT_EQ(agent.id(), 2);
}

TEST(AgentJoining, DoesNothingInTheWorldBeforeTheMissionRuns) {
  const Mission mission = small_mission(1);
  Agent agent(identity_of(0), decoder_of(mission));
  agent.receive(mission_part(0, MissionState::kWaiting, roster_of(1)), at(0s));
  const Outbox waiting = tell(agent, world_state(0, {{100, 500}}));
  EXPECT_TRUE(only<Command>(waiting).empty());
  EXPECT_TRUE(only<Contribution>(waiting).empty());
  EXPECT_EQ(agent.tick(), -1);
  const Outbox running = tell(agent, mission_part(1, MissionState::kRunning, roster_of(1)));
  EXPECT_EQ(only<Command>(running).size(), 1u);
}

TEST(AgentJoining, AnAgentWithoutARunJoinsTheFirstItHearsOf) {
  AgentIdentity late = identity_of(0);
  late.run = 0;
  Agent agent(late, decoder_of(small_mission(1)));
  agent.receive(mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  EXPECT_EQ(agent.run(), kRun);
  MissionPart other = mission_part(9, MissionState::kEnded, {});
  other.header.run = kRun + 1;
  agent.receive(other, at(0s));
  EXPECT_FALSE(agent.finished());
}

TEST(AgentJoining, StopsAndSaysWhyIfAnotherProcessLivesUnderItsNumber) {
  Agent agent(identity_of(1), decoder_of(small_mission(2)));
  AgentStatus rival = status_of(1, 1);
  rival.header.incarnation = 77;
  for (std::int64_t sequence = 1; sequence <= 3; ++sequence) {
    EXPECT_FALSE(agent.finished());
    rival.header.sequence = sequence;
    agent.receive(rival, at(0s));
  }
  EXPECT_TRUE(agent.finished());
  EXPECT_TRUE(agent.failed());
  EXPECT_EQ(agent.reason(), "agent 1 is already running on elsewhere: choose another id, or none");
  EXPECT_TRUE(advance(agent, at(1h)).empty()) << "it must not speak under a number that is taken";
}

TEST(AgentJoining, RepeatedOldOrForeignStatusesDoNotScareIt) {
  Agent agent(identity_of(1), decoder_of(small_mission(2)));
  AgentStatus rival = status_of(1, 5);
  rival.header.incarnation = 77;
  for (const std::int64_t sequence : {5, 5, 4, 3, 5, 6, 6}) {
    rival.header.sequence = sequence;
    agent.receive(rival, at(0s));
  }
  for (int i = 0; i < 10; ++i) agent.receive(status_of(0, i), at(0s));
  EXPECT_FALSE(agent.finished());
}

TEST(AgentJoining, AnAgentThatAskedForNoNumberHasNoRival) {
  AgentIdentity anybody = identity_of(1);
  anybody.requested_id = kUnassigned;
  Agent agent(anybody, decoder_of(small_mission(2)));
  for (int i = 1; i < 10; ++i) agent.receive(status_of(0, i), at(0s));
  EXPECT_FALSE(agent.finished());
}

TEST(AgentJoining, OnceAdmittedItDoesNotGiveWay) {
  Agent agent = running_agent(small_mission(2));
  AgentStatus rival = status_of(0, 1);
  rival.header.incarnation = 77;
  for (rival.header.sequence = 1; rival.header.sequence < 10; ++rival.header.sequence) {
    agent.receive(rival, at(0s));
  }
  EXPECT_FALSE(agent.finished());
}

TEST(AgentJoining, RefusesAPlanItCannotReadAndSaysWhatToDo) {
  Agent agent(identity_of(0), [](auto) { return std::nullopt; });
  agent.receive(mission_part(0, MissionState::kWaiting, roster_of(1)), at(0s));
  EXPECT_TRUE(agent.finished());
  EXPECT_TRUE(agent.failed());
  EXPECT_EQ(agent.reason(),
            "the mission plan is not readable by version 1.2.3: run the same version everywhere");
}

// ---- the control step ----------------------------------------------------------------------------

TEST(AgentTick, FirstSampleIsWhereItStandsAtTheStart) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const auto said = only<Contribution>(tell(agent, world_state(0, {{100, 500}})));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].steps, 1);
  EXPECT_EQ(said[0].elapsed_s, 0.1);
  EXPECT_EQ(said[0].mode_count, 20);
  EXPECT_EQ(said[0].author(), author_of(0));
  const Contribution expected = block_of(mission, 0, {{100, 500}}, 1);
  EXPECT_EQ(said[0].sums, expected.sums);
  EXPECT_EQ(said[0].next_broadcast_tick, 1);
}

TEST(AgentTick, CommandIsTheControllersForTheTeamsCoverage) {
  Mission mission = small_mission(2);
  mission.law.noise_intensity = 0.5;
  mission.law.contraction_gain_per_s = 1e-3;
  mission.law.epsilon = 1e-4;
  Agent agent = running_agent(mission);
  const Contribution theirs = block_of(mission, 1, {{700, 900}}, 1);
  agent.receive(theirs, at(0s));
  const auto commands = only<Command>(tell(agent, world_state(0, {{100, 500}, {700, 900}})));
  ASSERT_EQ(commands.size(), 1u);

  CoverageTable table(mission.basis, mission.timing.dt_s);
  const BasisAt here({100, 500}, mission.domain, mission.basis);
  table.add_sample(author_of(0), here);
  table.merge(theirs, 10);
  Coefficients team = Coefficients::Zero(5, 4);
  table.average(team);
  const Eigen::Vector2d expected = Controller(mission).command(0, 0, {100, 500}, here, team);
  EXPECT_EQ(commands[0].velocity_mps.head<2>(), expected) << "bit for bit";
  EXPECT_EQ(commands[0].velocity_mps.z(), 0);
  EXPECT_EQ(commands[0].position_m, Eigen::Vector3d(100, 500, 0));
  EXPECT_EQ(commands[0].header.tick, 0);
  EXPECT_EQ(commands[0].header.sender, 0);
  EXPECT_EQ(commands[0].header.incarnation, life_of(0));
}

TEST(AgentTick, SpeaksOnTheBusesOfTheProtocol) {
  Agent agent = running_agent(small_mission(1));
  for (const Outgoing& outgoing : tell(agent, world_state(0, {{100, 500}}))) {
    const bool command = std::holds_alternative<Command>(outgoing.message);
    EXPECT_EQ(outgoing.bus, command ? Bus::kCommand : Bus::kSwarm);
  }
}

TEST(AgentTick, ContributionsAreCumulative) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  std::vector<Eigen::Vector2d> path;
  for (Tick tick = 0; tick < 5; ++tick) {
    path.push_back({100.0 + 7 * static_cast<double>(tick), 500});
    const auto said = only<Contribution>(tell(agent, world_state(tick, {path.back()})));
    ASSERT_EQ(said.size(), 1u);
    EXPECT_EQ(said[0].steps, tick + 1);
    EXPECT_EQ(said[0].sums, block_of(mission, 0, path, 0).sums);
  }
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
      const auto said = only<Contribution>(
          tell(agent, world_state(tick, {{1, 1}, {2, 2}, {3, 3}, {4, 4}})));
      ASSERT_EQ(said.size(), tick == announced ? 1u : 0u) << "agent " << id << " at " << tick;
      if (said.empty()) continue;
      if (tick == 0) second_broadcast.push_back(said[0].next_broadcast_tick);
      EXPECT_LE(said[0].next_broadcast_tick, tick + 4);
      if (tick > 0) {
        EXPECT_EQ(said[0].next_broadcast_tick, tick + 4);
      }
      announced = said[0].next_broadcast_tick;
    }
  }
  std::sort(second_broadcast.begin(), second_broadcast.end());
  EXPECT_EQ(second_broadcast, (std::vector<Tick>{1, 2, 3, 4})) << "spread over the period";
}

TEST(AgentTick, EndsByItselfAtThePlansLastTick) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const Outbox out = tell(agent, world_state(mission.timing.tick_count, {{100, 500}}));
  EXPECT_TRUE(agent.finished());
  EXPECT_FALSE(agent.failed());
  EXPECT_EQ(agent.reason(), "mission complete");
  EXPECT_TRUE(only<Command>(out).empty());
  EXPECT_TRUE(only<Contribution>(out).empty());
}

// ---- lockstep ------------------------------------------------------------------------------------

TEST(AgentInLockstep, AnswersOnlyWhenEveryDueBlockOfEveryTeammateIsThere) {
  const Mission mission = two_block_mission(3);
  Agent agent = running_agent(mission);
  const std::vector<Eigen::Vector2d> places{{100, 500}, {200, 500}, {300, 500}};
  const auto one = blocks_of(mission, author_of(1), {places[1]}, 1);
  const auto two = blocks_of(mission, author_of(2), {places[2]}, 1);
  ASSERT_EQ(one.size(), 2u);

  EXPECT_TRUE(only<Command>(tell(agent, world_state(0, places))).empty());
  EXPECT_TRUE(only<Command>(tell(agent, two[1])).empty());
  EXPECT_TRUE(only<Command>(tell(agent, one[0])).empty());
  EXPECT_TRUE(only<Command>(tell(agent, two[0])).empty());
  const auto answer = only<Command>(tell(agent, one[1]));
  ASSERT_EQ(answer.size(), 1u);
  EXPECT_EQ(answer[0].header.tick, 0);

  // The next tick needs their next blocks.
  EXPECT_TRUE(only<Command>(tell(agent, world_state(1, places))).empty());
}

TEST(AgentInLockstep, StatusNamesTheTeammateItWaitsFor) {
  const Mission mission = small_mission(3);
  Agent agent = running_agent(mission);
  agent.receive(block_of(mission, 1, {{200, 500}}, 1), at(0s));
  tell(agent, world_state(0, {{100, 500}, {200, 500}, {300, 500}}));
  EXPECT_EQ(status_after(agent, at(0s)).waiting_for, 2);
  EXPECT_EQ(status_after(agent, at(2h)).answered_tick, -1);
  tell(agent, block_of(mission, 2, {{300, 500}}, 1), at(4h));
  EXPECT_EQ(status_after(agent, at(4h)).waiting_for, kUnassigned);
  EXPECT_EQ(status_after(agent, at(6h)).answered_tick, 0);
}

TEST(AgentInLockstep, DoesNotWaitForWhatIsNotDue) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  agent.receive(block_of(mission, 1, {{200, 500}}, 3), at(0s));
  for (Tick tick = 0; tick < 3; ++tick) {
    EXPECT_EQ(only<Command>(tell(agent, world_state(tick, {{100, 500}}))).size(), 1u) << tick;
  }
  EXPECT_TRUE(only<Command>(tell(agent, world_state(3, {{100, 500}}))).empty());
}

TEST(AgentInLockstep, DoesNotWaitForMembersWhoHaveLeftOrAreYetToCome) {
  const Mission mission = small_mission(3);
  Agent agent(identity_of(0), decoder_of(mission));
  std::vector<RosterEntry> roster = roster_of(3);
  roster[1].active_until = 0;
  roster[2].active_from = 5;
  agent.receive(mission_part(0, MissionState::kRunning, roster), at(0s));
  EXPECT_EQ(only<Command>(tell(agent, world_state(0, {{100, 500}}))).size(), 1u);
  EXPECT_TRUE(only<Command>(tell(agent, world_state(5, {{100, 500}}))).empty());
}

TEST(AgentInLockstep, GoesOnWhenARosterRevisionRemovesTheOneItWaitedFor) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  EXPECT_TRUE(only<Command>(tell(agent, world_state(0, {{100, 500}}))).empty());
  std::vector<RosterEntry> roster = roster_of(2);
  roster[1].active_until = 0;
  EXPECT_EQ(only<Command>(tell(agent, mission_part(1, MissionState::kRunning, roster))).size(), 1u);
}

TEST(AgentInLockstep, ARepeatedTickIsAnsweredAgainWithTheSameBlocksAndCommand) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const Outbox first = tell(agent, world_state(0, {{100, 500}}));
  const Outbox again = tell(agent, world_state(0, {{100, 500}}), at(20ms));
  ASSERT_EQ(only<Command>(again).size(), 1u);
  EXPECT_EQ(only<Command>(again)[0].velocity_mps, only<Command>(first)[0].velocity_mps);
  EXPECT_EQ(only<Command>(again)[0].header.tick, 0);
  ASSERT_EQ(only<Contribution>(again).size(), 1u);
  EXPECT_EQ(only<Contribution>(again)[0].sums, only<Contribution>(first)[0].sums);
  EXPECT_EQ(only<Contribution>(again)[0].steps, 1) << "a repeat is no new sample";
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 1);
  EXPECT_GT(only<Command>(again)[0].header.sequence, only<Command>(first)[0].header.sequence);
}

TEST(AgentInLockstep, BetweenBroadcastsARepeatSaysWhatTheLastBroadcastSaid) {
  Mission mission = small_mission(1);
  mission.timing.broadcast_period_ticks = 4;
  Agent agent = running_agent(mission);
  const auto broadcast = only<Contribution>(tell(agent, world_state(0, {{100, 500}})));
  tell(agent, world_state(1, {{150, 500}}));
  const auto repeated = only<Contribution>(tell(agent, world_state(1, {{150, 500}}), at(20ms)));
  ASSERT_EQ(repeated.size(), 1u);
  EXPECT_EQ(repeated[0].steps, 1) << "newer sums would make a tick depend on what was lost";
  EXPECT_EQ(repeated[0].sums, broadcast[0].sums);
}

TEST(AgentInLockstep, ARepeatedTickThatWaitsRepeatsOnlyTheBlocks) {
  Agent agent = running_agent(small_mission(2));
  tell(agent, world_state(0, {{100, 500}}));
  const Outbox again = tell(agent, world_state(0, {{100, 500}}), at(20ms));
  EXPECT_EQ(only<Contribution>(again).size(), 1u);
  EXPECT_TRUE(only<Command>(again).empty());
}

TEST(AgentInLockstep, OldTicksOfTheWorldHaveNoEffect) {
  Agent agent = running_agent(small_mission(1));
  tell(agent, world_state(0, {{100, 500}}));
  tell(agent, world_state(1, {{110, 500}}));
  const Outbox out = tell(agent, world_state(0, {{1900, 500}}));
  EXPECT_TRUE(only<Command>(out).empty());
  EXPECT_TRUE(only<Contribution>(out).empty());
  EXPECT_EQ(agent.tick(), 1);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 2);
}

TEST(AgentInLockstep, LateOldBlocksChangeNothing) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  const Contribution old_block = block_of(mission, 1, {{200, 500}}, 1);
  agent.receive(block_of(mission, 1, {{200, 500}, {210, 500}}, 2), at(0s));
  agent.receive(old_block, at(0s));
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), 2);
  EXPECT_EQ(status_after(agent, at(0s)).refused, RefusalCounts{}) << "stale is not refused";
}

// ---- real time -----------------------------------------------------------------------------------

TEST(AgentInRealTime, AnswersWithWhatItHas) {
  Mission mission = small_mission(4);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  EXPECT_EQ(only<Command>(tell(agent, world_state(0, {{100, 500}}))).size(), 1u);
}

TEST(AgentInRealTime, CountsTheTicksThatWentByWithoutIt) {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  tell(agent, world_state(3, {{100, 500}}));
  EXPECT_EQ(status_after(agent, at(0s)).missed_ticks, 0) << "it was not there before";
  tell(agent, world_state(4, {{100, 500}}));
  tell(agent, world_state(9, {{100, 500}}));
  EXPECT_EQ(status_after(agent, at(2h)).missed_ticks, 4);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 3) << "and covers only what it saw";
}

TEST(AgentInRealTime, TakesTheNewestOfSeveralStatesThatArriveTogether) {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  agent.receive(world_state(2, {{300, 500}}), at(0s));
  agent.receive(world_state(1, {{200, 500}}), at(0s));
  const auto commands = only<Command>(advance(agent, at(0s)));
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].header.tick, 2);
  EXPECT_EQ(commands[0].position_m.x(), 300);
}

// ---- what is refused -----------------------------------------------------------------------------

/// Feeds one untrue contribution and expects: no row, no block, one more refusal for `why`.
void expect_refused(const Contribution& lie, Refusal why) {
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  tell(agent, world_state(0, {{100, 500}}));
  tell(agent, lie);
  EXPECT_EQ(agent.coverage()->row_count(), 1u) << "only its own";
  RefusalCounts expected{};
  expected[static_cast<std::size_t>(why)] = 1;
  EXPECT_EQ(status_after(agent, at(0s)).refused, expected);
}

TEST(AgentRefuses, UntrueContributionsAndCountsThem) {
  const Mission mission = small_mission(2);
  const Contribution honest = block_of(mission, 1, {{200, 500}}, 1);
  Contribution lie = honest;
  lie.sums[3] = kNan;
  expect_refused(lie, Refusal::kRange);
  lie = honest;
  lie.sums[3] = 0.1 * (1 + 1e-8);
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
  // A minute of lead is allowed, since clocks of several hosts may differ; beyond it would win for ever.
  const Mission mission = small_mission(2);
  Contribution future = block_of(mission, 1, {{200, 500}}, 1);
  const auto claim = [&future](std::int64_t steps) {
    future.steps = steps;
    future.elapsed_s = 0.1 * static_cast<double>(steps);
    future.sums.fill(0);
    future.sums[0] = future.elapsed_s;
  };
  claim(602);
  expect_refused(future, Refusal::kRange);
  claim(std::numeric_limits<std::int64_t>::max());
  expect_refused(future, Refusal::kRange);
  Agent agent = running_agent(mission);
  tell(agent, world_state(0, {{100, 500}}));
  claim(601);
  tell(agent, future);
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), 601);
}

TEST(AgentRefuses, APlaceOutsideTheDomain) {
  Agent agent = running_agent(small_mission(1));
  const Outbox out = tell(agent, world_state(0, {{-1, 500}}));
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
  // Multicast gives everybody their own words back.
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const auto said = only<Contribution>(tell(agent, world_state(0, {{100, 500}})));
  tell(agent, said.at(0));
  const AgentStatus status = status_after(agent, at(0s));
  EXPECT_EQ(status.contributions_received, 0);
  EXPECT_EQ(agent.coverage()->row_count(), 1u);
}

// ---- what the status counts ----------------------------------------------------------------------

TEST(AgentStatusReport, CountsGapsInATeammatesSequenceAsLost) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  Contribution theirs = block_of(mission, 1, {{200, 500}}, 1);
  for (const std::int64_t sequence : {11, 12, 15, 14}) {
    theirs.header.sequence = sequence;
    agent.receive(theirs, at(0s));
  }
  const AgentStatus status = status_after(agent, at(0s));
  EXPECT_EQ(status.contributions_received, 4);
  EXPECT_EQ(status.contributions_lost, 1) << "13; what came before 11 was before its time";
}

TEST(AgentStatusReport, MeasuresStalenessByTheOldestTeammate) {
  Mission mission = small_mission(3);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  tell(agent, world_state(0, {{100, 500}}));
  agent.receive(block_of(mission, 1, {{200, 500}}, 1), at(0s));
  agent.receive(block_of(mission, 2, {{300, 500}}, 1), at(0s));
  tell(agent, world_state(9, {{100, 500}}));
  agent.receive(block_of(mission, 1, {{200, 500}, {200, 500}, {200, 500}}, 3), at(0s));
  // Teammate 2 was last heard of at tick 0. How many samples the others gave does not matter: a
  // teammate that was held up once is not out of date for ever.
  EXPECT_DOUBLE_EQ(status_after(agent, at(0s)).max_staleness_s, 0.9);
}

TEST(AgentStatusReport, ShowsPhiSquaredOfTheTeamAsItKnowsIt) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  tell(agent, world_state(0, {{100, 500}}));
  const double expected = Controller(mission).metric(
      basis_values({100, 500}, mission.domain, mission.basis));
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
        only<AgentStatus>(tell(agent, world_state(tick, {{100, 500}}), at(501ms))).size());
  }
  EXPECT_EQ(statuses, 4) << "40 ticks of 0.1 s without any time on the clock";
}

TEST(AgentStatusReport, CountsItsOwnMessages) {
  Agent agent = running_agent(small_mission(1));
  std::size_t sent = advance(agent, at(0s)).size();
  sent += tell(agent, world_state(0, {{100, 500}})).size();
  sent += tell(agent, world_state(0, {{100, 500}})).size();
  const AgentStatus status = status_after(agent, at(0s));
  EXPECT_EQ(status.messages_sent, static_cast<std::int64_t>(sent));
  EXPECT_EQ(status.messages_received, 3) << "the mission and two states";
}

TEST(AgentStatusReport, SequencesGrowByOneOnEachBus) {
  Agent agent = running_agent(small_mission(1));
  std::int64_t last[kBusCount] = {0, 0, 0};
  for (Tick tick = 0; tick < 20; ++tick) {
    for (const Outgoing& out : tell(agent, world_state(tick / 2, {{100, 500}}), at(tick * 200ms))) {
      EXPECT_EQ(header_of(out.message).sequence, ++last[static_cast<std::size_t>(out.bus)]);
    }
  }
  EXPECT_GT(last[static_cast<std::size_t>(Bus::kSwarm)], 20);
  EXPECT_GE(last[static_cast<std::size_t>(Bus::kCommand)], 20);
}

// ---- restarts and the end ------------------------------------------------------------------------

TEST(AgentHears, CoverageOfMembersOnly) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  // More lives of our own number than a table holds, and one of a teammate: none is in the roster.
  for (Incarnation life = 1; life <= 20; ++life) {
    agent.receive(blocks_of(mission, {0, life}, {{900, 900}}, 1).front(), at(0s));
    agent.receive(blocks_of(mission, {1, life}, {{900, 900}}, 1).front(), at(0s));
  }
  // A member's name with another's life is nobody's either.
  agent.receive(blocks_of(mission, {0, life_of(1)}, {{900, 900}}, 1).front(), at(0s));
  EXPECT_EQ(agent.coverage()->row_count(), 1u) << "its own";
  tell(agent, world_state(0, {{100, 500}, {200, 500}}));
  EXPECT_EQ(agent.coverage()->steps_held(author_of(0)), 1);
}

TEST(AgentHears, NoMoreOfAnEvictedTeammateThanItsTimeAllows) {
  const Mission mission = small_mission(2);
  Agent agent = running_agent(mission);
  agent.receive(mission_part(5, MissionState::kRunning,
                             {{author_of(0), 0, -1}, {author_of(1), 0, 2}}), at(0s));
  tell(agent, world_state(0, {{100, 500}, {200, 500}}));
  const std::vector<Eigen::Vector2d> three(3, {200, 500}), four(4, {200, 500});
  agent.receive(block_of(mission, 1, three, 1), at(0s));
  agent.receive(block_of(mission, 1, four, 1), at(0s));
  EXPECT_EQ(agent.coverage()->steps_held(author_of(1)), 3) << "it still covers, but is no member";
}

TEST(AgentInLockstep, WaitsForTheRosterThatTheWorldGoesBy) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  WorldState world = world_state(0, {{100, 500}});
  world.roster_revision = 3;
  EXPECT_TRUE(only<Command>(tell(agent, world)).empty());
  EXPECT_EQ(only<Command>(tell(agent, mission_part(3, MissionState::kRunning, roster_of(1)))).size(),
            1u);
}

TEST(AgentRestarted, ItsFormerLifeIsARowOfItsOwn) {
  const Mission mission = small_mission(1);
  Agent agent = running_agent(mission);
  const Author former{0, 55};
  auto roster = roster_of(1);
  roster.push_back({former, 0, 3});
  agent.receive(mission_part(9, MissionState::kRunning, roster), at(0s));
  agent.receive(blocks_of(mission, former, {{900, 900}, {910, 900}}, 2).front(), at(0s));
  const auto said = only<Contribution>(tell(agent, world_state(0, {{100, 500}})));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].steps, 1) << "the old sum is never added into the new";
  EXPECT_EQ(agent.coverage()->row_count(), 2u);
  EXPECT_EQ(agent.coverage()->steps_held(former), 2);
}

TEST(AgentEnd, AStopEndsItAndTheLastStatusSaysSoOnce) {
  for (const bool failed : {false, true}) {
    Agent agent = running_agent(small_mission(1));
    advance(agent, at(0s));
    const auto last = only<AgentStatus>(
        tell(agent, Stop{{kRun, kOperator, 1, 1, 0}, failed, "enough"}, at(1ms)));
    EXPECT_TRUE(agent.finished());
    EXPECT_EQ(agent.failed(), failed);
    EXPECT_EQ(agent.reason(), "enough");
    ASSERT_EQ(last.size(), 1u);
    EXPECT_EQ(last[0].phase, AgentPhase::kFinished);
    EXPECT_TRUE(tell(agent, world_state(0, {{100, 500}}), at(1h)).empty()) << "final";
  }
}

TEST(AgentEnd, AStopOfAnotherRunDoesNot) {
  Agent agent = running_agent(small_mission(1));
  agent.receive(Stop{{kRun + 1, kOperator, 1, 1, 0}, false, "enough"}, at(0s));
  EXPECT_FALSE(agent.finished());
}

TEST(AgentEnd, TheMissionsEndIsItsEnd) {
  Agent done = running_agent(small_mission(1));
  done.receive(mission_part(1, MissionState::kEnded, roster_of(1), "mission complete"), at(0s));
  EXPECT_TRUE(done.finished());
  EXPECT_FALSE(done.failed());
  Agent failed = running_agent(small_mission(1));
  failed.receive(mission_part(1, MissionState::kFailed, roster_of(1), "agent 3 is late"), at(0s));
  EXPECT_TRUE(failed.finished());
  EXPECT_TRUE(failed.failed());
  EXPECT_EQ(failed.reason(), "agent 3 is late");
}

TEST(AgentEnd, LeavingIsNoFailure) {
  Agent agent = running_agent(small_mission(1));
  agent.leave("SIGTERM");
  EXPECT_TRUE(agent.finished());
  EXPECT_FALSE(agent.failed());
  EXPECT_EQ(only<AgentStatus>(advance(agent, at(0s))).at(0).phase, AgentPhase::kFinished);
}

TEST(AgentEnd, AnEvictedAgentStopsAtTheNamedTick) {
  std::vector<RosterEntry> roster = roster_of(2);
  roster[0].active_until = 3;
  const MissionPart eviction = mission_part(1, MissionState::kRunning, roster);
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;

  Agent there = running_agent(mission);
  tell(there, world_state(3, {{100, 500}}));
  there.receive(eviction, at(0s));
  EXPECT_TRUE(there.finished());
  EXPECT_TRUE(there.failed());
  EXPECT_EQ(there.reason(), "evicted from the roster at tick 3");

  Agent behind = running_agent(mission);
  tell(behind, world_state(1, {{100, 500}}));
  behind.receive(eviction, at(0s));
  EXPECT_EQ(only<Command>(tell(behind, world_state(2, {{100, 500}}))).size(), 1u);
  EXPECT_TRUE(only<Command>(tell(behind, world_state(3, {{100, 500}}))).empty());
  EXPECT_TRUE(behind.finished());
  EXPECT_EQ(behind.reason(), "evicted from the roster at tick 3");
}

}  // namespace
}  // namespace ergocast
