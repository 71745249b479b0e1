// SPDX-License-Identifier: BSD-3-Clause
// Lockstep waits only for what is repeated. If any kind of message is lost, the mission still ends,
// and its trajectory is the one without losses, bit for bit. With dead reckoning it is also the
// same however seldom the agents broadcast.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/base/noise.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

constexpr const char* kThreeAgents = R"(
domain { size_x_m: 100 size_y_m: 80 }
target { gaussians { mean_x_m: 30 mean_y_m: 40 sigma_m: 10 } uniform_weight: 0.5 }
basis { modes_x: 12 modes_y: 12 }
law { u_max_mps: 5 }
time { duration_s: 20 lockstep_timeout_s: 10 }
agents { starts { x_m: 0 y_m: 0 } starts { x_m: 50 y_m: 40 } starts { x_m: 100 y_m: 80 } }
)";

constexpr int kAgents = 3;

constexpr const char* kMessageTypes[] = {"Hello",       "MissionPart", "Contribution",
                                         "AgentStatus", "TeamStatus",  "Stop",
                                         "WorldState",  "Command",     "RecordAck"};

struct Outcome {
  std::string trajectory;
  MissionState state;
  std::string reason;
  std::int64_t dropped;
  bool in_time;
};

Outcome simulated(const Drop& drop, const std::string& text = kThreeAgents,
                  const Amendments& amendments = {}) {
  const auto scenario = Scenario::parse(text, "loss").value();
  std::int64_t dropped = 0;
  SimulatedTeam team(
      scenario.mission(),
      [&](const Message& message, lab::NodeId to) {
        const bool drops = drop && drop(message, to);
        dropped += drops;
        return drops;
      },
      amendments);
  const bool in_time = team.run(std::chrono::minutes(30));
  return {team.trajectory.str(), team.state(), team.reason(), dropped, in_time};
}

const std::string& lossless() {
  static const std::string trajectory = simulated({}).trajectory;
  return trajectory;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Drops `percent` of the messages of one kind, for each receiver separately.
Drop dropping(std::size_t kind, std::uint64_t percent) {
  return [=, count = std::uint64_t{0}](const Message& message, int) mutable {
    if (message.index() != kind) return false;
    return random_words(5, Purpose::kFault, static_cast<std::uint32_t>(kind), ++count).first % 100 <
           percent;
  };
}

TEST(MessageLoss, NothingIsDroppedWithoutAFault) {
  const Outcome outcome = simulated({});
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_EQ(outcome.dropped, 0);
  EXPECT_EQ(lines(outcome.trajectory), 1U + 3 * 200);
}

/// Whether a message announces that the world, the logger or an agent leaves.
bool says_farewell(const Message& message) {
  const auto* world = std::get_if<WorldState>(&message);
  const auto* logger = std::get_if<RecordAck>(&message);
  const auto* agent = std::get_if<AgentStatus>(&message);
  return (world != nullptr && world->last) || (logger != nullptr && logger->last) ||
         (agent != nullptr && agent->phase == AgentPhase::kFinished);
}

TEST(MessageLoss, AllLeaveAtOnceButForLostFarewells) {
  const auto scenario = Scenario::parse(kThreeAgents, "loss").value();
  const auto takes = [&](const Drop& drop) {
    SimulatedTeam team(scenario.mission(), drop);
    EXPECT_TRUE(team.run());
    EXPECT_EQ(team.trajectory.str(), lossless());
    return team.simulation.now().time_since_epoch();
  };
  EXPECT_LT(takes({}), std::chrono::milliseconds(100));
  EXPECT_GE(takes([](const Message& message, int) { return says_farewell(message); }),
            std::chrono::seconds(1));
}

class EachKind : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EachKind, LosingAThirdChangesNoTrajectory) {
  const Outcome outcome = simulated(dropping(GetParam(), 33));
  EXPECT_TRUE(outcome.in_time);
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_EQ(outcome.trajectory, lossless());
}

