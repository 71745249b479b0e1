// SPDX-License-Identifier: BSD-3-Clause
// A process that stands still for five seconds and then continues, as on a machine that swaps or a
// laptop with its lid closed: no process is lost, and in lockstep no bit changes. No mission here
// ends before the test ends it.
#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

class Freeze : public RunningMission {};

struct FreezeInLockstep : Freeze, ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Processes, FreezeInLockstep,
                         ::testing::Values("agent", "coordinator", "sim", "logger"),
                         [](const auto& process) { return std::string(process.param); });

TEST_P(FreezeInLockstep, AllWaitOrGoOnAndTheTrajectoryIsTheSame) {
  Child mission = launch_endless(scenario());
  const std::string process = GetParam();
  freeze(process == "agent" ? agent(1) : std::vector{"ergocast-" + process});
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_EQ(summary()["record_complete"], true);
  EXPECT_EQ(summary()["restarts"], 0);
  EXPECT_EQ(summary()["agents"].size(), 4U);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(Freeze, InRealTimeTheTeamGoesOnWithoutAnAgentThatThenAgreesAgain) {
  Child mission = launch_endless(scenario(), {"--realtime=5", "--lcm-url", kUrl});
  BusObserver observer(kUrl);
  const auto knows = [&observer](AgentId who, AgentId whose, std::int64_t steps) {
    return observer.held(observer.member(who), observer.member(whose)) > steps;
  };
  ASSERT_TRUE(observer.observes([&] { return knows(1, 0, 0) && knows(0, 1, 0); }));
  signal_to(agent(1), SIGSTOP);
  const std::int64_t frozen_at = observer.steps_sent(observer.member(1));
  const std::int64_t meanwhile = observer.steps_sent(observer.member(0)) + 5 * 50;
  ASSERT_TRUE(observer.observes([&] { return knows(2, 0, meanwhile); })) << "the team goes on";
  signal_to(agent(1), SIGCONT);
  ASSERT_TRUE(observer.observes([&] {
    return knows(1, 0, meanwhile) && knows(1, 2, meanwhile) && knows(0, 1, frozen_at + 10) &&
           knows(2, 1, frozen_at + 10);
  })) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["agents"].size(), 4U) << "it is still the same member";
}

struct FreezeInEitherPace : Freeze, ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, FreezeInEitherPace, ::testing::Values("--lockstep", "--realtime=5"),
                         name_of_pace);

TEST_P(FreezeInEitherPace, AnAgentThatIsForgottenMeanwhileCountsAgainAfterwards) {
  Child mission =
      launch_endless(scenario("", "forget_silent_after_s: 3"), {GetParam(), "--lcm-url", kUrl});
  signal_to(agent(1), SIGSTOP);
  ASSERT_TRUE(logs("coordinator", ") is forgotten from tick")) << printed();
  EXPECT_EQ(ergocast({"status", "--lcm-url", kUrl}), 1) << output();
  EXPECT_NE(output().find("forgotten: coverage of 1,"), std::string::npos) << output();
  signal_to(agent(1), SIGCONT);
  ASSERT_TRUE(logs("coordinator", ") counts again from tick")) << printed();
  EXPECT_TRUE(eventually([&] { return ergocast({"status", "--lcm-url", kUrl}) == 0; })) << output();
  EXPECT_EQ(output().find("forgotten"), std::string::npos) << output();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["agents"][1]["forgotten"], false);
  EXPECT_GT(summary()["agents"][1]["coverage_switched_at"], 0);
  EXPECT_EQ(ergocast({"verify", out()}), 2) << "no simulation knows of that: " << output();
}

TEST_F(Freeze, InRealTimeAWorldThatStoodStillSkipsAndGoesOn) {
  Child mission = launch_endless(scenario(), {"--realtime=5"});
  signal_to({"ergocast-sim"}, SIGSTOP);
  ASSERT_TRUE(eventually([this] { return printed("waiting for the world"); })) << printed();
  std::this_thread::sleep_for(std::chrono::seconds(5));
  signal_to({"ergocast-sim"}, SIGCONT);
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_GE(summary()["skipped_ticks"], 200);
  EXPECT_EQ(summary()["agents"].size(), 4U);
}

}  // namespace
}  // namespace ergocast::test
