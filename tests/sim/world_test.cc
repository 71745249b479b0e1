// The simulated world, driven by hand: the integration, who may command, lockstep, the clock, the
// record's window and the end.
#include "sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry.h"
#include "core/noise.h"
#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

World world_of(const Mission& mission) { return {kRun, kWorldLife, decoder_of(mission)}; }

/// Every agent's answer to the question where it was.
void nobody_has_moved(World& world, int agents, Instant now) {
  for (AgentId id = 0; id < agents; ++id) world.receive(command_of(id, -1, {0, 0}), now);
}

/// A world whose mission runs since `now`, all planned agents admitted; nothing published yet.
World running_world(const Mission& mission, Instant now = at(0s)) {
  World world = world_of(mission);
  const auto team = static_cast<int>(mission.starts_m.size());
  world.receive(mission_part(0, MissionState::kRunning, roster_of(team)), now);
  nobody_has_moved(world, team, now);
  return world;
}

std::vector<WorldState> states_after(World& world, Instant now) {
  return only<WorldState>(advance(world, now));
}

/// The one state that the world says now.
WorldState state_after(World& world, Instant now) {
  const auto states = states_after(world, now);
  EXPECT_EQ(states.size(), 1u);
  return states.empty() ? WorldState{} : states.back();
}

Eigen::Vector2d place(const WorldState& state, int vehicle = 0) {
  return state.vehicles[static_cast<std::size_t>(vehicle)].position_m.head<2>();
}
Eigen::Vector2d applied(const WorldState& state, int vehicle = 0) {
  return state.vehicles[static_cast<std::size_t>(vehicle)].velocity_mps.head<2>();
}

RecordAck ack_of(Tick tick) { return {{kRun, kLogger, kLoggerLife, tick + 2, tick}}; }

// ---- lockstep ------------------------------------------------------------------------------------

TEST(WorldInLockstep, SaysNothingUntilTheMissionRunsThenAsksTheTeamAndThenSaysEverybodysStart) {
  const Mission mission = small_mission(2);
  World world = world_of(mission);
  EXPECT_TRUE(advance(world, at(0s)).empty());
  world.receive(mission_part(0, MissionState::kWaiting, roster_of(2)), at(0s));
  EXPECT_TRUE(advance(world, at(1s)).empty());
  world.receive(mission_part(1, MissionState::kRunning, roster_of(2)), at(2s));
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
    EXPECT_EQ(applied(state, i), Eigen::Vector2d(0, 0));
  }
}

TEST(WorldInLockstep, IntegratesEachCommandForOneStepAndSaysWhatItApplied) {
  const Mission mission = small_mission(2);
  World world = running_world(mission);
  advance(world, at(0s));
  const Eigen::Vector2d fast(9.87, -1.23), slow(0.1, 0.3);
  world.receive(command_of(0, 0, fast), at(0s));
  world.receive(command_of(1, 0, slow), at(0s));
  const WorldState state = state_after(world, at(0s));
  EXPECT_EQ(state.header.tick, 1);
  EXPECT_EQ(place(state, 0), mission.starts_m[0] + fast * 0.1) << "bit for bit";
  EXPECT_EQ(place(state, 1), mission.starts_m[1] + slow * 0.1);
  EXPECT_EQ(applied(state, 0), fast);
  EXPECT_EQ(applied(state, 1), slow);
  EXPECT_EQ(state.vehicles[0].answered_tick, 0);
}

TEST(WorldInLockstep, RepeatsATickUntilEverybodyHasAnswered) {
  World world = running_world(small_mission(2));
  const WorldState first = state_after(world, at(0s));
  world.receive(command_of(0, 0, {1, 1}), at(1ms));
  EXPECT_TRUE(advance(world, at(19ms)).empty());
  EXPECT_EQ(world.next_wakeup(), at(20ms));
  const WorldState again = state_after(world, at(20ms));
  EXPECT_EQ(again.header.tick, 0);
  EXPECT_EQ(place(again), place(first));
  EXPECT_GT(again.header.sequence, first.header.sequence);
  EXPECT_TRUE(advance(world, at(59ms)).empty()) << "a slow team is not buried in repeats";
  EXPECT_EQ(state_after(world, at(60ms)).header.tick, 0);
  world.receive(command_of(1, 0, {1, 1}), at(61ms));
  EXPECT_EQ(state_after(world, at(61ms)).header.tick, 1) << "and goes on as soon as they have";
}

