// SPDX-License-Identifier: BSD-3-Clause
// The list of a mission's amendments: how it grows, and which lists are refused.
#include "core/mission/amendments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "plan/amendment_list.h"
#include "plan/mission_limits.h"
#include "team/messages.h"
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

// ---- zones ----

Zone square(double x_m, Tick lasts = 100) {
  Zone zone;
  zone.until = lasts;
  zone.corners_m = {{x_m, 100}, {x_m + 50, 100}, {x_m + 50, 150}, {x_m, 150}};
  return zone;
}

TEST(Amendments, AZoneIsClosedFreeAndOver) {
  Amendments list;
  name_pause(list, 10);
  name_zone(list, 20, 20, 30, square(100));
  ASSERT_EQ(list.zones.size(), 1U);
  const Zone& zone = list.zones[0];
  EXPECT_EQ(std::tuple(zone.number, zone.closed, zone.from, zone.until),
            (std::tuple<std::int32_t, Tick, Tick, Tick>{1, 20, 50, 150}));
  EXPECT_EQ(list.recent[1], (Amendment{1, AmendmentKind::kZone, 50, zone_hash(square(100))}));
  EXPECT_EQ(zones_at(list, 149), 1U);
  EXPECT_EQ(zones_at(list, 150), 0U);
  EXPECT_TRUE(are_amendments(list, small_mission(1)));
  EXPECT_EQ(decode_amendments(encode_amendments(list), small_mission(1)), list);
}

TEST(Amendments, ZonesThatHaveEndedLeaveAndTargetsDoNotCrowdThemOut) {
  Amendments list;
  for (int i = 0; i < 8; ++i) name_zone(list, i, i, 10, square(100 + i, i == 3 ? 20 : 1000));
  EXPECT_TRUE(are_amendments(list, small_mission(1)));
  for (int i = 0; i < 100; ++i) name_target(list, 100 + i, target(0.001 * i));
  EXPECT_EQ(list.zones.size(), 8U);
  EXPECT_TRUE(are_amendments(list, small_mission(1)));
  name_zone(list, 200, 200, 10, square(300));
  ASSERT_EQ(list.zones.size(), 8U);
  EXPECT_EQ(list.zones[3].number, 4) << "the fourth has ended";
  EXPECT_EQ(decode_amendments(encode_amendments(list), small_mission(1)), list);
}

TEST(Amendments, AZoneStaysInForceThoughTheNextOneIsNamedForALaterTick) {
  Amendments list;
  name_zone(list, 0, 0, 10, square(100));  // until 110
  name_zone(list, 105, 125, 10, square(300));
  EXPECT_EQ(list.zones.size(), 2U);
  name_zone(list, 110, 130, 10, square(500));
  EXPECT_EQ(list.zones.size(), 2U);
}

TEST(Amendments, ACancelledZoneEndsAtItsTick) {
  Amendments list;
  name_zone(list, 20, 20, 30, square(100));  // until 150
  EXPECT_FALSE(can_reopen(list, 1, 60)) << "it is no zone";
  EXPECT_FALSE(can_reopen(list, 0, 150)) << "it ends then";
  EXPECT_TRUE(can_reopen(list, 0, 149));
  name_reopening(list, 60, 0);
  EXPECT_EQ(list.recent[1], (Amendment{1, AmendmentKind::kReopen, 60, 0}));
  EXPECT_FALSE(can_reopen(list, 0, 55)) << "once";
  EXPECT_TRUE(list.zones[0].closed_at(59));
  EXPECT_FALSE(list.zones[0].closed_at(60));
  EXPECT_EQ(zones_at(list, 59), 1U);
  EXPECT_EQ(zones_at(list, 60), 0U);
  EXPECT_EQ(zone_hash(list.zones[0]), list.recent[0].hash);
  EXPECT_TRUE(are_amendments(list, small_mission(1)));
  EXPECT_EQ(decode_amendments(encode_amendments(list), small_mission(1)), list);
  name_zone(list, 60, 60, 30, square(300));
  ASSERT_EQ(list.zones.size(), 1U) << "it has left the list";
  EXPECT_EQ(list.zones[0].number, 2);
}

TEST(Amendments, AZoneThatIsCancelledBeforeItClosesIsNeverClosed) {
  Amendments list;
  name_zone(list, 0, 20, 30, square(100));
  name_reopening(list, 10, 0);
  EXPECT_EQ(list.recent[1].from, 20);
  for (Tick tick = 0; tick < 200; ++tick) EXPECT_FALSE(list.zones[0].closed_at(tick)) << tick;
  EXPECT_TRUE(are_amendments(list, small_mission(1)));
}

