// SPDX-License-Identifier: BSD-3-Clause
// A network that loses frames at random: lockstep repeats every lost message, real time continues
// without them.
#include "tests/hosts/team_on_hosts.h"

namespace ergocast::test {
namespace {

struct Loss : TeamOnHosts {};

struct LossInLockstep : Loss, ::testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Percent, LossInLockstep, ::testing::Values(1, 10, 30),
                         [](const auto& percent) { return std::to_string(percent.param); });

TEST_P(LossInLockstep, LeavesTheTrajectoryAsItIsSimulated) {
  lan_->lose(GetParam());
  const auto file =
      mission(std::map<int, const char*>{{1, "60"}, {10, "20"}, {30, "6"}}.at(GetParam()));
  start(file);
  expect_all_to_end();
  expect_complete_record();
  expect_simulated(file);
}

TEST_F(Loss, InRealTimeDoesNotKeepTheMissionFromItsEnd) {
  lan_->lose(30);
  start(mission("50", kRealtime));
  expect_all_to_end();
  EXPECT_EQ(summary()["result"], "done") << summary()["reason"];
  EXPECT_EQ(summary()["agents"].size(), 4U);
}

TEST_F(Loss, InRealTimeLeavesNoAgentBehindByMoreThanTheAnnouncedPeriods) {
  constexpr int kPeriodTicks = 5;
  // A digest may be a mission second old, and its author sends contributions in between.
  constexpr std::int64_t kTolerated = 2 * kPeriodTicks + 10 + kPeriodTicks;
  start(mission(kEndless, std::string(kRealtime) + " broadcast_period_ticks: 5"));
  BusObserver observer = witness_on(1);
  lan_->lose(30, {1});
  const auto up_to_date = [&](AgentId who, AgentId whose) {
    const std::int64_t held = observer.held(observer.member(who), observer.member(whose));
    return held > 0 && observer.steps_sent(observer.member(whose)) - held <= kTolerated;
  };
  const auto all_up_to_date = [&](AgentId who) {
    for (AgentId whose = 0; whose < 4; ++whose) {
      if (!up_to_date(who, whose)) return false;
    }
    return true;
  };
  for (int round = 1; round <= 5; ++round) {
    ASSERT_TRUE(
        observer.observes([&] { return observer.steps_sent(observer.member(0)) > 100 * round; }));
    EXPECT_TRUE(observer.observes([&] {
      return all_up_to_date(0) && all_up_to_date(1) && all_up_to_date(2) && all_up_to_date(3);
    }));
  }
  lan_->heal();
  end_mission();
  expect_all_to_end();
}

}  // namespace
}  // namespace ergocast::test
