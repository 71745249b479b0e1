// SPDX-License-Identifier: BSD-3-Clause
// Liveness: only a fresh message is a sign of life, and there is one rule of silence.
#include "team/liveness.h"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;
using test::at;

Header sent(AgentId sender, Incarnation life, std::int64_t sequence) {
  return {1, sender, life, sequence, 0};
}

bool is_new(Liveness& liveness, const Header& from, Bus bus = Bus::kSwarm) {
  return liveness.record(from, bus, at(0s));
}

TEST(Liveness, OnlyLaterMessagesAreNew) {
  Liveness liveness;
  EXPECT_TRUE(is_new(liveness, sent(3, 7, 5)));
  EXPECT_FALSE(is_new(liveness, sent(3, 7, 5)));
  EXPECT_FALSE(is_new(liveness, sent(3, 7, 4)));
  EXPECT_TRUE(is_new(liveness, sent(3, 7, 6)));
  EXPECT_FALSE(is_new(liveness, sent(3, 7, 5)));
}

TEST(Liveness, IncarnationsAndSendersAreDistinguished) {
  Liveness liveness;
  EXPECT_TRUE(is_new(liveness, sent(3, 7, 5)));
  EXPECT_TRUE(is_new(liveness, sent(3, 8, 1)));
  EXPECT_TRUE(is_new(liveness, sent(kWorld, 7, 1)));
  EXPECT_FALSE(is_new(liveness, sent(3, 7, 5))) << "a successor does not wake its predecessor";
}

TEST(Liveness, EachBusHasSequencesOfItsOwn) {
  Liveness liveness;
  EXPECT_TRUE(is_new(liveness, sent(3, 7, 5), Bus::kSwarm));
  EXPECT_TRUE(is_new(liveness, sent(3, 7, 1), Bus::kCommand));
  EXPECT_EQ(liveness.newest({3, 7}, Bus::kSwarm), 5);
  EXPECT_EQ(liveness.newest({3, 7}, Bus::kCommand), 1);
  EXPECT_EQ(liveness.newest({3, 7}, Bus::kWorld), -1);
  EXPECT_EQ(liveness.newest({4, 7}, Bus::kSwarm), -1);
}

TEST(Liveness, RemembersNoMoreIncarnationsThanItsLimit) {
  Liveness liveness;
  constexpr auto kMost = static_cast<Incarnation>(Liveness::kMaxIncarnations);
  for (Incarnation life = 1; life <= kMost; ++life) {
    EXPECT_TRUE(is_new(liveness, sent(0, life, 1)));
  }
  EXPECT_FALSE(is_new(liveness, sent(0, kMost + 1, 1)));
  EXPECT_FALSE(liveness.last_sign({0, kMost + 1}));
  EXPECT_TRUE(is_new(liveness, sent(0, kMost, 2))) << "known senders are still received";
  EXPECT_TRUE(is_new(liveness, sent(0, kMost, 4)));
  EXPECT_EQ(liveness.lost({0, kMost}, Bus::kSwarm), 1) << "of those it goes on";
  EXPECT_EQ(liveness.lost({0, kMost + 1}, Bus::kSwarm), 0);
}

TEST(Liveness, OnlyNewMessagesAreASignOfLife) {
  Liveness liveness;
  EXPECT_FALSE(liveness.last_sign({3, 7}));
  EXPECT_FALSE(liveness.last_sign_of_kind(3));
  liveness.record(sent(3, 7, 5), Bus::kSwarm, at(1s));
  liveness.record(sent(3, 7, 5), Bus::kSwarm, at(2s));
  liveness.record(sent(3, 7, 6), Bus::kSwarm, at(3s), false);
  EXPECT_EQ(liveness.last_sign({3, 7}), at(1s));
  EXPECT_EQ(liveness.last_sign_of_kind(3), at(1s));
  liveness.record(sent(3, 7, 7), Bus::kSwarm, at(4s));
  EXPECT_EQ(liveness.last_sign({3, 7}), at(4s));
}