TEST(Amendments, WhatCancelsAZoneIsItsWholeNumber) {
  const std::vector<std::byte> bytes = encode_reopening(70000);
  EXPECT_EQ(decode_reopening(bytes), 70000);
  EXPECT_EQ(decode_reopening(std::span(bytes).first(3)), std::nullopt);
  EXPECT_EQ(decode_reopening(encode_reopening(-1)), std::nullopt);
  EXPECT_EQ(decode_reopening(encode_end(5)), std::nullopt);
}

TEST(Amendments, RefusesZonesThatNoCoordinatorNames) {
  Amendments list;
  name_zone(list, 20, 20, 30, square(100));
  const Mission mission = small_mission(1);
  const auto refused = [&](auto change) {
    Amendments forged = list;
    change(forged.zones[0]);
    return !decode_amendments(encode_amendments(forged), mission);
  };
  EXPECT_TRUE(refused([](Zone& zone) { zone.number = 1; }));
  EXPECT_TRUE(refused([](Zone& zone) { zone.closed = 51; }));
  EXPECT_TRUE(refused([](Zone& zone) { zone.until = 50; }));
  EXPECT_TRUE(refused([](Zone& zone) { zone.cancelled = 19; })) << "before it is closed";
  EXPECT_TRUE(refused([](Zone& zone) { zone.cancelled = -2; }));
  EXPECT_TRUE(refused([](Zone& zone) { zone.corners_m.resize(2); }));
  EXPECT_TRUE(refused([](Zone& zone) { std::swap(zone.corners_m[0], zone.corners_m[1]); }));
  EXPECT_TRUE(refused([](Zone& zone) { zone.corners_m[0].x() = std::nan(""); }));
  EXPECT_TRUE(refused([](Zone& zone) { zone.high_m = 1; })) << "a plane has no heights";
  EXPECT_FALSE(refused([](Zone&) {}));
  for (int i = 0; i < 7; ++i) name_zone(list, 20, 20, 30, square(100));
  list.zones.push_back(list.zones.back());
  list.zones.back().number = list.named++;
  EXPECT_FALSE(decode_amendments(encode_amendments(list), mission)) << "there are nine";
}

TEST(Amendments, AZoneOfAnAmendIsWhole) {
  const std::vector<std::byte> bytes = encode_zone(square(100));
  const Box domain = small_mission(1).domain;
  EXPECT_EQ(decode_zone(bytes, domain), square(100));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(decode_zone(std::span(bytes).first(size), domain), std::nullopt) << size;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto damaged = bytes;
    damaged[i] ^= std::byte{0xff};
    const auto zone = decode_zone(damaged, domain);
    EXPECT_TRUE(!zone || is_zone(*zone, domain)) << i;
  }
}

// ---- laws ----

LawChange slower(double u_max_mps, double noise = 0) {
  LawChange change = plans_law(small_mission(1));
  change.kinds[0].u_max_mps = u_max_mps;
  change.kinds[0].noise_intensity = noise;
  return change;
}

TEST(Amendments, KeepTheLawThatHoldsAndTheNext) {
  const Mission mission = small_mission(1);
  const double most_mps = mission.law.u_max_mps;
  Amendments list;
  for (int i = 1; i <= 4; ++i) name_law(list, 10 * i, slower(most_mps / i));
  ASSERT_EQ(list.laws.size(), 2U);
  EXPECT_EQ(law_at(list.laws, 29), nullptr);
  EXPECT_EQ(law_at(list.laws, 30), &list.laws[0]);
  EXPECT_EQ(law_at(list.laws, 40), &list.laws[1]);
  EXPECT_EQ(list.recent[3],
            (Amendment{3, AmendmentKind::kLaw, 40, law_hash(slower(most_mps / 4))}));
  name_law(list, 40, slower(most_mps / 8));
  EXPECT_EQ(list.laws[1].from, 41);
  replace_law(list, slower(most_mps));
  EXPECT_EQ(list.laws[1].from, 41);
  EXPECT_EQ(list.laws[1].number, 5);
  list.recent.back().by = "anna@base";
  list.recent.back().ordered_by = 7;
  EXPECT_TRUE(are_amendments(list, mission));
  EXPECT_EQ(decode_amendments(encode_amendments(list), mission), list);
}

