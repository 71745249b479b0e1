// SPDX-License-Identifier: BSD-3-Clause
// The simulated world, driven by hand: lockstep, motion, the record's window and the end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"
#include "core/base/noise.h"
#include "tests/sim/driven_world.h"

namespace ergocast {
namespace {

using namespace test;

// ---- lockstep ----

TEST(WorldInLockstep, SendsNothingUntilTheMissionRunsThenAsksTheTeamAndThenSendsAllStarts) {
  const Mission mission = small_mission(2);
  World world = world_of(mission);
  EXPECT_TRUE(advance(world, at(0s)).empty());
  give(world, mission_part(0, MissionState::kWaiting, roster_of(2)), at(0s));
  EXPECT_TRUE(advance(world, at(1s)).empty());
  give(world, mission_part(1, MissionState::kRunning, roster_of(2)), at(2s));
  const Outbox question = advance(world, at(2s));
  ASSERT_EQ(question.size(), 1u);
  EXPECT_EQ(question[0].bus, Bus::kWorld);
  EXPECT_EQ(std::get<Hello>(question[0].message).header.sender, kWorld);
  EXPECT_EQ(std::get<Hello>(question[0].message).header.tick, 0) << "it knows the mission";
  EXPECT_FALSE(world.begun_at());
  nobody_has_moved(world, 2, at(2s));
  const Outbox out = advance(world, at(2s));
  EXPECT_EQ(world.begun_at(), 0);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].bus, Bus::kWorld);
  const auto state = std::get<WorldState>(out[0].message);
  EXPECT_EQ(state.header.tick, 0);
  EXPECT_EQ(state.header.sender, kWorld);
  EXPECT_EQ(state.roster_revision, 1);
  ASSERT_EQ(state.vehicle_count, 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(state.vehicles[static_cast<std::size_t>(i)].id, i);
    EXPECT_EQ(state.vehicles[static_cast<std::size_t>(i)].answered_tick, -1);
    EXPECT_EQ(place(state, i), mission.starts_m[static_cast<std::size_t>(i)]);
    EXPECT_EQ(applied(state, i), Eigen::Vector3d(0, 0, 0));
  }
}

TEST(WorldInLockstep, IntegratesEachCommandForOneStepAndReportsWhatItApplied) {
  const Mission mission = small_mission(2);
  World world = running_world(mission);
  advance(world, at(0s));
  const Eigen::Vector3d fast(9.87, -1.23, 0), slow(0.1, 0.3, 0);
  give(world, command_of(0, 0, fast), at(0s));
  give(world, command_of(1, 0, slow), at(0s));
  const WorldState state = state_after(world, at(0s));
  EXPECT_EQ(state.header.tick, 1);
  EXPECT_EQ(place(state, 0), mission.starts_m[0] + fast * 0.1) << "bit for bit";
  EXPECT_EQ(place(state, 1), mission.starts_m[1] + slow * 0.1);
  EXPECT_EQ(applied(state, 0), fast);
  EXPECT_EQ(applied(state, 1), slow);
  EXPECT_EQ(state.vehicles[0].answered_tick, 0);
}

TEST(WorldInLockstep, RepeatsATickUntilAllAgentsHaveAnswered) {
  World world = running_world(small_mission(2));
  const WorldState first = state_after(world, at(0s));
  give(world, command_of(0, 0, {1, 1, 0}), at(1ms));
  EXPECT_TRUE(advance(world, at(19ms)).empty());
  EXPECT_EQ(world.next_wakeup(), at(20ms));
  const WorldState again = state_after(world, at(20ms));
  EXPECT_EQ(again.header.tick, 0);
  EXPECT_EQ(place(again), place(first));
  EXPECT_GT(again.header.sequence, first.header.sequence);
  EXPECT_TRUE(advance(world, at(59ms)).empty()) << "a slow team is not buried in repeats";
  EXPECT_EQ(state_after(world, at(60ms)).header.tick, 0);
  give(world, command_of(1, 0, {1, 1, 0}), at(61ms));
  EXPECT_EQ(state_after(world, at(61ms)).header.tick, 1) << "and goes on as soon as they have";
}

