// SPDX-License-Identifier: BSD-3-Clause
// Teams of one and two, and teams that grow during the mission.
#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

using TeamSize = RunningMission;

TEST_F(TeamSize, TwoKnowWhatTheOtherCovered) {
  ASSERT_EQ(ergocast({"run", scenario("broadcast_period_ticks: 1"), "--agents", "2", "--duration",
                      "100", "--out", out()}),
            0)
      << output();
  ASSERT_EQ(summary()["agents"].size(), 2U);
  const double observed = summary()["ergodic_metric"]["last"];
  for (const auto& one : summary()["agents"]) {
    // From only its own coverage, each would compute another value.
    EXPECT_NEAR(one["ergodic_metric"].get<double>(), observed, 1e-9 * observed);
  }
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(TeamSize, TwoReportInRealTimeThatTheyHoldEachOthersCoverage) {
  Child mission = launch_endless(scenario(), {"--agents", "2", "--realtime=5", "--lcm-url", kUrl});
  BusObserver observer(kUrl);
  for (const AgentId id : {0, 1}) {
    const auto held = [&] { return observer.held(observer.member(id), observer.member(1 - id)); };
    ASSERT_TRUE(observer.observes([&] { return held() > 0; }));
    const std::int64_t before = held();
    EXPECT_TRUE(observer.observes([&] { return held() > before; })) << "and ever more of it";
  }
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(TeamSize, HowOftenSeventeenBroadcastDoesNotChangeTheirPaths) {
  ASSERT_EQ(ergocast({"run", scenario("broadcast_period_ticks: 23"), "--agents", "17", "--duration",
                      "5", "--out", out()}),
            0)
      << output();
  const auto each_tick = folder_ / "each_tick";
  ASSERT_EQ(ergocast({"simulate", scenario("broadcast_period_ticks: 1"), "--agents", "17",
                      "--duration", "5", "--out", each_tick}),
            0)
      << output();
  EXPECT_TRUE(text_of(out() / "trajectory.csv") == text_of(each_tick / "trajectory.csv"));
}

TEST_F(TeamSize, OneNeedsNoOther) {
  ASSERT_EQ(ergocast({"run", scenario(), "--agents", "1", "--duration", "100", "--out", out()}), 0)
      << output();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["agents"].size(), 1U);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

class LateAgent : public ByHand {
 protected:
  /// It is a member, holds the others' coverage, and they hold its coverage.
  static void expect_to_take_part(BusObserver& observer, AgentId newcomer, AgentId veteran) {
    ASSERT_TRUE(observer.observes([&] { return observer.member(newcomer).incarnation != 0; }));
    const Author late = observer.member(newcomer), early = observer.member(veteran);
    EXPECT_GT(observer.entry(late)->active_from, 0) << "the mission was under way";
    EXPECT_TRUE(observer.observes([&] {
      return observer.held(late, early) >= observer.entry(late)->active_from / 2 &&
             observer.held(early, late) > 0 && observer.answered(late) > 0;
    }));
  }
};

TEST_F(LateAgent, TakesTheFreePlaceInATeamThatBeganWithAQuorum) {
  const auto file = scenario(std::string("duration_s: ") + kEndless, "quorum: 2");
  std::filesystem::create_directory(out());
  hand("ergocast-logger", {"--out", out()});
  hand("ergocast-sim");
  hand("ergocast-agent");
  hand("ergocast-agent");
  hand("ergocast-coordinator", {file});
  ASSERT_TRUE(recorded(30000)) << output();
  hand("ergocast-agent");
  BusObserver observer(kUrl);
  expect_to_take_part(observer, 2, 0);
}

struct LateAgentInEitherPace : LateAgent, ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, LateAgentInEitherPace,
                         ::testing::Values("--lockstep", "--realtime=5"), name_of_pace);

TEST_P(LateAgentInEitherPace, IsWelcomeBeyondThePlanAlsoUnderTheLastNumber) {
  Child mission = launch_endless(scenario(), {"--agents", "2", GetParam(), "--lcm-url", kUrl});
  hand("ergocast-agent");
  hand("ergocast-agent", {"--id", std::to_string(kMaxAgents - 1)});
  BusObserver observer(kUrl);
  expect_to_take_part(observer, 2, 1);
  expect_to_take_part(observer, kMaxAgents - 1, 1);
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["agents"].size(), 4U);
}

}  // namespace
}  // namespace ergocast::test
