// Lockstep waits for nothing that is not repeated: whatever kind of message is lost, the mission
// ends, and its trajectory is the one without losses, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/noise.h"
#include "lab/swarm.h"
#include "scenario/scenario.h"

namespace ergocast::test {
namespace {

constexpr const char* kScenario = R"(
domain { size_x_m: 100 size_y_m: 80 }
target { gaussians { mean_x_m: 30 mean_y_m: 40 sigma_m: 10 } uniform_weight: 0.5 }
basis { modes_x: 12 modes_y: 12 }
law { u_max_mps: 5 }
time { duration_s: 20 lockstep_timeout_s: 10 }
agents { starts { x_m: 0 y_m: 0 } starts { x_m: 50 y_m: 40 } starts { x_m: 100 y_m: 80 } }
)";

constexpr const char* kKinds[] = {"Hello",      "MissionPart", "Contribution",
                                  "AgentStatus", "TeamStatus",  "Stop",
                                  "WorldState",  "Command",     "RecordAck"};

using Delivers = std::function<bool(const Message&, int seat)>;

struct Outcome {
  std::string trajectory;
  MissionState state;
  std::string reason;
  std::int64_t dropped;
  bool in_time;
};

Outcome fly(const Delivers& delivers, const std::string& text = kScenario) {
  const auto scenario = std::get<Scenario>(Scenario::parse(text, "loss"));
  std::ostringstream trajectory, metrics;
  lab::Options options;
  options.plan = scenario.plan();
  options.decode_plan = decode_plan;
  options.agents = 3;
  options.delivers = delivers;
  lab::Swarm swarm(std::move(options), trajectory, metrics);
  constexpr auto kLimit = std::chrono::minutes(30);
  swarm.run(kLimit);
  return {trajectory.str(), swarm.coordinator().state(), swarm.coordinator().reason(),
          swarm.messages_dropped(), swarm.now().time_since_epoch() < kLimit};
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  return at == std::string::npos ? throw std::logic_error(from) : text.replace(at, from.size(), to);
}

const std::string& lossless() {
  static const std::string trajectory = fly({}).trajectory;
  return trajectory;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Drops that many of hundred messages of one kind, for each receiver by itself.
Delivers dropping(std::size_t kind, std::uint64_t percent) {
  return [=, count = std::uint64_t{0}](const Message& message, int) mutable {
    if (message.index() != kind) return true;
    return random_words(5, Purpose::kFault, static_cast<std::uint32_t>(kind), ++count).first % 100 >=
           percent;
  };
}

TEST(MessageLoss, NothingIsDroppedWithoutAFault) {
  const Outcome outcome = fly({});
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_EQ(outcome.dropped, 0);
  EXPECT_EQ(lines(outcome.trajectory), 1U + 3 * 200);
}

class EachKind : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EachKind, LosingAThirdChangesNoTrajectory) {
  const Outcome outcome = fly(dropping(GetParam(), 33));
  EXPECT_TRUE(outcome.in_time);
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_EQ(outcome.trajectory, lossless());
}

TEST_P(EachKind, LosingFourOfFiveEndsTheMissionAllTheSame) {
  const Outcome outcome = fly(dropping(GetParam(), 80));
  EXPECT_TRUE(outcome.in_time);
  // Whoever is admitted late starts the mission late, but the mission is the same.
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_EQ(outcome.trajectory, lossless());
}

TEST_P(EachKind, LosingAllIsDecidedByTheCoordinatorAtTheLatest) {
  const Outcome outcome = fly(dropping(GetParam(), 100));
  EXPECT_TRUE(outcome.state == MissionState::kEnded || outcome.state == MissionState::kFailed);
  // Only who never hears of a mission waits for one for ever.
  EXPECT_TRUE(outcome.in_time || std::string(kKinds[GetParam()]) == "MissionPart");
}

INSTANTIATE_TEST_SUITE_P(MessageLoss, EachKind, ::testing::Range(std::size_t{0}, std::size_t{9}),
                         [](const auto& kind) { return std::string(kKinds[kind.param]); });

TEST(MessageLoss, EveryKindAtOnceChangesNoTrajectory) {
  const Outcome outcome = fly([count = std::uint64_t{0}](const Message&, int) mutable {
    return random_words(6, Purpose::kFault, 0, ++count).first % 100 >= 10;
  });
  EXPECT_GT(outcome.dropped, 100);
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_EQ(outcome.trajectory, lossless());
}

TEST(MessageLoss, LosingTheLastStateOnceHurtsNobody) {
  // The record is complete with the 192nd row, which is acknowledged at once.
  const std::string text = with(kScenario, "duration_s: 20", "duration_s: 19.2");
  for (const int seat : {0, lab::kCoordinatorSeat, lab::kLoggerSeat}) {
    const Outcome outcome = fly([seat, lost = false](const Message& message, int to) mutable {
      const auto* world = std::get_if<WorldState>(&message);
      if (world == nullptr || world->header.tick < 192 || to != seat || lost) return true;
      lost = true;
      return false;
    }, text);
    EXPECT_EQ(outcome.state, MissionState::kEnded) << "seat " << seat << ": " << outcome.reason;
    EXPECT_EQ(lines(outcome.trajectory), 1U + 3 * 192) << "seat " << seat;
  }
}

TEST(MessageLoss, ALoggerThatIsNeverHeardHoldsUpNobody) {
  const Outcome outcome = fly([](const Message& message, int) {
    return !std::holds_alternative<RecordAck>(message);
  });
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
}

TEST(MessageLoss, SlowBroadcastsLoseNothingEither) {
  const std::string slow = with(kScenario, "lockstep_timeout_s: 10",
                                "lockstep_timeout_s: 10 broadcast_period_ticks: 7");
  const Outcome clean = fly({}, slow);
  EXPECT_NE(clean.trajectory, lossless());
  EXPECT_EQ(fly(dropping(2, 33), slow).trajectory, clean.trajectory);
}

bool is_command_of(const Message& message, AgentId agent) {
  const auto* command = std::get_if<Command>(&message);
  return command != nullptr && command->header.sender == agent;
}

TEST(MessageLoss, AnAgentThatIsNeverHeardIsNamedAndFailsTheMission) {
  const Outcome outcome = fly([](const Message& m, int) { return !is_command_of(m, 2); });
  EXPECT_EQ(outcome.state, MissionState::kFailed);
  EXPECT_NE(outcome.reason.find("agent 2 has not answered tick 0"), std::string::npos)
      << outcome.reason;
}

TEST(MessageLoss, OrIsEvictedIfTheScenarioSaysSo) {
  const std::string evicting =
      with(kScenario, "lockstep_timeout_s: 10", "lockstep_timeout_s: 10 on_timeout: EVICT");
  const Outcome outcome =
      fly([](const Message& m, int) { return !is_command_of(m, 2); }, evicting);
  EXPECT_EQ(outcome.state, MissionState::kEnded) << outcome.reason;
  EXPECT_TRUE(outcome.in_time);
  // It stays where it was; the others go on to the end.
  EXPECT_NE(outcome.trajectory.find("\n199,19.900000000000002,0,"), std::string::npos)
      << outcome.trajectory.substr(outcome.trajectory.size() - 400);
}

TEST(MessageLoss, WhoCannotHearATeammateIsNotBlamedForIt) {
  const Outcome outcome = fly([](const Message& message, int seat) {
    const auto* block = std::get_if<Contribution>(&message);
    return block == nullptr || block->header.sender != 1 || seat != 0;
  });
  EXPECT_EQ(outcome.state, MissionState::kFailed);
  EXPECT_NE(outcome.reason.find("agent 1"), std::string::npos) << outcome.reason;
}

TEST(MessageLoss, AQuorumThatNeverComesFailsAndNamesTheMissing) {
  const Outcome outcome = fly([](const Message& message, int) {
    const auto* hello = std::get_if<Hello>(&message);
    return hello == nullptr || hello->requested_id != 1;
  });
  EXPECT_EQ(outcome.state, MissionState::kFailed);
  EXPECT_NE(outcome.reason.find("missing: 1"), std::string::npos) << outcome.reason;
}

}  // namespace
}  // namespace ergocast::test
