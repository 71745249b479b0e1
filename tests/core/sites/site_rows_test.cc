// SPDX-License-Identifier: BSD-3-Clause
// A site's row against the members' rows that it sums up, the order of rows, and teams of sites on
// random histories: no sample counts twice, and at rest each counts once.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/law/site_row.h"
#include "core/law/site_table.h"
#include "tests/core/sites/site_history.h"

namespace ergocast {
namespace {

constexpr int kModes = 3;
const Author kParent{4, 40};

/// A member that has covered for `steps` seconds, and gains one a second.
struct Covered {
  MemberRowName name;
  std::int64_t steps;
  std::array<double, kModes> sums, gains{1, 0.5, -0.25};

  Covered(AgentId agent, std::int64_t revision, std::int64_t n)
      : name{{agent, 1}, revision},
        steps(n),
        sums{static_cast<double>(n), static_cast<double>(n) / 3, -static_cast<double>(n) / 7} {}
  MemberRow row() const {
    return {.name = name,
            .steps = steps,
            .elapsed_s = static_cast<double>(steps),
            .sums = sums.data(),
            .gains = gains.data(),
            .gained_s = 1,
            .lag_s = 1,
            .counts_in_team = true};
  }
};

SiteRow row_of(int site, std::int64_t revision, Tick tick, const std::vector<Covered>& members,
               const Author& parent = kParent) {
  SiteRow row(site, kModes);
  row.restart(revision, parent, tick);
  for (const Covered& member : members) row.add(member.row());
  return row;
}

std::vector<double> coverage_of(const SiteTable& table) {
  std::vector<double> sums(kModes);
  sums.push_back(table.add_coverage(sums.data()));
  return sums;
}

/// A mission of 1000 steps of a second, with broadcasts every ten.
Mission mission() {
  Mission mission;
  mission.domain.size_m = {1000, 1000, 0};
  mission.basis.modes_x = kModes;
  mission.basis.modes_y = 1;
  mission.target_coefficients = Coefficients::Zero(kModes);
  mission.target_coefficients[0] = 1;
  mission.law.u_max_mps = 20;
  mission.law.anticipation = 2;
  mission.timing.dt_s = 1;
  mission.timing.tick_count = 1000;
  mission.timing.broadcast_period_ticks = 10;
  return mission;
}

// ---- a row ----

TEST(SiteRow, IsTheSumOverItsMembersByQuality) {
  const Covered first(0, 1, 6), second(1, 1, 9);
  MemberRow good = second.row();
  good.quality = 2;
  good.lag_s = 4;
  SiteRow row(0, kModes);
  row.restart(7, kParent, 9);
  ASSERT_TRUE(row.add(first.row()));
  ASSERT_TRUE(row.add(good));
  EXPECT_EQ(row.elapsed_s(), 6 + 2 * 9);
  EXPECT_EQ(row.sums()[1], 6.0 / 3 + 2 * (9.0 / 3));
  EXPECT_EQ(row.rates()[2], -0.25 + 2 * -0.25);
  EXPECT_EQ(row.rate_quality(), 3);
  EXPECT_EQ(row.lag_s(), (1 + 2 * 4) / 3.0);
  EXPECT_EQ(row.team_size(), 2);
  EXPECT_EQ(row.order(), (SiteRowOrder{7, kParent, 15, 9}));
  EXPECT_TRUE(row.is_possible());
}

TEST(SiteRow, CountsCoverageOfAFormerIncarnationWithoutForecast) {
  Covered member(2, 5, 10), before(2, 1, 30);
  MemberRow former = before.row();
  former.gains = nullptr;
  former.counts_in_team = false;
  member.name.author.incarnation = 2;
  SiteRow row(0, kModes);
  row.restart(7, kParent, 9);
  ASSERT_TRUE(row.add(former));
  ASSERT_TRUE(row.add(member.row()));
  EXPECT_EQ(row.elapsed_s(), 40);
  EXPECT_EQ(row.rate_quality(), 1);
  EXPECT_EQ(row.lag_s(), 1);
  EXPECT_EQ(row.team_size(), 1);
}

TEST(SiteRow, TakesEachMembersRowOnceAndInOrder) {
  SiteRow row = row_of(0, 1, 0, {{1, 1, 5}, {1, 3, 2}});
  EXPECT_FALSE(row.add(Covered(1, 3, 2).row())) << "again";
  EXPECT_FALSE(row.add(Covered(0, 9, 2).row())) << "after a greater name";
  EXPECT_FALSE(row.add(Covered(2, 1, 0).row())) << "without steps";
  EXPECT_EQ(row.members().size(), 2U);
  EXPECT_EQ(row.elapsed_s(), 7);
  EXPECT_EQ(row.order().steps, 7);
}

TEST(SiteRow, IsAsNewAfterARestart) {
  SiteRow row = row_of(0, 1, 3, {{1, 1, 5}, {2, 1, 2}});
  row.restart(2, kParent, 4);
  EXPECT_EQ(row.order(), (SiteRowOrder{2, kParent, 0, 4}));
  EXPECT_EQ(row.elapsed_s(), 0);
  EXPECT_EQ(row.lag_s(), 0);
  const Covered member(0, 1, 3);
  ASSERT_TRUE(row.add(member.row())) << "also before the former names";
  EXPECT_EQ(row.sums()[1], member.sums[1]);
  EXPECT_EQ(row.rates()[1], member.gains[1]);
  EXPECT_EQ(row.rate_quality(), 1);
  EXPECT_EQ(row.team_size(), 1);
}

TEST(SiteRow, HasRoomForSoManyMembersRows) {
  SiteRow row(0, kModes);
  row.restart(1, kParent, 0);
  for (std::size_t i = 0; i < kMostMemberRows; ++i)
    ASSERT_TRUE(row.add(Covered(static_cast<AgentId>(i), 1, 1).row()));
  EXPECT_FALSE(row.add(Covered(2000, 1, 1).row()));
  EXPECT_EQ(row.elapsed_s(), static_cast<double>(kMostMemberRows));
}

TEST(SiteRow, RefusesWhatNoMemberCanCover) {
  const auto with = [](auto change) {
    Covered member(0, 1, 10);
    MemberRow row = member.row();
    change(member, row);
    SiteRow sum(0, kModes);
    sum.restart(1, kParent, 0);
    sum.add(row);
    return sum.is_possible();
  };
  EXPECT_TRUE(with([](Covered&, MemberRow&) {}));
  EXPECT_FALSE(with([](Covered& member, MemberRow&) { member.sums[1] = 10.1; }));
  EXPECT_FALSE(with([](Covered& member, MemberRow&) { member.gains[2] = -1.1; }));
  EXPECT_FALSE(with([](Covered&, MemberRow& row) { row.elapsed_s = -1; }));
  EXPECT_FALSE(with([](Covered&, MemberRow& row) { row.lag_s = -1; }));
  EXPECT_FALSE(with([](Covered&, MemberRow& row) { row.quality = -1; }));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(with([](Covered& member, MemberRow&) { member.sums[0] = kNan; }));
  EXPECT_FALSE(with([](Covered& member, MemberRow&) { member.gains[0] = kNan; }));
  EXPECT_FALSE(with([](Covered&, MemberRow& row) { row.elapsed_s = kNan; }));
  EXPECT_FALSE(with([](Covered&, MemberRow& row) { row.lag_s = kNan; }));
}

// ---- the order of rows ----

TEST(SiteTable, ANewerRevisionWinsAlsoWithFewerSteps) {
  const SiteRow former = row_of(1, 5, 30, {{1, 1, 30}, {4, 1, 30}});
  const SiteRow successor = row_of(1, 6, 20, {{1, 1, 12}}, {1, 1});
  SiteTable table(2, 0, kModes, 10);
  EXPECT_EQ(table.merge(former), SiteMerge::kNewer);
  EXPECT_EQ(table.merge(successor), SiteMerge::kNewer);
  EXPECT_EQ(table.merge(former), SiteMerge::kStale) << "it arrives late";
  EXPECT_EQ(table.held(1), successor.order());
  EXPECT_EQ(coverage_of(table), (std::vector<double>{12, 12.0 / 3, -12.0 / 7, 12}));
}

TEST(SiteTable, HoldsTheSameWhateverTheOrderOfArrival) {
  std::vector<SiteRow> rows{row_of(0, 1, 3, {{1, 1, 3}}),
                            row_of(0, 1, 4, {{1, 1, 4}, {2, 1, 1}}),
                            row_of(0, 1, 5, {{1, 1, 4}, {2, 1, 1}}),
                            row_of(1, 2, 3, {{3, 1, 7}}),
                            row_of(1, 4, 2, {{3, 1, 5}}, {3, 1}),
                            row_of(1, 4, 2, {{3, 1, 6}}, {3, 1})};
  std::vector<std::size_t> order{0, 1, 2, 3, 4, 5};
  const LookAhead look_ahead(mission());
  do {
    SiteTable table(3, 2, kModes, 10);
    for (const std::size_t i : order) table.merge(rows[i]);
    table.merge(rows[order[0]]);
    ASSERT_EQ(table.held(0), rows[2].order());
    ASSERT_EQ(table.held(1), rows[5].order());
    std::vector<double> sums(kModes), expected(kModes);
    const double time_s = table.add_forecast(look_ahead, 2, 9, sums.data());
    double expected_s = 0;
    for (const SiteRow* row : {&rows[2], &rows[5]}) {
      const double w = 2 + 1 + static_cast<double>(9 - row->order().tick);
      for (std::size_t k = 0; k < kModes; ++k) expected[k] += row->sums()[k] + w * row->rates()[k];
      expected_s += row->elapsed_s() + w * row->rate_quality();
    }
    ASSERT_EQ(sums, expected) << "bit for bit";
    ASSERT_EQ(time_s, expected_s);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(SiteTable, RefusesARowOfAnotherShape) {
  SiteTable table(2, 0, kModes, 10);
  EXPECT_EQ(table.merge(row_of(2, 1, 0, {{1, 1, 1}})), SiteMerge::kRefusedRange);
  EXPECT_EQ(table.merge(row_of(-1, 1, 0, {{1, 1, 1}})), SiteMerge::kRefusedRange);
  EXPECT_EQ(table.merge(SiteRow(1, kModes + 1)), SiteMerge::kRefusedRange);
  Covered impossible(1, 1, 1);
  impossible.sums[2] = -2;
  EXPECT_EQ(table.merge(row_of(1, 1, 0, {impossible})), SiteMerge::kRefusedRange);
  EXPECT_EQ(coverage_of(table), std::vector<double>(kModes + 1));
}

// ---- what counts ----

TEST(SiteTable, TheOwnSitesRowCountsOnlyAfterLeavingIt) {
  SiteTable table(2, 0, kModes, 10);
  table.merge(row_of(0, 1, 5, {{0, 1, 3}, {1, 1, 3}}));
  table.merge(row_of(1, 1, 5, {{2, 1, 4}}));
  EXPECT_EQ(coverage_of(table).back(), 4);
  EXPECT_EQ(table.team_size(), 1);
  table.set_own_site(1);
  EXPECT_EQ(coverage_of(table).back(), 6);
  EXPECT_EQ(table.team_size(), 2) << "members, not rows";
}

TEST(SiteTable, AnOldRowKeepsItsPlaceInNAndLosesItsForecast) {
  const LookAhead look_ahead(mission());
  SiteTable table(2, 0, kModes, 10);
  table.merge(row_of(1, 1, 100, {{2, 1, 4}, {3, 1, 6}}));
  constexpr Tick kCap = 80;  // eight periods
  std::vector<double> sums(kModes);
  EXPECT_EQ(table.add_forecast(look_ahead, 5, 100 + kCap, sums.data()), 10 + (5 + 80 + 1) * 2);
  sums.assign(kModes, 0);
  EXPECT_EQ(table.add_forecast(look_ahead, 5, 101 + kCap, sums.data()), 10);
  EXPECT_EQ(sums[0], 10);
  EXPECT_EQ(table.team_size(), 2);
}

/// The denominator of ĉ is exact for any ages, the numerator for equal ones.
TEST(SiteTable, ForecastsAsTheMembersRowsWould) {
  const LookAhead look_ahead(mission());
  std::vector<MemberRow> members;
  const std::vector<Covered> covered{{0, 1, 8}, {1, 1, 20}, {2, 1, 5}};
  for (const Covered& member : covered) members.push_back(member.row());
  members[1].quality = 3;
  for (const bool equal : {true, false}) {
    if (!equal) members[2].lag_s = 6;
    SiteRow row(1, kModes);
    row.restart(1, kParent, 20);
    std::vector<double> expected(kModes);
    double expected_s = 0, spread_s = 0;
    for (const MemberRow& member : members) {
      row.add(member);
      const double w = 7 + 5 + member.lag_s;
      for (std::size_t k = 0; k < kModes; ++k)
        expected[k] += member.quality * (member.sums[k] + w * member.gains[k]);
      expected_s += member.quality * (member.elapsed_s + w);
    }
    for (const MemberRow& member : members)
      spread_s += member.quality * std::abs(member.lag_s - row.lag_s());
    SiteTable table(2, 0, kModes, 10);
    ASSERT_EQ(table.merge(row), SiteMerge::kNewer);
    std::vector<double> sums(kModes);
    EXPECT_DOUBLE_EQ(table.add_forecast(look_ahead, 7, 25, sums.data()), expected_s);
    for (std::size_t k = 0; k < kModes; ++k)
      EXPECT_NEAR(sums[k], expected[k], 1e-12 + (equal ? 0 : spread_s)) << k;
  }
}

// ---- whole teams ----

TEST(SiteHistory, NoSampleCountsTwiceAndAtRestEachCountsOnce) {
  for (std::uint64_t number = 0; number < 25; ++number)
    EXPECT_EQ(test::SiteHistory(number).run(), "") << "history " << number;
}

TEST(SiteHistory, EachFlawIsFound) {
  for (int flaw = 1; flaw < test::kSiteFlaws; ++flaw) {
    bool found = false;
    for (std::uint64_t number = 0; number < 20 && !found; ++number)
      found = !test::SiteHistory(number, static_cast<test::SiteFlaw>(flaw)).run().empty();
    EXPECT_TRUE(found) << "flaw " << flaw;
  }
}

}  // namespace
}  // namespace ergocast