TEST(WorldInLockstep, TakesTheFirstAnswerToATickAndNoOther) {
  const Mission mission = small_mission(2);
  World world = running_world(mission);
  advance(world, at(0s));
  give(world, command_of(0, 0, {1, 0, 0}), at(0s));
  give(world, command_of(0, 0, {9, 9, 0}), at(0s));
  give(world, command_of(1, 0, {0, 0, 0}), at(0s));
  EXPECT_EQ(applied(state_after(world, at(0s))), Eigen::Vector3d(1, 0, 0));
}

TEST(WorldInLockstep, PublishesLargeTeamsInParts) {
  World world = running_world(small_mission(kMaxVehiclesPerState + 3));
  const auto states = states_after(world, at(0s));
  ASSERT_EQ(states.size(), 2u);
  EXPECT_EQ(states[0].parts, 2);
  EXPECT_EQ(states[0].part, 0);
  EXPECT_EQ(states[1].part, 1);
  EXPECT_EQ(states[0].vehicle_count, kMaxVehiclesPerState);
  EXPECT_EQ(states[1].vehicle_count, 3);
  EXPECT_EQ(states[1].vehicles[2].id, kMaxVehiclesPerState + 2);
}

// ---- motion ----

TEST(WorldMotion, ReflectsAtEveryEdge) {
  const struct {
    Eigen::Vector3d start, velocity, end;
  } cases[] = {{{0.5, 500, 0}, {-10, 0, 0}, {0.5, 500, 0}},
               {{1999.75, 500, 0}, {10, 0, 0}, {1999.25, 500, 0}},
               {{500, 0.25, 0}, {0, -10, 0}, {500, 0.75, 0}},
               {{500, 2000, 0}, {0, 10, 0}, {500, 1999, 0}},
               {{0, 0, 0}, {-10, -10, 0}, {1, 1, 0}}};
  for (const auto& c : cases) {
    Mission mission = small_mission(1);
    mission.starts_m[0] = c.start;
    World world = running_world(mission);
    advance(world, at(0s));
    give(world, command_of(0, 0, c.velocity), at(0s));
    const WorldState state = state_after(world, at(0s));
    EXPECT_EQ(place(state), c.end);
    EXPECT_EQ(applied(state), c.velocity) << "the command, not what the edge made of it";
  }
}

TEST(WorldMotion, StaysInTheDomainWhateverIsCommanded) {
  for (const double speed : {1e6, 1e17, 1e300}) {
    World world = running_world(small_mission(1));
    advance(world, at(0s));
    give(world, command_of(0, 0, {speed, -speed, 0}), at(0s));
    EXPECT_TRUE(small_mission(1).domain.contains(place(state_after(world, at(0s))))) << speed;
  }
}

TEST(WorldMotion, IsDisturbedOnlyIfTheScenarioSetsItAndByAFunctionOfTheSeed) {
  Mission mission = small_mission(1);
  mission.disturbance_intensity = 3;
  World world = running_world(mission);
  advance(world, at(0s));
  Eigen::Vector3d expected = mission.starts_m[0];
  for (Tick tick = 0; tick < 5; ++tick) {
    give(world, command_of(0, tick, {1, 2, 0}), at(0s));
    Eigen::Vector3d next = expected + Eigen::Vector3d(1, 2, 0) * 0.1;
    next += 3 * std::sqrt(0.1) *
            on_ground(normal_pair(mission.seed, Purpose::kDisturbance, 0,
                                  static_cast<std::uint64_t>(tick)));
    expected = reflect(next, mission.domain);
    const WorldState state = state_after(world, at(0s));
    EXPECT_EQ(place(state), expected);
    EXPECT_EQ(applied(state), Eigen::Vector3d(1, 2, 0)) << "the command is what the agent gave";
  }
}

