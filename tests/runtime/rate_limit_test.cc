// SPDX-License-Identifier: BSD-3-Clause
// An agent that does what the mission asks is never limited; one that exceeds its budget soon is.
#include "runtime/bus/rate_limit.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast::test {
namespace {

Mission mission_of(Pace pace, int modes_per_axis = 16) {
  Mission mission = small_mission(4);
  mission.basis.modes_x = mission.basis.modes_y = modes_per_axis;
  mission.timing.pace = pace;
  return mission;
}

TEST(RateLimit, ABudgetHoldsExactlyWhatItIsAllowed) {
  RateLimit limit;
  limit.allow({.per_second = 10, .per_tick = 2, .most = 100}, 0);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(limit.admit(3, true, at(1s))) << i;
  EXPECT_FALSE(limit.admit(3, true, at(1s)));
  EXPECT_TRUE(limit.admit(4, true, at(1s))) << "each has a budget of its own";
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(limit.admit(3, true, at(2s))) << i;
  EXPECT_FALSE(limit.admit(3, true, at(2s)));
  limit.allow({.per_second = 10, .per_tick = 2, .most = 100}, 3);
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(limit.admit(3, true, at(2s))) << i;
  EXPECT_FALSE(limit.admit(3, true, at(2s)));
  for (int i = 0; i < 100; ++i)
    EXPECT_TRUE(limit.admit(3, true, at(1000s))) << "no more is saved up";
  EXPECT_FALSE(limit.admit(3, true, at(1000s)));
}

TEST(RateLimit, OnlyAgentsHaveABudgetAndOnlyInAMission) {
  RateLimit limit;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(limit.admit(3, true, at(1s)));
  limit.allow({.per_second = 1, .per_tick = 0, .most = 1}, 0);
  EXPECT_TRUE(limit.admit(3, true, at(1s)));
  EXPECT_FALSE(limit.admit(3, true, at(1s)));
  for (const AgentId other : {kUnassigned, kCoordinator, kWorld, kLogger, kOperator, kMaxAgents}) {
    for (int i = 0; i < 100; ++i) EXPECT_TRUE(limit.admit(other, true, at(1s)));
  }
}

/// How many messages are refused in 10 000 ticks at this rate and pace.
int refused(const Mission& mission, int messages_per_tick, double ticks_per_second) {
  RateLimit limit;
  int refused = 0;
  for (Tick tick = 0; tick < 10000; ++tick) {
    limit.allow(rate_budget_of(mission, 4), tick);
    const Instant now = Instant{} + seconds(static_cast<double>(tick) / ticks_per_second);
    for (int i = 0; i < messages_per_tick; ++i) refused += limit.admit(0, true, now) ? 0 : 1;
  }
  return refused;
}

/// Two blocks and a command; an occasional status or digest rounds up.
constexpr int kHonest = 4;

TEST(RateLimit, DoesNotMeetAnHonestAgentHoweverFastTheTeamIs) {
  for (const double ticks_per_second : {1.0, 10.0, 4000.0, 1e6}) {
    EXPECT_EQ(refused(mission_of(Pace::kLockstep), kHonest, ticks_per_second), 0)
        << ticks_per_second;
    EXPECT_EQ(refused(mission_of(Pace::kRealtime), kHonest, ticks_per_second), 0)
        << ticks_per_second;
  }
  // The largest basis: 32 blocks.
  EXPECT_EQ(refused(mission_of(Pace::kLockstep, 64), 32 + 3, 4000), 0);
}

TEST(RateLimit, RefusesMostOfAHundredTimesThat) {
  const int sent = 10000 * 100 * kHonest;
  EXPECT_GT(refused(mission_of(Pace::kRealtime), 100 * kHonest, 10), sent * 0.75);
  EXPECT_GT(refused(mission_of(Pace::kLockstep), 100 * kHonest, 4000), sent * 0.75);
}

TEST(RateLimit, ABacklogOfTenSecondsIsNoBabble) {
  const Mission mission = mission_of(Pace::kRealtime);
  RateLimit limit;
  limit.allow(rate_budget_of(mission, 4), 0);
  EXPECT_TRUE(limit.admit(0, true, at(1s)));
  for (int i = 0; i < 10 * 10 * kHonest + 2000; ++i) EXPECT_TRUE(limit.admit(0, true, at(1s))) << i;
}

}  // namespace
}  // namespace ergocast::test