TEST_P(EachKind, LosingFourOfFiveEndsTheMissionAllTheSame) {
  const Outcome outcome = simulated(dropping(GetParam(), 80));
  EXPECT_TRUE(outcome.in_time);
  // A late admission starts the mission late, but the mission is the same.
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_EQ(outcome.trajectory, lossless());
}

TEST_P(EachKind, LosingAllIsDecidedByTheCoordinatorAtTheLatest) {
  const Outcome outcome = simulated(dropping(GetParam(), 100));
  EXPECT_TRUE(outcome.state == MissionState::kEnded || outcome.state == MissionState::kFailed);
  // Only an agent that never receives a mission waits for one for ever.
  EXPECT_TRUE(outcome.in_time || std::string(kMessageTypes[GetParam()]) == "MissionPart");
}

INSTANTIATE_TEST_SUITE_P(MessageLoss, EachKind, ::testing::Range(std::size_t{0}, std::size_t{9}),
                         [](const auto& kind) { return std::string(kMessageTypes[kind.param]); });

TEST(MessageLoss, EveryKindAtOnceChangesNoTrajectory) {
  const Outcome outcome = simulated([count = std::uint64_t{0}](const Message&, int) mutable {
    return random_words(6, Purpose::kFault, 0, ++count).first % 100 < 10;
  });
  EXPECT_GT(outcome.dropped, 100);
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_EQ(outcome.trajectory, lossless());
}

TEST(MessageLoss, LosingTheLastStateOnceDoesNoHarm) {
  // The record is complete with the 192nd row, which is acknowledged at once.
  const std::string text = with(kThreeAgents, "duration_s: 20", "duration_s: 19.2");
  for (const int node : {0, kAgents, kAgents + 2}) {  // an agent, the coordinator, the logger
    const Outcome outcome = simulated(
        [node, lost = false](const Message& message, int to) mutable {
          const auto* world = std::get_if<WorldState>(&message);
          if (world == nullptr || world->header.tick < 192 || to != node || lost) return false;
          return lost = true;
        },
        text);
    EXPECT_EQ(outcome.dropped, 1) << "node " << node;
    EXPECT_EQ(outcome.state, MissionState::kEnded) << "node " << node << ": " << outcome.reason;
    EXPECT_EQ(lines(outcome.trajectory), 1U + 3 * 192) << "node " << node;
  }
}

TEST(MessageLoss, ALoggerWhoseMessagesAreAllLostHoldsUpNoProcess) {
  const Outcome outcome = simulated(
      [](const Message& message, int) { return std::holds_alternative<RecordAck>(message); });
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
}

std::string each(int period, const std::string& text = kThreeAgents) {
  return with(text, "time {", "time { broadcast_period_ticks: " + std::to_string(period));
}

constexpr std::size_t kContribution = 2, kWorldState = 6, kEffort = type_index<Effort>();

TEST(MessageLoss, HowOftenAgentsBroadcastDoesNotShowWhereTheyReckon) {
  for (const int period : {1, 2, 7, 40, 1000}) {
    EXPECT_EQ(simulated({}, each(period)).trajectory, lossless()) << period;
    EXPECT_EQ(simulated(dropping(kContribution, 33), each(period)).trajectory, lossless())
        << period;
    EXPECT_EQ(simulated(dropping(kWorldState, 33), each(period)).trajectory, lossless()) << period;
  }
}

/// A team that halves its coverage every 13 ticks.
TEST(MessageLoss, NorWhereTheyForget) {
  const std::string text = with(kThreeAgents, "law {", "law { memory_half_life_s: 1.3");
  const std::string trajectory = simulated({}, each(1, text)).trajectory;
  EXPECT_NE(trajectory, lossless());
  for (const int period : {2, 7, 13, 40, 1000}) {
    EXPECT_EQ(simulated({}, each(period, text)).trajectory, trajectory) << period;
    for (const std::size_t kind : {kContribution, kWorldState}) {
      EXPECT_EQ(simulated(dropping(kind, 33), each(period, text)).trajectory, trajectory)
          << period << ' ' << kMessageTypes[kind];
    }
  }
}