// ---- the record's window ----

Mission recorded_mission() {
  Mission mission = small_mission(1);
  mission.wait_for_logger = true;
  mission.timing.tick_count = 1000;
  mission.timing.lockstep_timeout_s = 10;
  return mission;
}

/// Answers every tick at `now` until the world sends nothing new.
void run_while_it_goes(World& world, Instant now) {
  for (auto states = states_after(world, now); !states.empty(); states = states_after(world, now)) {
    give(world, command_of(0, world.tick(), {1, 0, 0}), now);
  }
}

TEST(WorldRecord, WaitsForTheLoggersFirstMessage) {
  World world = running_world(recorded_mission());
  EXPECT_TRUE(advance(world, at(1s)).empty());
  give(world, ack_of(-1), at(2s));
  EXPECT_EQ(state_after(world, at(2s)).header.tick, 0);
}

TEST(WorldRecord, RunsAtMostAWindowAheadOfWhatIsRecorded) {
  World world = running_world(recorded_mission());
  give(world, ack_of(-1), at(0s));
  run_while_it_goes(world, at(0s));
  EXPECT_EQ(world.tick(), 64) << "63, the last it may, is answered; 64 is not published";
  give(world, ack_of(10), at(1s));
  run_while_it_goes(world, at(1s));
  EXPECT_EQ(world.tick(), 75);
  give(world, ack_of(3), at(1s));
  run_while_it_goes(world, at(1s));
  EXPECT_EQ(world.tick(), 75) << "an old acknowledgement takes nothing back";
}

TEST(WorldRecord, RepeatsWhatTheLoggerLacks) {
  World world = running_world(recorded_mission());
  give(world, ack_of(-1), at(0s));
  run_while_it_goes(world, at(0s));
  give(world, ack_of(20), at(1s));
  run_while_it_goes(world, at(1s));
  const auto states = states_after(world, at(2s));
  std::vector<Tick> ticks;
  for (const WorldState& state : states) ticks.push_back(state.header.tick);
  // The newest state lists the answers; then come the oldest missing states.
  std::vector<Tick> expected{84};
  for (Tick tick = 21; tick <= 36; ++tick) expected.push_back(tick);
  EXPECT_EQ(ticks, expected);
  // 0.1 m a tick, each addition rounding at most half an ulp of 128.
  EXPECT_NEAR(place(states[1]).x(), 102.1, 21 * 0x1p-47);
  EXPECT_NEAR(place(states[2]).x(), 102.2, 22 * 0x1p-47);
}

TEST(WorldRecord, GivesUpASilentLoggerAndReportsIt) {
  World world = running_world(recorded_mission());
  give(world, ack_of(-1), at(0s));
  run_while_it_goes(world, at(0s));
  // Half the team's time-out, so that the coordinator blames no agent in the meantime.
  advance(world, at(5s));
  EXPECT_FALSE(world.logger_lost());
  EXPECT_EQ(world.tick(), 64);
  run_while_it_goes(world, at(5s + 1ns));
  EXPECT_TRUE(world.logger_lost());
  EXPECT_EQ(world.tick(), 1000);
}

TEST(WorldRecord, DoesNotWaitIfTheScenarioWantsNoLogger) {
  Mission mission = recorded_mission();
  mission.wait_for_logger = false;
  World world = running_world(mission);
  run_while_it_goes(world, at(0s));
  EXPECT_EQ(world.tick(), 1000);
  EXPECT_FALSE(world.logger_lost());
}

// ---- the end ----