TEST(WorldInLockstep, TakesTheFirstAnswerToATickAndNoOther) {
  const Mission mission = small_mission(2);
  World world = running_world(mission);
  advance(world, at(0s));
  world.receive(command_of(0, 0, {1, 0}), at(0s));
  world.receive(command_of(0, 0, {9, 9}), at(0s));
  world.receive(command_of(1, 0, {0, 0}), at(0s));
  EXPECT_EQ(applied(state_after(world, at(0s))), Eigen::Vector2d(1, 0));
}

TEST(WorldInLockstep, TakesNoVelocityWhoseStepOverflows) {
  Mission mission = small_mission(1);
  mission.timing.dt_s = 10;
  World world = running_world(mission);
  advance(world, at(0s));
  world.receive(command_of(0, 0, {1e308, 0}), at(0s));
  EXPECT_TRUE(advance(world, at(0s)).empty()) << "unanswered";
  world.receive(command_of(0, 0, {1, 0}), at(0s));
  EXPECT_EQ(applied(state_after(world, at(0s))), Eigen::Vector2d(1, 0));
}

TEST(WorldInLockstep, PublishesLargeTeamsInParts) {
  World world = running_world(small_mission(19));
  const auto states = states_after(world, at(0s));
  ASSERT_EQ(states.size(), 2u);
  EXPECT_EQ(states[0].parts, 2);
  EXPECT_EQ(states[0].part, 0);
  EXPECT_EQ(states[1].part, 1);
  EXPECT_EQ(states[0].vehicle_count, 16);
  EXPECT_EQ(states[1].vehicle_count, 3);
  EXPECT_EQ(states[1].vehicles[2].id, 18);
}

// ---- whose commands count ------------------------------------------------------------------------

TEST(WorldRefuses, CommandsThatAreNotAnAnswerOfAMemberToThisTick) {
  World world = running_world(small_mission(1));
  advance(world, at(0s));
  Command stranger = command_of(0, 0, {1, 1});
  stranger.header.incarnation = 99;
  Command foreign = command_of(0, 0, {1, 1});
  foreign.header.run = kRun + 1;
  const Command lies[] = {command_of(3, 0, {1, 1}), stranger, foreign, command_of(0, 1, {1, 1}),
                          command_of(0, Tick{1} << 48, {1, 1})};
  for (const Command& lie : lies) {
    world.receive(lie, at(0s));
    EXPECT_TRUE(advance(world, at(0s)).empty());
  }
  EXPECT_EQ(world.tick(), 0);
  // None of them stands in the way of the real answer.
  world.receive(command_of(0, 0, {2, 0}), at(0s));
  EXPECT_EQ(applied(state_after(world, at(0s))), Eigen::Vector2d(2, 0));
  // An old one does not count as an answer to the new tick.
  world.receive(command_of(0, 0, {9, 9}), at(0s));
  EXPECT_TRUE(advance(world, at(0s)).empty());
}

TEST(WorldRefuses, TheCommandsOfAnEvictedAgentWhichStandsStill) {
  const Mission mission = small_mission(2);
  World world = running_world(mission);
  advance(world, at(0s));
  world.receive(command_of(0, 0, {1, 0}), at(0s));
  world.receive(command_of(1, 0, {1, 0}), at(0s));
  advance(world, at(0s));
  std::vector<RosterEntry> roster = roster_of(2);
  roster[1].active_until = 1;
  world.receive(mission_part(1, MissionState::kRunning, roster), at(0s));
  world.receive(command_of(1, 1, {5, 5}), at(0s));
  world.receive(command_of(0, 1, {1, 0}), at(0s));
  const WorldState state = state_after(world, at(0s));
  EXPECT_EQ(state.header.tick, 2) << "nobody waits for it any more";
  EXPECT_EQ(applied(state, 1), Eigen::Vector2d(0, 0));
  EXPECT_EQ(place(state, 1), mission.starts_m[1] + Eigen::Vector2d(1, 0) * 0.1);
}

