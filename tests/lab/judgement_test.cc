// SPDX-License-Identifier: BSD-3-Clause
// The laboratory's judgement of a mission: it excuses effects that the faults can have caused, and
// no others; and it detects a message without a subscription.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

using lab::Faults;
using lab::Invariant;
using lab::TrialResult;

/// A shipped team, with something else in its scenario's text.
Scenario team(Pace pace, const std::string& from = "", const std::string& to = "",
              const std::string& name = "faulty_team") {
  std::ifstream file(ERGOCAST_SCENARIO_DIR "/" + name + ".textproto");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Overrides overrides;
  overrides.pace = pace;
  return Scenario::parse(with(text, from, to), name, overrides).value();
}

TrialResult run_trial(const Scenario& scenario, std::uint64_t seed, const Faults& faults,
                      const SubscriptionTable& subscriptions = kSubscriptions) {
  return TriedTeam(faults, seed, scenario, subscriptions).result;
}

std::optional<Invariant> broken(const TrialResult& result) {
  return result.violation ? std::optional(result.violation->invariant) : std::nullopt;
}
std::string problem(const TrialResult& result) {
  return result.violation ? to_string(*result.violation) : "";
}

/// One kind of message that a role receives on a bus.
struct Heard {
  Role role;
  Bus bus;
  std::size_t type;
};

std::vector<Heard> heard_in_the_laboratory() {
  std::vector<Heard> all;
  for (const Role role : {Role::kAgent, Role::kCoordinator, Role::kWorld, Role::kLogger}) {
    for (const Bus bus : {Bus::kSwarm, Bus::kWorld, Bus::kCommand}) {
      for (std::size_t type = 0; type < kMessageTypeCount; ++type) {
        const MessageTypes types = subscriptions_of(role)[static_cast<std::size_t>(bus)];
        if ((types >> type & 1) != 0) all.push_back({role, bus, type});
      }
    }
  }
  return all;
}

SubscriptionTable without(const Heard& heard) {
  SubscriptionTable table = kSubscriptions;
  table[static_cast<std::size_t>(heard.role)][static_cast<std::size_t>(heard.bus)] &=
      ~(MessageTypes{1} << heard.type);
  return table;
}

/// Whether the laboratory cannot notice that a kind is missing; each case has its reason.
bool never_missed(const Heard& heard) {
  const MessageTypes type = MessageTypes{1} << heard.type;
  // No operator sends STOP here, and no second agent of a number or second coordinator is started;
  // the tests of real processes do that.
  if (type == kTypes<Stop>) return true;
  // Its operator sends pauses and recalls directly to the coordinator.
  if (type == kTypes<Amend> || type == kTypes<Recall>) return true;
  if (heard.role == Role::kAgent) return type == kTypes<AgentStatus>;
  if (heard.role == Role::kCoordinator) {
    // In lockstep the world asks only the agent that it waits for at its start.
    const bool question = type == kTypes<Hello> && heard.bus == Bus::kWorld;
    // The logger's farewell only spares it a second.
    return type == kTypes<TeamStatus> || type == kTypes<RecordAck> || question;
  }
  // The logger records everything for later readers of the event log; its tables need this only.
  return heard.role == Role::kLogger && !(type == kTypes<WorldState> && heard.bus == Bus::kWorld);
}

TEST(Laboratory, MissesEachMessageThatARoleDoesNotSubscribeTo) {
  const Scenario real_time = team(Pace::kRealtime);
  // The time-out is no excuse: all are back long before.
  const Scenario crowded =
      team(Pace::kLockstep, "time {", "time { lockstep_timeout_s: 60", "crowded_team");
  // Without beacons no agent moves there.
  const Scenario hearsay = team(Pace::kRealtime, "time {",
                                "separation { distance_m: 6 lease_s: 3 }\n"
                                "world { speed_limit_mps: 10 }\ntime { command_hold_s: 0");
  EXPECT_EQ(problem(run_trial(hearsay, 1, lab::drawn(1))), "");
  // In lockstep no agent that searches goes on without its teammates' looks.
  const Scenario searching = team(Pace::kLockstep, "law {", "law { kind: SEARCH ");
  EXPECT_EQ(problem(run_trial(searching, 1, lab::drawn(1))), "");
  for (const Heard& heard : heard_in_the_laboratory()) {
    // A world receives states only where bodies keep a distance.
    const bool of_bodies =
        heard.role == Role::kWorld && MessageTypes{1} << heard.type == kTypes<WorldState>;
    bool missed = false;
    for (std::uint64_t seed = 1; seed <= (never_missed(heard) ? 1 : 40) && !missed; ++seed) {
      const bool of_places = MessageTypes{1} << heard.type == kTypes<Beacon>;
      const bool of_looks = MessageTypes{1} << heard.type == kTypes<Effort>;
      const Scenario& scenario = of_places   ? hearsay
                                 : of_looks  ? searching
                                 : of_bodies ? crowded
                                             : real_time;
      missed = run_trial(scenario, seed, lab::drawn(seed), without(heard)).violation.has_value();
    }
    EXPECT_EQ(missed, !never_missed(heard))
        << "role " << static_cast<int>(heard.role) << ", bus " << static_cast<int>(heard.bus)
        << ", message kind " << heard.type;
  }
}

// ---- radio range ----