TEST(MessageLoss, NorInATeamWhoseWorldSendsItsStateInParts) {
  std::string large = with(kThreeAgents, "agents {", "agents { random_count: 15");
  large =
      with(with(large, "x: 12 modes_y: 12", "x: 4 modes_y: 4"), "duration_s: 20", "duration_s: 5");
  const std::string trajectory = simulated({}, each(1, large)).trajectory;
  EXPECT_EQ(lines(trajectory), 1U + 18 * 50);
  for (const int period : {2, 13}) {
    EXPECT_EQ(simulated({}, each(period, large)).trajectory, trajectory) << period;
    // Parts come in any order, or not at all for a while.
    EXPECT_EQ(simulated(dropping(kWorldState, 50), each(period, large)).trajectory, trajectory)
        << period;
  }
}

TEST(MessageLoss, SlowBroadcastsShowWhereTheyDoNotReckonAndLoseNothingEither) {
  const std::string rows = with(kThreeAgents, "agents {", "agents { dead_reckoning: false");
  const Outcome clean = simulated({}, each(7, rows));
  EXPECT_NE(clean.trajectory, simulated({}, each(1, rows)).trajectory);
  EXPECT_EQ(simulated(dropping(kContribution, 33), each(7, rows)).trajectory, clean.trajectory);
}

/// What a lockstep team may know of its teammates' plans: all laws, with broadcasts each tick or
/// seldom.
struct Knowing {
  const char* name;
  const char* law;
  bool dead_reckoning;
  int period;
};
void PrintTo(const Knowing& knowing, std::ostream* out) { *out << knowing.name; }

std::string scenario_of(const Knowing& knowing) {
  std::string text = with(kThreeAgents, "u_max_mps: 5", std::string("u_max_mps: 5 ") + knowing.law);
  text = with(
      text, "agents {",
      knowing.dead_reckoning ? "agents { dead_reckoning: true" : "agents { dead_reckoning: false");
  return each(knowing.period, text);
}

class EachLaw : public ::testing::TestWithParam<Knowing> {};

TEST_P(EachLaw, LossesChangeNoTrajectory) {
  const std::string text = scenario_of(GetParam());
  const Outcome clean = simulated({}, text);
  EXPECT_EQ(clean.state, MissionState::kEnded) << clean.reason;
  for (const std::size_t kind : {kContribution, kWorldState, kEffort})
    EXPECT_TRUE(simulated(dropping(kind, 33), text).trajectory == clean.trajectory) << kind;
  const auto anything = [count = std::uint64_t{0}](const Message&, int) mutable {
    return random_words(6, Purpose::kFault, 0, ++count).first % 100 < 10;
  };
  EXPECT_TRUE(simulated(anything, text).trajectory == clean.trajectory);
}

INSTANTIATE_TEST_SUITE_P(
    MessageLoss, EachLaw,
    ::testing::Values(
        Knowing{"Classical", "anticipation: 0", false, 1},
        Knowing{"ClassicalSeldom", "anticipation: 0", false, 7},
        Knowing{"FromRows", "anticipation: 2", false, 1},
        Knowing{"FromRowsSeldom", "anticipation: 2", false, 7},
        Knowing{"Reckoning", "anticipation: 2", true, 1},
        Knowing{"ReckoningSeldom", "anticipation: 2 ends_with_plan: true", true, 7},
        Knowing{"ClassicalForgetting", "anticipation: 0 memory_half_life_s: 1.3", false, 7},
        Knowing{"FromRowsForgetting", "memory_half_life_s: 1.3", false, 7},
        Knowing{"ReckoningForgetting", "memory_half_life_s: 1.3", true, 7},
        Knowing{"Searching", "kind: SEARCH", true, 7},
        Knowing{"SearchingForgetting", "kind: SEARCH memory_half_life_s: 1.3", true, 7},
        // Halved at the ticks at which one of them sends.
        Knowing{"SearchingForgettingAsItSends", "kind: SEARCH memory_half_life_s: 2", true, 7}),
    [](const auto& knowing) { return std::string(knowing.param.name); });

