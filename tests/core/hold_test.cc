// SPDX-License-Identifier: BSD-3-Clause
// Which ticks count while a mission is paused now and then, against counting them one by one.
#include "core/mission/hold.h"

#include <gtest/gtest.h>

namespace ergocast::test {
namespace {

const std::vector<Hold> kTwice{{10, 15}, {15, 16}, {40, -1}};

TEST(Holds, AreAscendingAndOnlyTheLastIsOpen) {
  EXPECT_TRUE(are_holds({}));
  EXPECT_TRUE(are_holds(kTwice));
  EXPECT_FALSE(are_holds(std::vector<Hold>{{5, 5}}));
  EXPECT_FALSE(are_holds(std::vector<Hold>{{5, 4}}));
  EXPECT_FALSE(are_holds(std::vector<Hold>{{-1, 4}}));
  EXPECT_FALSE(are_holds(std::vector<Hold>{{5, 9}, {8, 12}}));
  EXPECT_FALSE(are_holds(std::vector<Hold>{{5, -1}, {8, 12}}));
  std::vector<Hold> many;
  for (Tick i = 0; i < static_cast<Tick>(kMaxHolds); ++i) many.push_back({2 * i, 2 * i + 1});
  EXPECT_TRUE(are_holds(many));
  many.push_back({100, 101});
  EXPECT_FALSE(are_holds(many));
}

TEST(Holds, CountTheTicksOutside) {
  EXPECT_EQ(counted_ticks(kTwice, -1), -1);
  Tick counted = 0;
  for (Tick tick = 0; tick < 60; ++tick) {
    EXPECT_EQ(counted_ticks(kTwice, tick), counted) << tick;
    const bool held = (tick >= 10 && tick < 16) || tick >= 40;
    EXPECT_EQ(is_held(kTwice, tick), held) << tick;
    counted += held ? 0 : 1;
  }
}

TEST(Holds, MoveTheEnd) {
  for (Tick count = 0; count < 35; ++count) {
    const Tick end = tick_after(kTwice, count);
    if (count > 34) continue;
    EXPECT_EQ(counted_ticks(kTwice, end), count) << count;
    EXPECT_TRUE(end == 0 || counted_ticks(kTwice, end - 1) < count || is_held(kTwice, end - 1));
  }
  EXPECT_EQ(tick_after(kTwice, 10), 10);  // a hold that begins with the end
  EXPECT_EQ(tick_after(kTwice, 11), 17);
  EXPECT_EQ(tick_after(kTwice, 34), 40);
  EXPECT_GT(tick_after(kTwice, 35), Tick{1} << 60);  // no end is known
}

TEST(Holds, CountHowManyOfTheirEndsAreNamed) {
  EXPECT_EQ(named_changes({}), 0);
  EXPECT_EQ(named_changes(std::vector<Hold>{{3, -1}}), 1);
  EXPECT_EQ(named_changes(std::vector<Hold>{{3, 4}}), 2);
  EXPECT_EQ(named_changes(kTwice), 5);
}

TEST(Holds, LeaveTheRosterOfATickThatCountsAsItIs) {
  std::vector<RosterEntry> roster;
  for (Tick from = 0; from < 30; from += 3) {
    for (const Tick until : {Tick{-1}, from + 1, from + 7}) {
      roster.push_back({{0, 1}, from, until});
    }
  }
  const auto counted = in_counted_ticks(roster, kTwice);
  for (Tick tick = 0; tick < 40; ++tick) {
    if (is_held(kTwice, tick)) continue;
    for (std::size_t i = 0; i < roster.size(); ++i) {
      EXPECT_EQ(counted[i].active_at(counted_ticks(kTwice, tick)), roster[i].active_at(tick));
    }
  }
}

}  // namespace
}  // namespace ergocast::test