TEST(WorldEnd, RepeatsTheLastStateForTwoSecondsAndIsDone) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 1;
  World world = running_world(mission);
  advance(world, at(0s));
  give(world, command_of(0, 0, {1, 0, 0}), at(1s));
  EXPECT_EQ(state_after(world, at(1s)).header.tick, 1);
  advance(world, at(1s));
  give(world, command_of(0, 1, {1, 0, 0}), at(1s));
  EXPECT_EQ(state_after(world, at(2900ms)).header.tick, 1);
  EXPECT_FALSE(world.finished());
  advance(world, at(3001ms));
  EXPECT_TRUE(world.finished());
  EXPECT_EQ(world.reason(), "mission complete");
  EXPECT_EQ(world.next_wakeup(), Instant::max());
}

TEST(WorldEnd, ItsLastMessageReportsItsEndOnceTheRecordIsCompleteAndTheMissionOver) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 1;
  World world = running_world(mission);
  advance(world, at(0s));
  give(world, command_of(0, 0, {1, 0, 0}), at(0s));
  EXPECT_FALSE(state_after(world, at(0s)).last);
  give(world, mission_part(1, MissionState::kEnded, roster_of(1)), at(0s));
  EXPECT_TRUE(states_after(world, at(0s)).empty()) << "the logger may lack a state";
  give(world, ack_of(0), at(0s));
  EXPECT_TRUE(world.finished());
  const WorldState farewell = state_after(world, at(0s));
  EXPECT_TRUE(farewell.last);
  EXPECT_EQ(farewell.header.tick, 1);
  EXPECT_TRUE(advance(world, at(1s)).empty()) << "once";
}

TEST(WorldEnd, AWorldThatIsStoppedAloneSendsNothing) {
  World world = running_world(small_mission(1));
  advance(world, at(0s));
  world.stop("SIGTERM");
  EXPECT_TRUE(advance(world, at(1s)).empty()) << "another may go on in its place";
}

TEST(WorldEnd, TheMissionsEndAndItsProcessEndItAtOnce) {
  World by_mission = running_world(small_mission(1));
  give(by_mission, mission_part(1, MissionState::kFailed, roster_of(1), "agent 3 is late"), at(0s));
  EXPECT_TRUE(by_mission.finished());
  EXPECT_EQ(by_mission.reason(), "agent 3 is late");
  EXPECT_TRUE(advance(by_mission, at(1s)).empty()) << "and it moves no vehicle any more";

  World by_process = running_world(small_mission(1));
  by_process.stop("SIGTERM");
  EXPECT_TRUE(by_process.finished());
  EXPECT_EQ(by_process.reason(), "SIGTERM");
}

TEST(WorldEnd, APlanItCannotReadEndsIt) {
  World world(kRun, kWorldLife);
  announced_plan = kNoPlan;
  give(world, mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  EXPECT_TRUE(world.finished());
  EXPECT_TRUE(world.failed());
  EXPECT_EQ(world.reason(), why_no_plan());
}

TEST(WorldEnd, ByItselfOnceNeitherAgentNorCoordinatorCanStillCome) {
  Mission mission = small_mission(1);
  mission.timing.lockstep_timeout_s = 10;
  World world = running_world(mission);
  advance(world, at(0s));
  const Command answer = command_of(0, 0, {1, 0, 0});
  give(world, answer, at(5s));
  advance(world, at(5s));
  give(world, answer, at(30s));  // a recording of it is no answer
  advance(world, at(45s));
  EXPECT_FALSE(world.finished()) << "10 s for a tick, and 30 s more";
  advance(world, at(45001ms));
  EXPECT_TRUE(world.finished());
  EXPECT_NE(world.reason().find("no agent and no coordinator"), std::string::npos);
}

TEST(WorldEnd, ByItselfAlsoIfNoAgentHasAnsweredWhereTheTeamIs) {
  Mission mission = small_mission(1);
  mission.timing.lockstep_timeout_s = 10;
  World world = world_of(mission);
  give(world, mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  advance(world, at(40s));
  EXPECT_FALSE(world.finished());
  advance(world, at(40001ms));
  EXPECT_TRUE(world.finished());
}

}  // namespace
}  // namespace ergocast
