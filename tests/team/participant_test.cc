// SPDX-License-Identifier: BSD-3-Clause
// The checks that all processes share, what a process knows of the others, and what it publishes.
#include "team/participant.h"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/team.h"

namespace ergocast::test {
namespace {

constexpr Incarnation kOwnLife = 4711;

Participant participant(Role role, RunId run = kRun) {
  announce(small_mission(2));
  return {role, {run, kUnassigned, kOwnLife}};
}

TeamStatus team_status(std::int64_t sequence) {
  TeamStatus status;
  status.header = {kRun, kCoordinator, kCoordinatorLife, sequence, 0};
  return status;
}

Message with_sequence(std::int64_t sequence, MissionPart part) {
  part.header.sequence = sequence;
  return part;
}

std::optional<Arrival> accept(Participant& one, const Message& message, Instant now = at(0s)) {
  return one.accept(message, bus_of(message, one.role()), header_of(message).sender, now);
}

TEST(Participant, AcceptsWhatItsRoleReceivesOnThatBus) {
  const Message state = world_state(0, {{1, 1, 0}});
  Participant agent = participant(Role::kAgent);
  EXPECT_TRUE(agent.accept(state, Bus::kWorld, kWorld, at(0s)));
  EXPECT_FALSE(agent.accept(state, Bus::kSwarm, kWorld, at(0s))) << "not there";
  EXPECT_FALSE(agent.accept(team_status(1), Bus::kSwarm, kCoordinator, at(0s))) << "not by agents";
  EXPECT_FALSE(participant(Role::kWorld).accept(state, Bus::kWorld, kWorld, at(0s)));
  EXPECT_EQ(agent.received(), 1);
  EXPECT_EQ(agent.refused(), RefusalCounts{}) << "no sender is to blame";
}

TEST(Participant, EveryRoleReceivesTheMissionAndOnlyItsOwnTypes) {
  for (int role = 0; role < kRoleCount; ++role) {
    Participant one = participant(static_cast<Role>(role));
    EXPECT_TRUE(accept(one, mission_part(0, MissionState::kWaiting, {}))) << role;
    EXPECT_TRUE(one.knows_mission()) << role;
    const bool all = one.role() == Role::kLogger;
    EXPECT_EQ(accept(one, Digest{{kRun, 1, 1, 1, 0}, 0, 0, {}}).has_value(),
              all || one.role() == Role::kAgent)
        << role;
  }
}

TEST(Participant, RefusesItsOwnEcho) {
  Participant agent = participant(Role::kAgent);
  Outbox out;
  agent.publish(Bus::kSwarm, Hello{}, 0, out);
  EXPECT_FALSE(accept(agent, out[0].message));
  agent.set_id(3);  // admitted meanwhile: the same process
  EXPECT_FALSE(accept(agent, out[0].message));
  EXPECT_EQ(agent.refused(), RefusalCounts{});
}

TEST(Participant, AProcessThatNeverSendsHasNoEcho) {
  announce(small_mission(2));
  Participant monitor(Role::kMonitor, {kRun, kUnassigned, 0});
  MissionPart part = mission_part(0, MissionState::kWaiting, {});
  part.header.incarnation = 0;
  EXPECT_TRUE(accept(monitor, part));
}

TEST(Participant, RefusesAndCountsOtherRuns) {
  Participant world = participant(Role::kWorld);
  MissionPart foreign = mission_part(0, MissionState::kWaiting, {});
  foreign.header.run = kRun + 1;
  EXPECT_FALSE(accept(world, foreign));
  EXPECT_FALSE(world.knows_mission());
  EXPECT_EQ(world.refused(Refusal::kRun), 1);
  EXPECT_FALSE(world.liveness().last_sign_of_kind(kCoordinator));
}

TEST(Participant, TakesTheRunOfTheFirstMissionIfItHasNone) {
  Participant world = participant(Role::kWorld, 0);
  Command command = command_of(1, 0, {0, 0, 0});
  command.header.run = 99;
  EXPECT_TRUE(accept(world, command)) << "of whatever run";
  EXPECT_EQ(world.run(), 0u);
  EXPECT_TRUE(accept(world, mission_part(0, MissionState::kWaiting, {})));
  EXPECT_EQ(world.run(), kRun);
  EXPECT_FALSE(accept(world, command));
}

TEST(Participant, CountsAPlanThatIsNotThisRuns) {
  Participant world = participant(Role::kWorld);
  EXPECT_TRUE(accept(world, mission_part(0, MissionState::kWaiting, {}))->mission_changed);
  MissionPart foreign = mission_part(1, MissionState::kRunning, {});
  foreign.plan = {std::byte{7}};
  EXPECT_FALSE(accept(world, foreign)->mission_changed);
  EXPECT_EQ(world.refused(Refusal::kRange), 1);
  EXPECT_TRUE(accept(world, mission_part(2, MissionState::kRunning, {}))->mission_changed);
  EXPECT_EQ(world.refused(Refusal::kRange), 1);
}

TEST(Participant, OnlyWhatItsSenderSendsForTheFirstTimeIsFresh) {
  Participant agent = participant(Role::kAgent);
  Contribution block;
  block.header = {kRun, 1, incarnation_of(1), 5, 0};
  EXPECT_FALSE(agent.accept(block, Bus::kSwarm, 2, at(1s))->fresh) << "agent 2 repeats it";
  EXPECT_FALSE(agent.liveness().last_sign(author_of(1))) << "its author may be dead";
  EXPECT_TRUE(agent.accept(block, Bus::kSwarm, 1, at(2s))->fresh);
  EXPECT_FALSE(agent.accept(block, Bus::kSwarm, 1, at(3s))->fresh);
  EXPECT_EQ(agent.liveness().last_sign(author_of(1)), at(2s));
}

TEST(Participant, AHelloOfAnAgentIsNoSignOfLife) {
  Participant coordinator = participant(Role::kCoordinator);
  for (const AgentId sender : {kUnassigned, 3}) {
    const auto arrival = accept(coordinator, Hello{{kRun, sender, 7, 1, 0}, 3, "there", "1", -1});
    ASSERT_TRUE(arrival);
    EXPECT_FALSE(arrival->fresh);
    EXPECT_FALSE(coordinator.liveness().last_sign({sender, 7}));
  }
  Participant agent = participant(Role::kAgent);
  const auto question =
      accept(agent, Hello{{kRun, kWorld, kWorldLife, 1, -1}, kUnassigned, "", "", -1});
  EXPECT_TRUE(question && question->fresh)
      << "it asks what the team knows, and is to be answered once";
}

TEST(Participant, AProcessThatNeedNotSendYetIsNotSilent) {
  Participant agent = participant(Role::kAgent);
  EXPECT_TRUE(agent.silent(kWorld, at(10s)));
  EXPECT_FALSE(agent.silent(kWorld, at(12999ms), at(10s)));
  EXPECT_TRUE(agent.silent(kWorld, at(13s), at(10s)));
  accept(agent, world_state(0, {{1, 1, 0}}), at(11s));
  EXPECT_FALSE(agent.silent(kWorld, at(13999ms), at(10s)));
}

TEST(Participant, KnowsMembersUnderTheirOwnNumbersOnly) {
  Participant agent = participant(Role::kAgent);
  accept(agent, mission_part(0, MissionState::kWaiting, roster_of(2)));
  ASSERT_NE(agent.member({kRun, 1, incarnation_of(1), 0, 0}), nullptr);
  EXPECT_EQ(agent.member({kRun, 1, incarnation_of(1), 0, 0})->author, author_of(1));
  EXPECT_EQ(agent.member({kRun, 0, incarnation_of(1), 0, 0}), nullptr);
  EXPECT_EQ(agent.member({kRun, 1, incarnation_of(5), 0, 0}), nullptr);
}

TEST(Participant, AnAgentIsSilentAfterThreeSeconds) {
  Participant coordinator = participant(Role::kCoordinator);
  EXPECT_TRUE(coordinator.silent(author_of(1), at(0s))) << "never received";
  accept(coordinator, status_of(1, 1), at(10s));
  EXPECT_FALSE(coordinator.silent(author_of(1), at(12999ms)));
  EXPECT_TRUE(coordinator.silent(author_of(1), at(13s)));
  accept(coordinator, status_of(1, 1), at(13s));
  EXPECT_TRUE(coordinator.silent(author_of(1), at(13s))) << "a recording";
  coordinator.presume_alive(author_of(1), at(13s));
  EXPECT_FALSE(coordinator.silent(author_of(1), at(13s)));
}

TEST(Participant, ACoordinatorIsAliveByTeamStatusWhereThatIsReceived) {
  Participant monitor = participant(Role::kMonitor);
  accept(monitor, mission_part(0, MissionState::kWaiting, {}), at(10s));
  EXPECT_TRUE(monitor.silent(kCoordinator, at(10s))) << "a teammate may have repeated that";
  accept(monitor, team_status(next_sequence()), at(10s));
  EXPECT_FALSE(monitor.silent(kCoordinator, at(11499ms)));
  EXPECT_TRUE(monitor.silent(kCoordinator, at(11500ms)));
}

TEST(Participant, ACoordinatorIsAliveByMissionWhereNothingElseIsReceived) {
  Participant agent = participant(Role::kAgent);
  accept(agent, with_sequence(1, mission_part(0, MissionState::kWaiting, {})), at(10s));
  EXPECT_FALSE(agent.silent(kCoordinator, at(15999ms)));
  EXPECT_TRUE(agent.silent(kCoordinator, at(16s)));
  accept(agent, with_sequence(1, mission_part(0, MissionState::kWaiting, {})), at(16s));
  EXPECT_TRUE(agent.silent(kCoordinator, at(16s))) << "sent again by another sender";
}

TEST(Participant, TheWorldMayBeAsSlowAsItsTicks) {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.dt_s = 2;
  announce(mission);
  Participant agent(Role::kAgent, {kRun, 0, kOwnLife});
  accept(agent, world_state(0, {{1, 1, 0}}), at(10s));
  EXPECT_TRUE(agent.silent(kWorld, at(13s))) << "as far as is known";
  accept(agent, mission_part(0, MissionState::kRunning, {}), at(13s));
  EXPECT_FALSE(agent.silent(kWorld, at(21999ms)));
  EXPECT_TRUE(agent.silent(kWorld, at(22s)));
}

// ---- commands of the operator ----

Stop stop_at(Tick tick) { return {{kRun, kOperator, 1, next_sequence(), tick}, false, "enough"}; }
Amend pause_at(Tick tick) { return {.header = {kRun, kOperator, 1, next_sequence(), tick}}; }
Recall recall_at(Tick tick) { return {{kRun, kOperator, 1, next_sequence(), tick}, 1, false}; }

TEST(Participant, RefusesACommandThatNamesATickWhichItSentLongAgo) {
  for (const Role role :
       {Role::kAgent, Role::kCoordinator, Role::kWorld, Role::kDriver, Role::kLogger}) {
    Participant one = participant(role);
    Outbox out;
    for (Tick tick = 0; tick <= 200; ++tick) {
      one.publish(Bus::kSwarm, AgentStatus{}, tick, out);
      accept(one, mission_part(tick, MissionState::kRunning, {}), at(tick * 100ms));
    }
    EXPECT_TRUE(accept(one, stop_at(200), at(20s)));
    EXPECT_TRUE(accept(one, stop_at(150), at(20s))) << "on a slow network";
    EXPECT_FALSE(accept(one, stop_at(90), at(20s))) << "a recording";
    EXPECT_EQ(one.refused(Refusal::kLate), 1);
    const bool pauses = role == Role::kCoordinator || role == Role::kLogger;
    EXPECT_EQ(accept(one, pause_at(150), at(20s)).has_value(), pauses);
    EXPECT_FALSE(accept(one, pause_at(90), at(20s)));
    EXPECT_EQ(one.refused(Refusal::kLate), pauses ? 2 : 1);
    EXPECT_EQ(accept(one, recall_at(150), at(20s)).has_value(), pauses);
    EXPECT_FALSE(accept(one, recall_at(90), at(20s)));
    EXPECT_EQ(one.refused(Refusal::kLate), pauses ? 3 : 1);
  }
}

TEST(Participant, RefusesByMissionACommandFromBeforeItTookPart) {
  Participant agent = participant(Role::kAgent);
  Outbox out;
  agent.publish(Bus::kSwarm, Hello{}, 0, out);
  EXPECT_TRUE(accept(agent, stop_at(0))) << "it knows of no tick";
  MissionPart part = mission_part(0, MissionState::kRunning, roster_of(1));
  part.header.tick = 5000;
  accept(agent, part);
  EXPECT_FALSE(accept(agent, stop_at(4999)));
  EXPECT_TRUE(accept(agent, stop_at(5000)));
  agent.publish(Bus::kSwarm, AgentStatus{}, 0, out);
  EXPECT_FALSE(accept(agent, stop_at(4999), at(1s))) << "its own first tick is no older one";
}

TEST(Participant, ARefusedCommandTakesNoPlaceAmongTheSenders) {
  Participant agent = participant(Role::kAgent);
  Outbox out;
  agent.publish(Bus::kSwarm, AgentStatus{}, 1, out);
  EXPECT_FALSE(accept(agent, stop_at(0)));
  EXPECT_EQ(agent.received(), 0);
  EXPECT_FALSE(agent.liveness().last_sign_of_kind(kOperator).has_value());
}

// ---- cut off ----

/// A lockstep mission with a time-out of 5 s, and 30 s for a process that may come back.
Participant in_mission(Role role, MissionState state = MissionState::kRunning) {
  Mission mission = small_mission(2);
  mission.timing.lockstep_timeout_s = 5;
  announce(mission);
  Participant one(role, {kRun, kUnassigned, kOwnLife});
  accept(one, mission_part(0, state, roster_of(2)), at(10s));
  return one;
}

TEST(Participant, IsCutOffWhenNoProcessThatCouldReportTheEndHasSentForLong) {
  Participant agent = in_mission(Role::kAgent);
  EXPECT_FALSE(agent.cut_off(3, at(45s))) << "35 s after MISSION";
  EXPECT_TRUE(agent.cut_off(3, at(45001ms)));
  accept(agent, world_state(3, {{1, 1, 0}}), at(20s));
  EXPECT_FALSE(agent.cut_off(3, at(55s)));
  EXPECT_TRUE(agent.cut_off(3, at(55001ms)));
  accept(agent, status_of(1, 1), at(30s));
  EXPECT_TRUE(agent.cut_off(3, at(55001ms))) << "a teammate may be cut off, too";
  accept(agent, mission_part(0, MissionState::kRunning, roster_of(2)), at(30s));
  EXPECT_FALSE(agent.cut_off(3, at(65s)));
}

TEST(Participant, AWorldIsCutOffWithoutAgentsAndCoordinator) {
  Participant world = in_mission(Role::kWorld);
  accept(world, command_of(1, 0, {0, 0, 0}), at(20s));
  EXPECT_FALSE(world.cut_off(3, at(55s)));
  EXPECT_TRUE(world.cut_off(3, at(55001ms)));
}

TEST(Participant, IsNotCutOffWithoutARunningMission) {
  EXPECT_FALSE(in_mission(Role::kAgent, MissionState::kWaiting).cut_off(-1, at(1000s)));
  EXPECT_FALSE(in_mission(Role::kAgent, MissionState::kEnded).cut_off(-1, at(1000s)));
  EXPECT_FALSE(participant(Role::kAgent).cut_off(-1, at(1000s)));
}

TEST(Participant, ALoggerThatReceivesOnlyARepeatedMissionWaitsAsLong) {
  Participant logger = in_mission(Role::kLogger);
  EXPECT_FALSE(logger.cut_off(3, at(45s)));
  EXPECT_TRUE(logger.cut_off(3, at(45001ms)));
}

// ---- what it sends ----

TEST(Participant, SequencesGrowByOneOnEachBus) {
  Participant agent = participant(Role::kAgent);
  agent.set_id(3);
  Outbox out;
  for (int i = 0; i < 3; ++i) agent.publish(Bus::kSwarm, AgentStatus{}, 7, out);
  agent.publish(Bus::kCommand, Command{}, 8, out);
  agent.publish(Bus::kSwarm, AgentStatus{}, 9, out);
  ASSERT_EQ(out.size(), 5u);
  EXPECT_EQ(header_of(out[4].message).sequence, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const Header& header = header_of(out[i].message);
    EXPECT_EQ(header.run, kRun);
    EXPECT_EQ(header.sender, 3);
    EXPECT_EQ(header.incarnation, kOwnLife);
    EXPECT_EQ(header.sequence, i < 3 ? static_cast<std::int64_t>(i) + 1 : 1);
    EXPECT_EQ(header.tick, i < 3 ? 7 : 8);
    EXPECT_EQ(out[i].bus, i < 3 ? Bus::kSwarm : Bus::kCommand);
    EXPECT_EQ(out[i].relayer, kUnassigned);
  }
  EXPECT_EQ(agent.sent(), 5);
}

TEST(Participant, ARelayedBlockKeepsItsAuthor) {
  Participant agent = participant(Role::kAgent);
  agent.set_id(3);
  Contribution block;
  block.header = {0, 1, incarnation_of(1), 5, 9};  // a table does not know the run
  Outbox out;
  agent.relay(Bus::kSwarm, block, out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].relayer, 3);
  const Header& header = header_of(out[0].message);
  EXPECT_EQ(header.run, kRun);
  EXPECT_EQ((Author{header.sender, header.incarnation}), author_of(1));
  EXPECT_EQ(header.sequence, 5);
  EXPECT_EQ(header.tick, 9);
  EXPECT_EQ(agent.sent(), 0) << "its own sequence does not grow";
}

}  // namespace
}  // namespace ergocast::test
