// SPDX-License-Identifier: BSD-3-Clause
// The list of a mission's amendments: how it grows, and which lists are refused.
#include "core/mission/amendments.h"

#include <gtest/gtest.h>

#include <limits>

#include "plan/amendment_list.h"
#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

TargetChange target(double first) {
  TargetChange change;
  change.target = small_mission(1).target_coefficients;
  change.target[1] = first;
  return change;
}

TEST(Amendments, ArePausesAndTargetsUnderOneNumbering) {
  Amendments list;
  name_pause(list, 10);
  name_target(list, 12, target(0.5));
  name_pause(list, 20);
  EXPECT_EQ(list.named, 3);
  EXPECT_EQ(list.holds, (std::vector<Hold>{{10, 20}}));
  ASSERT_EQ(list.targets.size(), 1U);
  EXPECT_EQ(list.targets[0].number, 1);
  ASSERT_EQ(list.recent.size(), 3U);
  EXPECT_EQ(list.recent[1], (Amendment{1, AmendmentKind::kTarget, 12, target_hash(target(0.5))}));
  EXPECT_EQ(list.recent[2], (Amendment{2, AmendmentKind::kResume, 20, 0}));
  EXPECT_TRUE(are_amendments(list, small_mission(1)));
}

TEST(Amendments, KeepTheTargetThatHoldsAndTheNext) {
  Amendments list;
  for (int i = 0; i < 40; ++i) name_target(list, 10 * i, target(0.01 * i));
  ASSERT_EQ(list.targets.size(), 2U);
  EXPECT_EQ(list.targets[0].from, 380);
  EXPECT_EQ(list.recent.size(), kMaxRecentAmendments);
  EXPECT_EQ(target_at(list.targets, 379), nullptr);
  EXPECT_EQ(target_at(list.targets, 389), &list.targets[0]);
  EXPECT_EQ(target_at(list.targets, 390), &list.targets[1]);
}

TEST(Amendments, ATargetFollowsTheOneBefore) {
  Amendments list;
  name_target(list, 50, target(0.1));
  name_target(list, 30, target(0.2));
  EXPECT_EQ(list.targets[1].from, 51);
}

TEST(Amendments, OnlyPausesIsTheListOfThosePauses) {
  Amendments list;
  for (const Tick tick : {3, 5, 9}) name_pause(list, tick);
  EXPECT_EQ(only_pauses({{3, 5}, {9, -1}}), list);
}

TEST(Amendments, OfAnotherBasisOrOutOfLimitsAreRefused) {
  const Mission mission = small_mission(1);
  const auto accepted = [&](auto change) {
    Amendments list;
    name_pause(list, 4);
    name_pause(list, 6);
    name_target(list, 8, target(0.5));
    name_target(list, 9, target(0.7));
    change(list);
    return are_amendments(list, mission);
  };
  EXPECT_TRUE(accepted([](Amendments&) {}));
  EXPECT_FALSE(accepted([](Amendments& list) { list.targets[0].target.conservativeResize(19); }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.targets[0].target[0] = 0.5; }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.targets[0].target[3] = 1.1; }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.targets[0].target[3] = std::nan(""); }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.targets[0].cosine = list.targets[0].target; }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.targets[0].from = 9; }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.targets[1].number = 4; }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.targets[1].number = 2; }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.named = 3; }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.recent[1].number = 0; }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.recent[1].from = -1; }));
  EXPECT_FALSE(accepted([](Amendments& list) { list.holds[0].until = 3; }));
  EXPECT_FALSE(accepted([](Amendments& list) {
    list.recent.insert(list.recent.begin(), kMaxRecentAmendments, Amendment{});
  }));
}

TEST(AmendmentBytes, AreTheListBitForBit) {
  const Mission mission = small_mission(1);
  Amendments list;
  EXPECT_TRUE(encode_amendments(list).empty());
  EXPECT_EQ(decode_amendments({}, mission), list);
  name_pause(list, 10);
  name_target(list, 1'000'000'000'000, target(-0.0));
  name_target(list, 1'000'000'000'001, target(5e-324));
  const auto bytes = encode_amendments(list);
  const auto read = decode_amendments(bytes, mission);
  ASSERT_TRUE(read);
  EXPECT_EQ(encode_amendments(*read), bytes);
  EXPECT_EQ(*read, list);
}

TEST(AmendmentBytes, ThatAreCutOffOrTooLongAreRefused) {
  const Mission mission = small_mission(1);
  Amendments list;
  name_pause(list, 10);
  name_target(list, 20, target(0.5));
  auto bytes = encode_amendments(list);
  for (std::size_t size = 1; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_amendments(std::span(bytes).first(size), mission)) << size;
  bytes.push_back({});
  EXPECT_FALSE(decode_amendments(bytes, mission));
  // A length that no bytes follow allocates nothing.
  const std::vector<std::byte> huge(40, std::byte{0xff});
  EXPECT_FALSE(decode_amendments(huge, mission));
  // An empty list has no bytes: each list has one encoding.
  EXPECT_FALSE(decode_amendments(std::vector<std::byte>(20), mission));
}

TEST(TargetBytes, AreATargetOfTheMission) {
  const Mission mission = small_mission(1);
  const auto bytes = encode_target(target(0.25));
  EXPECT_EQ(bytes.size(), target_bytes(mission));
  const auto read = decode_target(bytes, mission);
  ASSERT_TRUE(read);
  EXPECT_EQ(target_hash(*read), target_hash(target(0.25)));
  EXPECT_FALSE(decode_target(std::span(bytes).first(bytes.size() - 8), mission));
  EXPECT_FALSE(decode_target(encode_target(target(1.5)), mission));
}

}  // namespace
}  // namespace ergocast