TEST(RadioRange, IsNoFault) {
  const std::uint64_t seeds = std::getenv("ERGOCAST_TRIALS") != nullptr ? 10 : 4;
  for (const char* range : {"30", "50", "80"}) {
    for (const Pace pace : {Pace::kRealtime, Pace::kLockstep}) {
      const Scenario limited =
          team(pace, "\nlaw {", "\nworld { radio_range_m: " + std::string(range) + " }\nlaw {");
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        // Whether the goal is reached with such a radio depends on the scenario.
        for (const TrialResult& result :
             {run_trial(limited, seed, {}), run_trial(limited, seed, lab::drawn(seed))}) {
          if (broken(result) != Invariant::kGoalReached) {
            EXPECT_EQ(problem(result), "") << range << " m, seed " << seed;
          }
        }
      }
    }
  }
}

// A chain of four that hardly move, in which no agent receives the next but one.
TEST(RadioRange, ExcusesNoAgentFromPassingOnWhatItReceives) {
  const auto chain = Scenario::parse(R"(
    domain { size_x_m: 100 size_y_m: 100 }
    target { uniform_weight: 1 }
    basis { modes_x: 4 modes_y: 4 }
    law { u_max_mps: 1 }
    world { radio_range_m: 40 speed_limit_mps: 0.01 }
    time { duration_s: 60 broadcast_period_ticks: 5 pace: REALTIME }
    agents { starts { x_m: 5 y_m: 50 } starts { x_m: 35 y_m: 50 } starts { x_m: 65 y_m: 50 } starts { x_m: 95 y_m: 50 } }
  )",
                                     "chain")
                         .value();
  EXPECT_EQ(problem(run_trial(chain, 1, {})), "");
  const Heard digests{Role::kAgent, Bus::kSwarm, Message(Digest()).index()};
  EXPECT_EQ(broken(run_trial(chain, 1, {}, without(digests))), Invariant::kEverybodyLearnsEveryRow);
}

// ---- time-outs and evictions ----

Scenario evicting() {
  return team(Pace::kLockstep, "admission_timeout_s: 3600",
              "admission_timeout_s: 3600 lockstep_timeout_s: 3 on_timeout: EVICT");
}

TEST(Eviction, OfAnAgentThatWasAwayIsNoFault) {
  int evicted = 0;
  for (std::uint64_t seed = 1; seed <= 80; ++seed) {
    Faults faults;
    faults.loss = 0.9;
    faults.swarm_bus_only = 1;
    const TrialResult result = run_trial(evicting(), seed, faults);
    // The remaining agents need not reach the goal of the whole team.
    const bool smaller = result.figures.evictions > 0;
    if (!smaller || broken(result) != Invariant::kGoalReached) {
      EXPECT_EQ(problem(result), "") << seed;
    }
    evicted += result.figures.evictions > 0;
  }
  EXPECT_GE(evicted, 3);
}

// A mission that continues for long after all agents are back is judged only once.
TEST(Eviction, IsJudgedByWhatWasWrongWhenItHappened) {
  int evicted = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Faults faults;
    faults.delay_mean_s = 0.05;
    faults.delay_max_s = 0.1;
    faults.partitions_per_s = 0.03;
    faults.partition_max_s = 10;
    const TrialResult result = run_trial(evicting(), seed, faults);
    EXPECT_EQ(problem(result), "") << seed;
    evicted += result.figures.evictions > 0;
  }
  EXPECT_GE(evicted, 3);
}

// In these runs all agents were evicted before the coordinator was to be killed. They had ended,
// and no other process could have sent the mission to its successor.
TEST(Eviction, OfTheLastSparesTheCoordinatorThatAloneKnowsTheMissionThen) {
  for (const std::uint64_t seed : {751, 4022}) {
    Faults faults = lab::drawn(seed);
    faults.recalls_per_s = 0;
    const TrialResult result = run_trial(evicting(), seed, faults);
    EXPECT_EQ(problem(result), "") << seed;
    EXPECT_GE(result.figures.evictions, 1) << seed;
  }
}

// In this run the coordinator was to be killed while no agent knew the mission.
TEST(Eviction, LeavesTheCoordinatorAloneWhileNoOtherProcessKnowsTheMission) {
  EXPECT_EQ(problem(run_trial(evicting(), 558, lab::drawn(558))), "");
}

TEST(Eviction, OfAnAgentThatWasThereIsAFault) {
  const Heard states{Role::kAgent, Bus::kWorld, Message(WorldState()).index()};
  EXPECT_EQ(broken(run_trial(evicting(), 1, {}, without(states))), Invariant::kNoEarlyEnd);
}

TEST(TimeOut, OfAnAdmissionIsAFaultUnlessAProcessWasAway) {
  const Heard hellos{Role::kCoordinator, Bus::kSwarm, Message(Hello()).index()};
  Faults deaf;
  deaf.loss = 1;
  for (const Pace pace : {Pace::kRealtime, Pace::kLockstep}) {
    const Scenario scenario = team(pace, "admission_timeout_s: 3600", "admission_timeout_s: 5");
    EXPECT_EQ(broken(run_trial(scenario, 1, {}, without(hellos))), Invariant::kMissionDoesNotFail);
    const TrialResult excused = run_trial(scenario, 1, deaf);
    EXPECT_EQ(problem(excused), "");
    EXPECT_TRUE(excused.timed_out);
  }
}

TEST(TimeOut, OfATickIsAFaultIfNoProcessWasAway) {
  const Heard states{Role::kAgent, Bus::kWorld, Message(WorldState()).index()};
  Faults harmless;  // nothing that could hold up a tick for ten seconds
  harmless.duplication = 0.3;
  harmless.delay_mean_s = 0.01;
  harmless.delay_max_s = 0.05;
  EXPECT_EQ(broken(run_trial(team(Pace::kLockstep), 1, harmless, without(states))),
            Invariant::kMissionDoesNotFail);
}

}  // namespace
}  // namespace ergocast::test