TEST(WorldRefuses, TheFormerLifeOfARestartedAgentWhichGoesOnFromItsPlace) {
  const Mission mission = small_mission(1);
  World world = running_world(mission);
  advance(world, at(0s));
  world.receive(command_of(0, 0, {10, 0}), at(0s));
  advance(world, at(0s));
  std::vector<RosterEntry> roster = roster_of(1);
  roster[0].active_until = 1;
  roster.push_back({{0, 2000}, 1, -1});
  world.receive(mission_part(1, MissionState::kRunning, roster), at(0s));
  world.receive(command_of(0, 1, {-9, 0}), at(0s));
  EXPECT_TRUE(advance(world, at(0s)).empty());
  EXPECT_EQ(world.tick(), 1);
  Command reborn = command_of(0, 1, {0, 10});
  reborn.header.incarnation = 2000;
  world.receive(reborn, at(0s));
  const WorldState state = state_after(world, at(0s));
  EXPECT_EQ(state.header.tick, 2);
  EXPECT_EQ(place(state), Eigen::Vector2d(101, 501));
}

TEST(WorldRefuses, ToRunOnWithNobodyLeft) {
  World world = running_world(small_mission(2));
  advance(world, at(0s));
  std::vector<RosterEntry> roster = roster_of(2);
  roster[0].active_until = roster[1].active_until = 0;
  world.receive(mission_part(1, MissionState::kRunning, roster), at(0s));
  EXPECT_TRUE(advance(world, at(1ms)).empty());
  EXPECT_EQ(state_after(world, at(20ms)).header.tick, 0);
}

TEST(WorldAdmits, AgentsBeyondThePlanAtStartsDrawnFromTheSeed) {
  const auto strangers = [](std::uint64_t seed) {
    Mission mission = small_mission(1);
    mission.seed = seed;
    World world = running_world(mission);
    world.receive(mission_part(1, MissionState::kRunning, roster_of(3)), at(0s));
    nobody_has_moved(world, 3, at(0s));
    const WorldState state = state_after(world, at(0s));
    EXPECT_EQ(state.vehicle_count, 3);
    EXPECT_EQ(place(state, 0), mission.starts_m[0]) << "who is in the plan begins as planned";
    for (const int stranger : {1, 2}) {
      EXPECT_EQ(place(state, stranger), random_start(mission.domain, seed, stranger));
      EXPECT_TRUE(mission.domain.contains(place(state, stranger)));
    }
    EXPECT_NE(place(state, 1), place(state, 2));
    return std::pair(place(state, 1), place(state, 2));
  };
  EXPECT_EQ(strangers(7), strangers(7));
  EXPECT_NE(strangers(7), strangers(8));
}

