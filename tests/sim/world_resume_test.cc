// SPDX-License-Identifier: BSD-3-Clause
// A restarted world continues where the team was, from the agents' answers. In lockstep the result
// is the same bit for bit, whenever the world stopped.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/agent/live_team.h"
#include "tests/sim/driven_world.h"

namespace ergocast {
namespace {

using namespace test;

// ---- lockstep, with real agents ----

/// Which of three agents received the tick at which the world stopped. None of their answers
/// reached it.
struct Death {
  Tick tick;
  bool heard[3];
};

/// A lockstep mission of three agents. Checks that no tick is sent with two contents.
class ResumedMission {
 public:
  using Published = std::map<Tick, std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>>;

  explicit ResumedMission(const Mission& mission)
      : mission_(mission), team_(mission), world_(begin(1)) {}

  /// Runs until the team has answered tick `end`.
  void run_until(Tick end) {
    while (world_.tick() < end) {
      now_ += 10ms;
      for (const WorldState& state : only<WorldState>(step_world()))
        obey(team_.deliver(state, now_));
    }
  }

  /// The world stops at `death` and another begins.
  void restart(const Death& death) {
    run_until(death.tick - 1);
    now_ += 10ms;
    for (const WorldState& state : only<WorldState>(step_world())) {
      for (AgentId id = 0; id < 3; ++id) {
        if (death.heard[id]) give(team_[id], state, now_);
      }
    }
    team_.settle(now_);  // their messages reach no world
    world_ = begin(++lives_);
    while (!world_.begun_at()) {
      now_ += 10ms;
      for (const Hello& question : only<Hello>(step_world())) obey(team_.deliver(question, now_));
    }
    EXPECT_GE(*world_.begun_at(), death.tick - 1);
    EXPECT_LE(*world_.begun_at(), death.tick);
  }

  const Published& published() const { return published_; }

 private:
  World begin(Incarnation life) const {
    announce(mission_);
    World world(kRun, life);
    give(world, mission_part(0, MissionState::kRunning, roster_of(3)), now_);
    if (life == 1) nobody_has_moved(world, 3, now_, life);
    return world;
  }

  Outbox step_world() {
    Outbox out = advance(world_, now_);
    for (const WorldState& state : only<WorldState>(out)) {
      std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> vehicles;
      for (int i = 0; i < state.vehicle_count; ++i) {
        const Vehicle& vehicle = state.vehicles[static_cast<std::size_t>(i)];
        vehicles.emplace_back(vehicle.position_m, vehicle.velocity_mps);
      }
      const auto [known, is_new] = published_.emplace(state.header.tick, vehicles);
      EXPECT_EQ(known->second, vehicles) << "tick " << state.header.tick;
    }
    return out;
  }

  void obey(const Outbox& sent) {
    for (const Command& command : only<Command>(sent)) give(world_, command, now_);
  }