TEST(Liveness, KnowsTheLastMessageOfAnyIncarnationOfAKind) {
  Liveness liveness;
  liveness.record(sent(kWorld, 7, 5), Bus::kWorld, at(1s));
  liveness.record(sent(kWorld, 8, 1), Bus::kWorld, at(2s));
  liveness.record(sent(1, 9, 1), Bus::kSwarm, at(3s));
  liveness.record(sent(2, 10, 1), Bus::kSwarm, at(4s));
  EXPECT_EQ(liveness.last_sign_of_kind(kWorld), at(2s));
  EXPECT_EQ(liveness.last_sign({kWorld, 7}), at(1s));
  EXPECT_EQ(liveness.last_sign_of_kind(0), at(4s)) << "all agents are one kind";
  EXPECT_FALSE(liveness.last_sign_of_kind(kCoordinator));
  EXPECT_FALSE(liveness.last_sign_of_kind(kLogger));
}

TEST(Liveness, ASenderPresumedAliveHasSentNothingYet) {
  Liveness liveness;
  liveness.presume_alive({3, 7}, at(1s));
  EXPECT_EQ(liveness.last_sign({3, 7}), at(1s));
  EXPECT_FALSE(liveness.last_sign_of_kind(3));
  EXPECT_EQ(liveness.lost({3, 7}, Bus::kSwarm), 0);
  EXPECT_TRUE(is_new(liveness, sent(3, 7, 1)));
}

TEST(Liveness, ASenderPresumedAliveHasAPlaceInAFullTable) {
  Liveness liveness;
  for (Incarnation life = 1; life <= Liveness::kMaxIncarnations; ++life)
    is_new(liveness, sent(0, life, 1));
  const Author admitted{3, Liveness::kMaxIncarnations + 7};
  liveness.presume_alive(admitted, at(1s));
  EXPECT_EQ(liveness.last_sign(admitted), at(1s));
  EXPECT_TRUE(liveness.record(sent(3, admitted.incarnation, 1), Bus::kSwarm, at(2s)));
  EXPECT_EQ(liveness.last_sign(admitted), at(2s));
}

TEST(Liveness, CountsWhatIsMissingInASequence) {
  Liveness liveness;
  for (const std::int64_t sequence : {11, 12, 15, 14}) is_new(liveness, sent(3, 7, sequence));
  EXPECT_EQ(liveness.lost({3, 7}, Bus::kSwarm), 1) << "13; what came before 11 was before its time";
  is_new(liveness, sent(3, 7, 10));
  is_new(liveness, sent(3, 7, 10));
  EXPECT_EQ(liveness.lost({3, 7}, Bus::kSwarm), 0) << "never fewer than none";
  EXPECT_EQ(liveness.lost({3, 7}, Bus::kCommand), 0);
}

TEST(Silence, IsSixHeartbeats) {
  Timing timing;
  timing.pace = Pace::kRealtime;
  timing.dt_s = 2;
  timing.realtime_factor = 4;
  EXPECT_EQ(silence_of(0), 3s);
  EXPECT_EQ(silence_of(kLogger), 3s);
  EXPECT_EQ(silence_of(kCoordinator), 1500ms);
  EXPECT_EQ(silence_of(kCoordinator, CoordinatorSign::kMission), 6s);
  EXPECT_EQ(silence_of(kWorld), 3s);
  EXPECT_EQ(silence_of(kWorld, CoordinatorSign::kMission, &timing), 3s);
  timing.realtime_factor = 1;
  EXPECT_EQ(silence_of(kWorld, CoordinatorSign::kMission, &timing), 12s) << "six ticks of 2 s";
  EXPECT_EQ(silence_of(0, CoordinatorSign::kMission, &timing), 3s) << "agents also send in between";
  timing.pace = Pace::kLockstep;
  EXPECT_EQ(silence_of(kWorld, CoordinatorSign::kMission, &timing), 3s);
}

TEST(Silence, OutlastsTheMission) {
  Timing timing;
  timing.pace = Pace::kRealtime;
  timing.tick_count = 100;
  timing.dt_s = 0.5;
  EXPECT_FALSE(must_be_over(timing, 20, 70s)) << "80 ticks of 0.5 s, and 30 s of patience";
  EXPECT_TRUE(must_be_over(timing, 20, 70s + 1ms));
  EXPECT_FALSE(must_be_over(timing, -1, 80s)) << "no tick yet";
  timing.realtime_factor = 2;
  EXPECT_TRUE(must_be_over(timing, 20, 50s + 1ms));
  timing.pace = Pace::kLockstep;
  timing.lockstep_timeout_s = 5;
  EXPECT_FALSE(must_be_over(timing, 20, 35s));
  EXPECT_TRUE(must_be_over(timing, 20, 35s + 1ms));
}

}  // namespace
}  // namespace ergocast