TEST(WorldAdmits, ALateAgentAtItsOwnStart) {
  const Mission mission = small_mission(2);
  World world = world_of(mission);
  world.receive(mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  nobody_has_moved(world, 1, at(0s));
  EXPECT_EQ(state_after(world, at(0s)).vehicle_count, 1);
  world.receive(mission_part(1, MissionState::kRunning, roster_of(2)), at(0s));
  world.receive(command_of(0, 0, {0, 0}), at(0s));
  EXPECT_TRUE(advance(world, at(1ms)).empty()) << "the tick is the newcomer's too";
  const WorldState again = state_after(world, at(20ms));
  EXPECT_EQ(again.header.tick, 0);
  EXPECT_EQ(again.roster_revision, 1);
  ASSERT_EQ(again.vehicle_count, 2) << "which has to see where it is";
  EXPECT_EQ(place(again, 1), mission.starts_m[1]);
  world.receive(command_of(1, 0, {0, 0}), at(20ms));
  const WorldState state = state_after(world, at(20ms));
  EXPECT_EQ(state.header.tick, 1);
  ASSERT_EQ(state.vehicle_count, 2);
  EXPECT_EQ(place(state, 1), mission.starts_m[1]);
}

// ---- motion --------------------------------------------------------------------------------------

TEST(WorldMotion, ReflectsAtEveryEdge) {
  const struct {
    Eigen::Vector2d start, velocity, end;
  } cases[] = {{{0.5, 500}, {-10, 0}, {0.5, 500}},
               {{1999.75, 500}, {10, 0}, {1999.25, 500}},
               {{500, 0.25}, {0, -10}, {500, 0.75}},
               {{500, 2000}, {0, 10}, {500, 1999}},
               {{0, 0}, {-10, -10}, {1, 1}}};
  for (const auto& c : cases) {
    Mission mission = small_mission(1);
    mission.starts_m[0] = c.start;
    World world = running_world(mission);
    advance(world, at(0s));
    world.receive(command_of(0, 0, c.velocity), at(0s));
    const WorldState state = state_after(world, at(0s));
    EXPECT_EQ(place(state), c.end);
    EXPECT_EQ(applied(state), c.velocity) << "the command, not what the edge made of it";
  }
}

TEST(WorldMotion, StaysInTheDomainWhateverIsCommanded) {
  for (const double speed : {1e6, 1e17, 1e300}) {
    World world = running_world(small_mission(1));
    advance(world, at(0s));
    world.receive(command_of(0, 0, {speed, -speed}), at(0s));
    EXPECT_TRUE(small_mission(1).domain.contains(place(state_after(world, at(0s))))) << speed;
  }
}

TEST(WorldMotion, IsDisturbedOnlyIfTheScenarioSaysSoAndByAFunctionOfTheSeed) {
  Mission mission = small_mission(1);
  mission.disturbance_intensity = 3;
  World world = running_world(mission);
  advance(world, at(0s));
  Eigen::Vector2d expected = mission.starts_m[0];
  for (Tick tick = 0; tick < 5; ++tick) {
    world.receive(command_of(0, tick, {1, 2}), at(0s));
    Eigen::Vector2d next = expected + Eigen::Vector2d(1, 2) * 0.1;
    next += 3 * std::sqrt(0.1) *
            normal_pair(mission.seed, Purpose::kDisturbance, 0, static_cast<std::uint64_t>(tick));
    expected = reflect(next, mission.domain);
    const WorldState state = state_after(world, at(0s));
    EXPECT_EQ(place(state), expected);
    EXPECT_EQ(applied(state), Eigen::Vector2d(1, 2)) << "the command is what the agent gave";
  }
}

// ---- the record's window -------------------------------------------------------------------------

Mission recorded_mission() {
  Mission mission = small_mission(1);
  mission.wait_for_logger = true;
  mission.timing.tick_count = 1000;
  mission.timing.lockstep_timeout_s = 10;
  return mission;
}

/// Answers every tick at `now` until the world says nothing new.
void run_while_it_goes(World& world, Instant now) {
  for (auto states = states_after(world, now); !states.empty(); states = states_after(world, now)) {
    world.receive(command_of(0, world.tick(), {1, 0}), now);
  }
}

TEST(WorldRecord, WaitsForTheLoggersFirstWord) {
  World world = running_world(recorded_mission());
  EXPECT_TRUE(advance(world, at(1s)).empty());
  world.receive(ack_of(-1), at(2s));
  EXPECT_EQ(state_after(world, at(2s)).header.tick, 0);
}

TEST(WorldRecord, RunsAtMostAWindowAheadOfWhatIsRecorded) {
  World world = running_world(recorded_mission());
  world.receive(ack_of(-1), at(0s));
  run_while_it_goes(world, at(0s));
  EXPECT_EQ(world.tick(), 64) << "63, the last it may, is answered; 64 is not published";
  world.receive(ack_of(10), at(1s));
  run_while_it_goes(world, at(1s));
  EXPECT_EQ(world.tick(), 75);
  world.receive(ack_of(3), at(1s));
  run_while_it_goes(world, at(1s));
  EXPECT_EQ(world.tick(), 75) << "an old acknowledgement takes nothing back";
}

TEST(WorldRecord, RepeatsWhatTheLoggerLacks) {
  World world = running_world(recorded_mission());
  world.receive(ack_of(-1), at(0s));
  run_while_it_goes(world, at(0s));
  world.receive(ack_of(20), at(1s));
  run_while_it_goes(world, at(1s));
  const auto states = states_after(world, at(2s));
  std::vector<Tick> ticks;
  for (const WorldState& state : states) ticks.push_back(state.header.tick);
  // Row 21 needs the states 21 and 22; the newest says who has answered.
  EXPECT_EQ(ticks, (std::vector<Tick>{84, 21, 22}));
  // 0.1 m a tick, each addition rounding at most half an ulp of 128.
  EXPECT_NEAR(place(states[1]).x(), 102.1, 21 * 0x1p-47);
  EXPECT_NEAR(place(states[2]).x(), 102.2, 22 * 0x1p-47);
}

TEST(WorldRecord, GivesUpASilentLoggerAndSaysSo) {
  World world = running_world(recorded_mission());
  world.receive(ack_of(-1), at(0s));
  run_while_it_goes(world, at(0s));
  // Half the team's patience, so that the coordinator blames nobody in the meantime.
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

// ---- real time -----------------------------------------------------------------------------------

Mission realtime_mission(double factor = 1) {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.realtime_factor = factor;
  return mission;
}

TEST(WorldInRealTime, GoesByTheClockTimesAFactor) {
  for (const double factor : {1.0, 0.5, 10.0}) {
    World world = running_world(realtime_mission(factor), at(7s));
    EXPECT_EQ(state_after(world, at(7s)).header.tick, 0);
    const auto period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e8 / factor));
    for (int tick = 1; tick <= 5; ++tick) {
      EXPECT_EQ(world.next_wakeup(), at(7s + tick * period));
      EXPECT_TRUE(advance(world, at(7s + tick * period - 1ns)).empty());
      EXPECT_EQ(state_after(world, at(7s + tick * period)).header.tick, tick);
    }
  }
}