  Mission mission_;
  LiveTeam team_;
  Instant now_ = at(1s);
  Incarnation lives_ = 1;
  World world_;
  Published published_;
};

/// Broadcasts every fourth tick, so that some agents may answer a tick that others have not
/// received.
Mission lively_mission(double disturbance) {
  Mission mission = small_mission(3);
  mission.target_coefficients[4] = 0.3;
  mission.law.noise_intensity = 2;
  mission.timing.broadcast_period_ticks = 4;
  mission.disturbance_intensity = disturbance;
  return mission;
}

class WorldRestarted : public ::testing::TestWithParam<double> {};

TEST_P(WorldRestarted, AtEveryMomentOfATickChangesNothing) {
  const Mission mission = lively_mission(GetParam());
  ResumedMission undisturbed(mission);
  undisturbed.run_until(16);
  for (Tick tick = 0; tick < 10; ++tick) {
    for (unsigned heard = 0; heard < 8; ++heard) {
      SCOPED_TRACE("died at tick " + std::to_string(tick) + ", heard by " + std::to_string(heard));
      ResumedMission resumed(mission);
      resumed.restart({tick, {(heard & 1) != 0, (heard & 2) != 0, (heard & 4) != 0}});
      resumed.run_until(16);
      EXPECT_EQ(resumed.published(), undisturbed.published());
    }
  }
}

TEST_P(WorldRestarted, AgainAndAgainChangesNothing) {
  const Mission mission = lively_mission(GetParam());
  ResumedMission undisturbed(mission), resumed(mission);
  undisturbed.run_until(16);
  for (Tick tick = 0; tick < 15; ++tick) resumed.restart({tick, {true, tick % 2 == 0, false}});
  resumed.run_until(16);
  EXPECT_EQ(resumed.published(), undisturbed.published());
}

INSTANTIATE_TEST_SUITE_P(Disturbance, WorldRestarted, ::testing::Values(0.0, 3.0),
                         [](const auto& of) { return of.param > 0 ? "On" : "Off"; });

// ---- what the team's answers mean ----

/// One of an agent's two answers to the question.
Command command_from(AgentId id, Tick tick, const Eigen::Vector3d& x_m,
                     const Eigen::Vector3d& v_mps) {
  Command command = command_of(id, tick, v_mps);
  command.position_m = x_m;
  command.asked_by = kWorldLife;
  return command;
}

/// A world that asks its team where it was, since 0 s.
World asking_world(const Mission& mission) {
  World world = world_of(mission);
  const auto team = static_cast<int>(mission.starts_m.size());
  give(world, mission_part(0, MissionState::kRunning, roster_of(team)), at(0s));
  advance(world, at(0s));
  return world;
}

TEST(WorldAsks, TenTimesASecondAndMovesNoVehicleMeanwhile) {
  World world = asking_world(small_mission(2));
  nobody_has_moved(world, 1, at(0s));
  int questions = 0;
  for (int ms = 10; ms <= 1000; ms += 10) {
    for (const Outgoing& outgoing : advance(world, at(ms * 1ms))) {
      const auto* question = std::get_if<Hello>(&outgoing.message);
      ASSERT_NE(question, nullptr);
      EXPECT_EQ(question->header.tick, 0);
      ++questions;
    }
  }
  EXPECT_EQ(questions, 10);
  EXPECT_LE(world.next_wakeup(), at(1100ms));
}

TEST(WorldAsks, BeginsInRealTimeWithoutASilentAgentAfterTwoSeconds) {
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  World world = asking_world(mission);
  give(world, command_from(0, 8, {300, 400, 0}, {1, 0, 0}), at(0s));
  give(world, command_from(0, 9, {301, 401, 0}, {0, 1, 0}), at(0s));
  EXPECT_TRUE(only<WorldState>(advance(world, at(1999ms))).empty());
  const auto states = only<WorldState>(advance(world, at(2s)));
  ASSERT_EQ(states.size(), 1u);
  EXPECT_EQ(world.begun_at(), 9);
  EXPECT_EQ(states[0].header.tick, 9);
  EXPECT_EQ(place(states[0], 0), Eigen::Vector3d(301, 401, 0));
  EXPECT_EQ(applied(states[0], 0), Eigen::Vector3d(1, 0, 0)) << "in the step that led here";
  EXPECT_EQ(place(states[0], 1), mission.starts_m[1]) << "no process knows better";
}

// Each agent may be the only one that received the former world's last tick, and no other process
// knows its position.
TEST(WorldAsks, InLockstepUntilAllAgentsHaveAnswered) {
  World world = asking_world(small_mission(2));
  for (const Tick tick : {8, 9})
    give(world, command_from(0, tick, {300, 400, 0}, {1, 0, 0}), at(0s));
  for (int s = 1; s <= 20; ++s) EXPECT_TRUE(states_after(world, at(s * 1s)).empty()) << s << " s";
  for (const Tick tick : {9, 10})
    give(world, command_from(1, tick, {700, 500, 0}, {0, 10, 0}), at(21s));
  const WorldState state = state_after(world, at(21s));
  EXPECT_EQ(state.header.tick, 10);
  EXPECT_EQ(place(state, 0), Eigen::Vector3d(300.1, 400, 0)) << "a tick further, by its command";
  EXPECT_EQ(place(state, 1), Eigen::Vector3d(700, 500, 0));
}

TEST(WorldAsks, WithTheNumberOfTheFirstThatHasNotAnswered) {
  World world = asking_world(small_mission(3));
  const auto asked_for = [&](Instant now) {
    return only<Hello>(advance(world, now)).at(0).requested_id;
  };
  EXPECT_EQ(asked_for(at(100ms)), 0);
  nobody_has_moved(world, 1, at(100ms));
  EXPECT_EQ(asked_for(at(200ms)), 1);
  give(world, command_from(1, 9, {301, 401, 0}, {0, 1, 0}), at(200ms));
  EXPECT_EQ(asked_for(at(300ms)), 1) << "that is half an answer";
  give(world, command_from(1, 8, {300, 400, 0}, {1, 0, 0}), at(300ms));
  EXPECT_EQ(asked_for(at(400ms)), 2);
}

TEST(WorldAsks, InLockstepNoAgentThatHasLeftTheRosterMeanwhile) {
  World world = asking_world(small_mission(2));
  for (const Tick tick : {8, 9})
    give(world, command_from(0, tick, {300, 400, 0}, {1, 0, 0}), at(0s));
  auto roster = roster_of(2);
  roster[1].active_until = 9;
  give(world, mission_part(1, MissionState::kRunning, roster), at(5s));
  EXPECT_EQ(state_after(world, at(5s)).header.tick, 9);
}

// Agents without a position answer with (0, 0), which may be outside of the domain.
TEST(WorldAsks, BeginsAtOnceInADomainFarFromTheOrigin) {
  Mission mission = small_mission(2);
  const Eigen::Vector3d far_m(512300, 5403700, 0);
  mission.domain.origin_m += far_m;
  for (Eigen::Vector3d& start_m : mission.starts_m) start_m += far_m;
  World world = asking_world(mission);
  nobody_has_moved(world, 2, at(0s));
  const WorldState state = state_after(world, at(1ms));
  EXPECT_EQ(state.header.tick, 0);
  EXPECT_EQ(place(state, 1), mission.starts_m[1]);
}

/// The first state of a world of one agent that received these commands in this order.
WorldState begun_with(const std::vector<Command>& published) {
  World world = asking_world(small_mission(1));
  for (const Command& command : published) give(world, command, at(0s));
  return state_after(world, at(1ms));
}

TEST(WorldAsks, TheOrderOfTheAnswersDoesNotMatter) {
  const Command before = command_from(0, 8, {300, 400, 0}, {1, 0, 0});
  const Command last = command_from(0, 9, {301, 401, 0}, {0, 1, 0});
  for (const auto& published : {std::vector{before, last}, std::vector{last, before}}) {
    const WorldState state = begun_with(published);
    EXPECT_EQ(state.header.tick, 9);
    EXPECT_EQ(place(state), Eigen::Vector3d(301, 401, 0));
    EXPECT_EQ(applied(state), Eigen::Vector3d(1, 0, 0));
  }
}

TEST(WorldAsks, OneOfTwoCommandsIsHalfAnAnswer) {
  World world = asking_world(small_mission(1));
  give(world, command_from(0, 9, {301, 401, 0}, {0, 1, 0}), at(0s));
  EXPECT_TRUE(only<WorldState>(advance(world, at(1ms))).empty());
  EXPECT_EQ(only<Hello>(advance(world, at(100ms))).size(), 1u) << "it asks again";
  give(world, command_from(0, 8, {300, 400, 0}, {1, 0, 0}), at(101ms));
  EXPECT_EQ(applied(state_after(world, at(101ms))), Eigen::Vector3d(1, 0, 0));
}

/// An agent that has answered only tick 0 first sends a command without a tick.
TEST(WorldAsks, HalfAnAnswerDoesNotMeanThatThereIsNone) {
  const auto halves = [](AgentId id, Tick last, std::int64_t sequence) {
    std::vector<Command> sent = {command_from(id, -1, {0, 0, 0}, {0, 0, 0}),
                                 command_from(id, last, {700, 500, 0}, {0, 10, 0})};
    sent[0].header.sequence = sequence;
    sent[1].header.sequence = sequence + 1;
    return sent;
  };
  for (const Tick last : {0, -1}) {
    World world = asking_world(small_mission(2));
    for (const Command& half : halves(0, 0, 1)) give(world, half, at(0s));
    for (const std::int64_t sequence : {1, 3, 5}) {  // each time the other half is lost
      const Command half = halves(1, 0, sequence)[0];
      give(world, half, at(0s));
      give(world, half, at(0s));
    }
    EXPECT_TRUE(states_after(world, at(1s)).empty());
    give(world, halves(1, last, 5)[1], at(1s));
    EXPECT_EQ(place(state_after(world, at(1s)), 1),
              last == 0 ? Eigen::Vector3d(700, 500, 0) : small_mission(2).starts_m[1]);
  }
}

TEST(WorldAsks, IgnoresAnswersToAnotherProcess) {
  World world = asking_world(small_mission(1));
  for (const Incarnation asked_by : {Incarnation{0}, kWorldLife - 1}) {
    for (const Tick tick : {4, 5}) {
      Command recording = command_from(0, tick, {300, 400, 0}, {1, 0, 0});
      recording.asked_by = asked_by;
      give(world, recording, at(0s));
    }
  }
  EXPECT_TRUE(states_after(world, at(1ms)).empty()) << "earlier answers do not have its place";
  for (const Tick tick : {8, 9})
    give(world, command_from(0, tick, {301, 401, 0}, {0, 1, 0}), at(1s));
  EXPECT_EQ(state_after(world, at(1s)).header.tick, 9);
}

TEST(WorldAsks, IgnoresAnswersWithImpossibleTicksOrPlaces) {
  const Mission mission = small_mission(1);
  World world = asking_world(mission);
  give(world, command_from(0, mission.timing.tick_count + 1, {300, 400, 0}, {0, 0, 0}), at(0s));
  give(world, command_from(0, 50, {-1, 400, 0}, {0, 0, 0}), at(0s));
  Command stranger = command_from(0, 50, {300, 400, 0}, {0, 0, 0});
  stranger.header.incarnation = 99;
  give(world, stranger, at(0s));
  EXPECT_TRUE(states_after(world, at(2s)).empty()) << "no agent has answered";
  nobody_has_moved(world, 1, at(3s));
  const WorldState state = state_after(world, at(3s));
  EXPECT_EQ(state.header.tick, 0);
  EXPECT_EQ(place(state), mission.starts_m[0]);
}

TEST(WorldAsks, NotTheRosterForATickBeyondThePlan) {
  const Mission mission = small_mission(1);
  World world = world_of(mission);
  auto roster = roster_of(1);
  roster.push_back({{0, 99}, 0, Tick{1} << 47});
  give(world, mission_part(0, MissionState::kRunning, roster), at(0s));
  nobody_has_moved(world, 1, at(0s));
  advance(world, at(0s));
  EXPECT_EQ(world.tick(), mission.timing.tick_count);
}

// ---- real time ----

TEST(WorldResumesInRealTime, AVehicleThatIsBehindHasGoneOnWithItsHeldCommand) {
  for (const double hold_s : {10.0, 0.1}) {
    Mission mission = small_mission(2);
    mission.timing.pace = Pace::kRealtime;
    mission.timing.command_hold_s = hold_s;
    World world = asking_world(mission);
    for (const Tick tick : {9, 10})
      give(world, command_from(0, tick, {500, 500, 0}, {10, 0, 0}), at(0s));
    for (const Tick tick : {6, 7})
      give(world, command_from(1, tick, {700, 500, 0}, {0, 10, 0}), at(0s));
    const WorldState state = state_after(world, at(5ms));
    EXPECT_EQ(state.header.tick, 10);
    EXPECT_EQ(place(state, 0), Eigen::Vector3d(500, 500, 0));
    // It goes from tick 7 to 10 in three steps of 1 m; with a hold of 0.1 s the third has no
    // command.
    EXPECT_EQ(place(state, 1), Eigen::Vector3d(700, hold_s > 1 ? 503 : 502, 0));
    EXPECT_EQ(applied(state, 1), Eigen::Vector3d(0, hold_s > 1 ? 10 : 0, 0));
    EXPECT_EQ(state_after(world, at(105ms)).header.tick, 11) << "and the clock goes on from here";
  }
}

// ---- the mission ----

TEST(WorldWithoutAMission, AsksForItAfterASecondAndAHalfIfItKnowsTheRun) {
  World world = world_of(small_mission(1));
  EXPECT_TRUE(advance(world, at(10s)).empty());
  EXPECT_EQ(world.next_wakeup(), at(11500ms)) << "the coordinator sends each second";
  EXPECT_TRUE(advance(world, at(11499ms)).empty());
  for (const Instant now : {at(11500ms), at(13s)}) {
    const Outbox out = advance(world, now);
    ASSERT_EQ(out.size(), 1u);
    EXPECT_EQ(out[0].bus, Bus::kWorld);
    const auto& question = std::get<Hello>(out[0].message);
    EXPECT_EQ(question.header.run, kRun);
    EXPECT_EQ(question.header.sender, kWorld);
    EXPECT_EQ(question.header.tick, -1) << "it does not know the mission";
  }
}

TEST(WorldWithoutAMission, WaitsForTheFirstItReceivesIfItKnowsNoRun) {
  announce(small_mission(1));
  World world(0, kWorldLife);
  for (int second = 0; second < 10; ++second) EXPECT_TRUE(advance(world, at(second * 1s)).empty());
  EXPECT_EQ(world.next_wakeup(), Instant::max());
  give(world, mission_part(0, MissionState::kRunning, roster_of(1)), at(10s));
  EXPECT_EQ(world.run(), kRun);
}

TEST(WorldWithoutAMission, AsksNoMoreOnceItWaitsForTheStart) {
  World world = world_of(small_mission(1));
  advance(world, at(10s));
  give(world, mission_part(0, MissionState::kWaiting, roster_of(1)), at(11s));
  EXPECT_TRUE(advance(world, at(20s)).empty());
}

// ---- the record ----

TEST(WorldRecord, ARestartedLoggerMayHaveLessThanItsPredecessorHad) {
  Mission mission = small_mission(1);
  mission.wait_for_logger = true;
  World world = running_world(mission);
  const auto run_while_it_goes = [&](Instant now) {
    while (!states_after(world, now).empty()) {
      give(world, command_of(0, world.tick(), {1, 0, 0}), now);
    }
  };
  give(world, ack_of(10), at(0s));
  run_while_it_goes(at(0s));
  EXPECT_EQ(world.tick(), 75);
  RecordAck successors = ack_of(5);
  successors.header.incarnation = kLoggerLife + 1;
  give(world, successors, at(1s));
  std::vector<Tick> repeated;
  for (const WorldState& state : states_after(world, at(2s))) repeated.push_back(state.header.tick);
  // The next row that it lacks, and the state after it; a state that is no longer stored is a gap.
  ASSERT_FALSE(repeated.empty());
  EXPECT_EQ(repeated.front(), 74);
  give(world, ack_of(3), at(2s));
  run_while_it_goes(at(2s));
  EXPECT_EQ(world.tick(), 75) << "it has still 64 ticks to go";
  successors.header.tick = 20;
  ++successors.header.sequence;
  give(world, successors, at(3s));
  run_while_it_goes(at(3s));
  EXPECT_EQ(world.tick(), 85);
}

TEST(WorldRecord, RepeatedMessagesOfAStoppedLoggerDoNotKeepTheTeamWaiting) {
  Mission mission = small_mission(1);
  mission.wait_for_logger = true;
  mission.timing.lockstep_timeout_s = 10;
  World world = running_world(mission);
  const RecordAck dead = ack_of(-1);
  RecordAck alive = ack_of(-1);
  alive.header.incarnation = kLoggerLife + 1;
  give(world, dead, at(0s));
  give(world, alive, at(0s));
  for (int i = 0; i < 200 && world.tick() <= 64; ++i) {
    states_after(world, at(0s));
    give(world, command_of(0, world.tick(), {1, 0, 0}), at(0s));
  }
  for (int tenths = 0; tenths < 60; ++tenths) {
    const Instant now = at(tenths * 100ms);
    for (const RecordAck& replayed : {dead, alive}) give(world, replayed, now);
    states_after(world, now);
  }
  EXPECT_TRUE(world.logger_lost());
}

}  // namespace
}  // namespace ergocast