/// What is forgotten does not depend on when tiles arrive.
TEST(MessageLoss, SightingsAndDismissedContactsChangeNoTrajectoryEither) {
  const std::string text = each(7, with(kThreeAgents, "law { u_max_mps: 5",
                                        "sensor { radius_m: 10 false_alarms_per_s: 0.2 }\n"
                                        "law { kind: SEARCH u_max_mps: 5"));
  const Mission mission = Scenario::parse(text, "loss").value().mission();
  Amendments list;
  add_target(list, 60, {.target = mission.target_coefficients});
  note_sighting(list, {.x_m = {40, 40}, .sigma_m = 15, .share = 0.5});
  Tick tick = 100;
  for (double x_m = 15; x_m < 100; x_m += 30)
    for (double y_m = 15; y_m < 80; y_m += 30) name_dismissal(list, tick++, {.x_m = {x_m, y_m}});
  const Outcome clean = simulated({}, text, list);
  EXPECT_EQ(clean.state, MissionState::kEnded) << clean.reason;
  EXPECT_FALSE(clean.trajectory == simulated({}, text).trajectory);
  for (const std::size_t kind : {kWorldState, kEffort})
    EXPECT_TRUE(simulated(dropping(kind, 33), text, list).trajectory == clean.trajectory) << kind;
}

bool is_command_of(const Message& message, AgentId agent) {
  const auto* command = std::get_if<Command>(&message);
  return command != nullptr && command->header.sender == agent;
}

TEST(MessageLoss, AnAgentWhoseMessagesAreAllLostIsNamedAndFailsTheMission) {
  const Outcome outcome = simulated([](const Message& m, int) { return is_command_of(m, 2); });
  EXPECT_EQ(outcome.state, MissionState::kFailed);
  EXPECT_NE(outcome.reason.find("agent 2 has not answered tick 0"), std::string::npos)
      << outcome.reason;
}

TEST(MessageLoss, OrIsEvictedIfTheScenarioChoosesIt) {
  const std::string evicting =
      with(kThreeAgents, "lockstep_timeout_s: 10", "lockstep_timeout_s: 10 on_timeout: EVICT");
  const Outcome outcome =
      simulated([](const Message& m, int) { return is_command_of(m, 2); }, evicting);
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_TRUE(outcome.in_time);
  // It stays where it was; the others go on to the end.
  EXPECT_NE(outcome.trajectory.find("\n199,19.900000000000002,0,"), std::string::npos)
      << outcome.trajectory.substr(outcome.trajectory.size() - 400);
}

TEST(MessageLoss, AnAgentThatCannotReceiveATeammateIsNotBlamed) {
  const Outcome outcome = simulated([](const Message& message, int to) {
    const auto* block = std::get_if<Contribution>(&message);
    return block != nullptr && block->header.sender == 1 && to == 0;
  });
  EXPECT_EQ(outcome.state, MissionState::kFailed);
  EXPECT_NE(outcome.reason.find("agent 1"), std::string::npos) << outcome.reason;
}

TEST(MessageLoss, AQuorumThatNeverComesFailsAndNamesTheMissing) {
  const Outcome outcome = simulated([](const Message& message, int) {
    const auto* hello = std::get_if<Hello>(&message);
    return hello != nullptr && hello->requested_id == 1;
  });
  EXPECT_EQ(outcome.state, MissionState::kFailed);
  EXPECT_NE(outcome.reason.find("missing: 1"), std::string::npos) << outcome.reason;
}

}  // namespace
}  // namespace ergocast::test
