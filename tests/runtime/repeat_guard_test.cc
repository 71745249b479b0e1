// SPDX-License-Identifier: BSD-3-Clause
// The start and end of a flood of repeats are detected; a team's legitimate repeats are no flood.
#include "runtime/bus/repeat_guard.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast::test {
namespace {

Header sent(AgentId sender, Incarnation life, std::int64_t sequence) {
  return {1, sender, life, sequence, 0};
}

class Guarded : public ::testing::Test {
 protected:
  /// True if the kernel needs a new list.
  bool receive(const Header& from, Instant when) {
    return guard_.count(from, guard_.is_new(from, when), when);
  }
  /// Receives the same message `count` times at once. True if the kernel needs a new list.
  bool flood(const Header& from, int count, Instant when) {
    bool changed = false;
    for (int i = 0; i < count; ++i) changed = receive(from, when) || changed;
    return changed;
  }
  /// The newest sequence of `life` up to which the kernel drops; −1: none.
  std::int64_t dropped_up_to(Incarnation life) const {
    for (const Repeated& one : guard_.flooded()) {
      if (one.incarnation == life) return one.newest;
    }
    return -1;
  }

  RepeatGuard guard_{Bus::kSwarm};
};

TEST_F(Guarded, NewMessagesAreNeverAFlood) {
  for (int i = 0; i < 100 * RepeatGuard::kMostRepeats; ++i) {
    EXPECT_FALSE(receive(sent(3, 7, i), at(1s)));
  }
  EXPECT_TRUE(guard_.flooded().empty());
}

TEST_F(Guarded, FewerRepeatsThanAFloodHasAreAlwaysReceived) {
  receive(sent(3, 7, 5), at(1s));
  for (int second = 2; second < 100; ++second) {
    EXPECT_FALSE(
        flood(sent(3, 7, 5), RepeatGuard::kMostRepeats - 1, at(std::chrono::seconds(second))));
  }
}

TEST_F(Guarded, AFloodIsCutAtTheNewestMessageOfTheRepeatedSender) {
  receive(sent(3, 7, 5), at(1s));
  receive(sent(3, 7, 90), at(1s));
  receive(sent(kWorld, 8, 1000), at(1s));
  EXPECT_TRUE(flood(sent(3, 7, 5), RepeatGuard::kMostRepeats, at(1s)));
  EXPECT_EQ(dropped_up_to(7), 90);
  EXPECT_EQ(dropped_up_to(8), -1) << "the world is not repeated";
}

TEST_F(Guarded, AFloodThatLastsIsCutAtEverNewerSequencesAndItsEndOpensAgain) {
  receive(sent(3, 7, 5), at(1s));
  flood(sent(3, 7, 5), RepeatGuard::kMostRepeats, at(1s));
  // A share of the flood passes and shows that it lasts.
  receive(sent(3, 7, 6), at(1050ms));
  constexpr int kShareOfIt =
      RepeatGuard::kMostRepeats * RepeatGuard::kCalmWindows / static_cast<int>(kShareThatPasses);
  EXPECT_FALSE(flood(sent(3, 7, 5), kShareOfIt + 1, at(1060ms)));
  EXPECT_TRUE(receive(sent(3, 7, 7), at(2000ms)));
  EXPECT_EQ(dropped_up_to(7), 7);
  // Repeats newer than the list pass until the kernel gets a new list.
  EXPECT_TRUE(flood(sent(3, 7, 8), RepeatGuard::kMostRepeats + 1, at(2010ms)));
  EXPECT_EQ(dropped_up_to(7), 8);
  EXPECT_FALSE(receive(sent(3, 7, 9), at(2900ms)));
  EXPECT_TRUE(receive(sent(3, 7, 10), at(3010ms)));
  EXPECT_TRUE(guard_.flooded().empty());
  EXPECT_FALSE(receive(sent(3, 7, 11), at(5000ms))) << "reported once";
}

TEST_F(Guarded, RemembersNoMoreIncarnationsThanItsLimit) {
  const int many = static_cast<int>(RepeatGuard::kMaxIncarnations) + 50;
  for (int life = 1; life <= many; ++life)
    receive(sent(0, static_cast<Incarnation>(life), 1), at(1s));
  for (int round = 0; round < 3; ++round) {
    for (int life = 1; life <= many; ++life)
      receive(sent(0, static_cast<Incarnation>(life), 1), at(1s));
  }
  EXPECT_LE(guard_.flooded().size(), RepeatGuard::kMaxIncarnations);
  EXPECT_GT(guard_.flooded().size(), 0U);
}

}  // namespace
}  // namespace ergocast::test