TEST(WorldInRealTime, CountsAndShowsEveryMissedDeadline) {
  World world = running_world(realtime_mission());
  advance(world, at(0s));
  world.receive(command_of(0, 0, {1, 0}), at(99ms));
  EXPECT_EQ(state_after(world, at(100ms)).missed_deadlines, 0);
  EXPECT_EQ(state_after(world, at(200ms)).missed_deadlines, 1);
  world.receive(command_of(0, 1, {1, 0}), at(201ms));
  EXPECT_EQ(state_after(world, at(300ms)).missed_deadlines, 2) << "an answer to 1 is none to 2";
  world.receive(command_of(0, 3, {1, 0}), at(301ms));
  EXPECT_EQ(state_after(world, at(400ms)).missed_deadlines, 2);
  EXPECT_EQ(world.missed_deadlines(), 2);
}

TEST(WorldInRealTime, HoldsAnOldCommandForALimitAndThenStops) {
  Mission mission = realtime_mission();
  mission.timing.command_hold_s = 0.35;
  World world = running_world(mission);
  advance(world, at(0s));
  world.receive(command_of(0, 0, {10, 0}), at(0s));
  for (int tick = 1; tick <= 8; ++tick) {
    const WorldState state = state_after(world, at(tick * 100ms));
    // The step from tick n uses a command that is n·0.1 s old: 0, 0.1, 0.2, 0.3, and no more.
    EXPECT_EQ(applied(state), tick <= 4 ? Eigen::Vector2d(10, 0) : Eigen::Vector2d(0, 0)) << tick;
    EXPECT_NEAR(place(state).x(), 100 + std::min(tick, 4), 1e-9);
  }
}

TEST(WorldInRealTime, CatchesUpABoundedNumberOfTicksAndCountsTheRest) {
  World world = running_world(realtime_mission());
  advance(world, at(0s));
  advance(world, at(100ms));
  // 18 ticks late: 5 are made up for, 1 is due anyway, 13 are given up.
  const auto states = states_after(world, at(2s));
  ASSERT_EQ(states.size(), 6u);
  EXPECT_EQ(states.back().header.tick, 7);
  EXPECT_EQ(states.back().skipped_ticks, 13);
  EXPECT_EQ(world.skipped_ticks(), 13);
  EXPECT_EQ(world.missed_deadlines(), 7) << "none of its steps had an answer";
  EXPECT_EQ(world.next_wakeup(), at(2100ms)) << "back on the beat";
}