TEST(Amendments, RefusesLawsBeyondThePlanAndNamesThatAreNone) {
  const Mission mission = small_mission(1);
  const double most_mps = mission.law.u_max_mps;
  const auto refused = [&](auto change) {
    Amendments forged;
    name_law(forged, 20, slower(most_mps / 2));
    change(forged);
    return !decode_amendments(encode_amendments(forged), mission);
  };
  EXPECT_FALSE(refused([](Amendments&) {}));
  for (const double u_max_mps :
       {0.0, -1.0, most_mps * 1.01, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_TRUE(refused([&](Amendments& list) { list.laws[0].kinds[0].u_max_mps = u_max_mps; }))
        << u_max_mps;
  for (const double noise : {-1.0, 1e7, std::nan("")})
    EXPECT_TRUE(refused([&](Amendments& list) { list.laws[0].kinds[0].noise_intensity = noise; }))
        << noise;
  EXPECT_TRUE(refused([](Amendments& list) { list.laws[0].kinds[0].noise_ceiling += 1; }))
      << "it has no effect";
  EXPECT_TRUE(refused([](Amendments& list) { list.laws[0].kinds.emplace_back(); }));
  EXPECT_TRUE(refused([](Amendments& list) { list.laws[0].kinds.clear(); }));
  EXPECT_TRUE(refused([](Amendments& list) { list.laws[0].number = 1; }));
  EXPECT_TRUE(refused([](Amendments& list) { list.laws.push_back(list.laws[0]); }));
  EXPECT_TRUE(refused([](Amendments& list) { list.recent[0].by = "a\nb"; }));
  EXPECT_TRUE(refused([](Amendments& list) { list.recent[0].by = "J\xc3\xb6rg"; }));
  EXPECT_TRUE(refused([](Amendments& list) { list.recent[0].by.assign(33, 'a'); }));
  EXPECT_FALSE(refused([](Amendments& list) { list.recent[0].by.assign(32, '~'); }));
}

TEST(Amendments, ALawOfAnAmendIsWhole) {
  const Mission mission = small_mission(1);
  const LawChange law = slower(mission.law.u_max_mps / 2);
  const auto bytes = encode_law(law);
  EXPECT_EQ(decode_law(bytes, mission), law);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_law(std::span(bytes).first(size), mission)) << size;
  EXPECT_FALSE(decode_law(encode_law(slower(2 * mission.law.u_max_mps)), mission));
}

TEST(Amendments, ALawIsNamedByWhatDiffersFromThePlan) {
  const Mission mission = small_mission(1);
  EXPECT_EQ(law_text(plans_law(mission), mission), "as planned");
  LawChange law = slower(0.25 * mission.law.u_max_mps, 0.125);
  law.kinds[0].u_max_mps = 0.25;
  EXPECT_EQ(law_text(law, mission), "u_max_mps 0.25, noise_intensity 0.125");
}

TEST(OperatorName, IsCutAndPrintable) {
  EXPECT_EQ(operator_name_of("anna@base"), "anna@base");
  EXPECT_EQ(operator_name_of("J\xc3\xb6rg\n"), "J??rg?");
  EXPECT_EQ(operator_name_of(std::string(50, 'a')), std::string(32, 'a'));
}

/// The longest list of any mission. It must fit beside the longest plan.
TEST(AmendmentBytes, OfTheLongestListFitBesideTheLongestPlan) {
  Amendments list;
  list.recent.assign(kMaxRecentAmendments, Amendment{});
  for (Amendment& one : list.recent) one.by.assign(kMaxOperatorNameLength, 'a');
  list.holds.resize(kMaxHolds);
  list.ends.resize(kMaxEnds);
  // In a free domain a target has its numbers twice.
  const auto most_numbers = std::max(kMaxModes, 2 * kMostFreeModes);
  list.targets.assign(2, {.target = Coefficients::Zero(most_numbers), .cosine = {}});
  list.zones.assign(kMaxZones, {.corners_m = Ring(kMaxZoneCorners)});
  list.laws.assign(kMaxLaws, {.kinds = std::vector<LawNumbers>(kMaxKinds)});
  constexpr std::size_t kRoom =
      std::size_t{kMaxMissionParts - kMaxPlanParts} * std::size_t{kMaxPlanBytesPerMessage};
  EXPECT_LE(encode_amendments(list).size(), kRoom);
}

}  // namespace
}  // namespace ergocast