TEST(WorldInRealTime, MakesUpForSmallDelaysWithoutLosingATick) {
  World world = running_world(realtime_mission());
  advance(world, at(0s));
  EXPECT_EQ(states_after(world, at(350ms)).size(), 3u);
  EXPECT_EQ(states_after(world, at(400ms)).size(), 1u);
  EXPECT_EQ(world.skipped_ticks(), 0);
}

TEST(WorldInRealTime, WaitsForTheLoggersFirstWordWithoutSpinning) {
  Mission mission = realtime_mission();
  mission.wait_for_logger = true;
  World world = running_world(mission);
  EXPECT_TRUE(advance(world, at(1s)).empty());
  EXPECT_GT(world.next_wakeup(), at(1s));
  world.receive(ack_of(-1), at(2s));
  EXPECT_EQ(state_after(world, at(2s)).header.tick, 0);
  EXPECT_EQ(state_after(world, at(2100ms)).header.tick, 1);
  EXPECT_EQ(world.skipped_ticks(), 0) << "the wait is no delay";
}

TEST(WorldInRealTime, EndsAfterItsLastTick) {
  Mission mission = realtime_mission();
  mission.timing.tick_count = 2;
  World world = running_world(mission);
  advance(world, at(0s));
  advance(world, at(100ms));
  EXPECT_EQ(state_after(world, at(200ms)).header.tick, 2);
  EXPECT_EQ(state_after(world, at(500ms)).header.tick, 2) << "repeated, it goes no further";
  advance(world, at(2201ms));
  EXPECT_TRUE(world.finished());
}

// ---- the end -------------------------------------------------------------------------------------

TEST(WorldEnd, RepeatsTheLastStateForTwoSecondsAndIsDone) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 1;
  World world = running_world(mission);
  advance(world, at(0s));
  world.receive(command_of(0, 0, {1, 0}), at(1s));
  EXPECT_EQ(state_after(world, at(1s)).header.tick, 1);
  advance(world, at(1s));
  world.receive(command_of(0, 1, {1, 0}), at(1s));
  EXPECT_EQ(state_after(world, at(2900ms)).header.tick, 1);
  EXPECT_FALSE(world.finished());
  advance(world, at(3001ms));
  EXPECT_TRUE(world.finished());
  EXPECT_EQ(world.reason(), "mission complete");
  EXPECT_EQ(world.next_wakeup(), Instant::max());
}

TEST(WorldEnd, TheMissionsEndAStopAndItsProcessEndItAtOnce) {
  World by_mission = running_world(small_mission(1));
  by_mission.receive(mission_part(1, MissionState::kFailed, roster_of(1), "agent 3 is late"), at(0s));
  EXPECT_TRUE(by_mission.finished());
  EXPECT_EQ(by_mission.reason(), "agent 3 is late");
  EXPECT_TRUE(advance(by_mission, at(1s)).empty()) << "and it moves nobody any more";

  World by_stop = running_world(small_mission(1));
  by_stop.receive(Stop{{kRun + 1, kOperator, 1, 1, 0}, false, "another run's"}, at(0s));
  EXPECT_FALSE(by_stop.finished());
  by_stop.receive(Stop{{kRun, kOperator, 1, 1, 0}, false, "enough"}, at(0s));
  EXPECT_TRUE(by_stop.finished());
  EXPECT_EQ(by_stop.reason(), "enough");

  World by_process = running_world(small_mission(1));
  by_process.stop("SIGTERM");
  EXPECT_TRUE(by_process.finished());
  EXPECT_EQ(by_process.reason(), "SIGTERM");
}

TEST(WorldEnd, APlanItCannotReadEndsIt) {
  World world(kRun, kWorldLife, [](auto) { return std::nullopt; });
  world.receive(mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  EXPECT_TRUE(world.finished());
  EXPECT_EQ(world.reason(), "the mission plan is another version's");
}

}  // namespace
}  // namespace ergocast
