// SPDX-License-Identifier: BSD-3-Clause
// A mission gets the table with its hash or none. The table is known, passed on, or computed.
#include "modes/provide.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <thread>
#include <utility>

#include "core/law/coverage_table.h"
#include "tests/modes/rooms.h"

namespace ergocast {
namespace {

Mission mission_of(double side_m) {
  Mission mission;
  mission.domain.size_m = {side_m, side_m, 0};
  mission.basis.modes_x = 3;
  mission.basis.modes_y = 4;
  mission.basis.free_domain = true;
  return mission;
}

TEST(Provide, ComputesATableOnce) {
  const Mission mission = mission_of(50);
  const auto one = table_of(mission), other = table_of(mission);
  ASSERT_TRUE(one);
  EXPECT_EQ(one.value().get(), other.value().get());
  EXPECT_EQ(one.value()->mode_count, 12);
}

// Also for the thread sanitizer, which missed a race between accesses that computing separated by
// seconds.
TEST(Threads, MayPrepareMissionsAtOnce) {
  const Mission mission = mission_of(80);
  const ModesTable known = table_of(mission).value();
  const auto use = [&](std::uint64_t first) {
    for (std::uint64_t i = 0; i < 20; ++i) {
      auto other = std::make_shared<FreeModes>(*known);
      other->hash = first + i;
      keep_table(std::move(other));
      EXPECT_EQ(table_of(mission).value()->key, known->key);
    }
  };
  std::thread one(use, 100), other(use, 200);
  one.join();
  other.join();
}

TEST(Provide, HasAnotherTableForOtherMissions) {
  const ModesTable small = table_of(mission_of(60)).value();
  const ModesTable large = table_of(mission_of(70)).value();
  Mission more = mission_of(60);
  more.basis.modes_x = 4;
  const ModesTable richer = table_of(more).value();
  EXPECT_NE(small->hash, large->hash);
  EXPECT_NE(small->hash, richer->hash);
}

// A wall that is thinner than a cell, with a gap below.
TEST(Provide, KnowsTheMissionsWalls) {
  Mission open = mission_of(65), walled = open;
  walled.walls = {{{32, 10}, {32.4, 10}, {32.4, 65}, {32, 65}}};
  const ModesTable without = table_of(open).value();
  const ModesTable with = table_of(walled).value();
  EXPECT_NE(without->key, with->key);
  EXPECT_LT(with->eigenvalues_per_m2[1], 0.6 * without->eigenvalues_per_m2[1]);
  walled.walls = {{{32, 10}, {32.5, 10}, {32.5, 65}, {32, 65}}};
  EXPECT_NE(table_of(walled).value()->key, with->key);
}

// Each wall removes the area that it covers.
TEST(Provide, HasNoCellsInWalls) {
  Mission mission = mission_of(66);
  mission.walls = {{{20, 20}, {40, 20}, {40, 40}, {20, 40}},
                   {{25, 25}, {28, 25}, {28, 28}, {25, 28}}};
  const auto cut = table_of(mission);
  ASSERT_TRUE(cut);
  const FreeModes& modes = **cut;
  EXPECT_NEAR(modes.free_area_m2(), 66 * 66 - 20 * 20, 66 * 4) << "nor in a room without a door";
}

TEST(Provide, GivesTheTableOfTheHash) {
  Mission mission = mission_of(80);
  mission.basis.table_hash = table_of(mission).value()->hash;
  EXPECT_EQ(provide_table(mission), std::nullopt);
  ASSERT_NE(mission.basis.table, nullptr);
  EXPECT_EQ(mission.basis.table->hash, mission.basis.table_hash);
}

// Like a table of a program that rounds differently.
TEST(Provide, UsesWhatIsHandedOverInPlaceOfWhatItWouldCompute) {
  Mission mission = mission_of(90);
  const FreeGrid grid = test::grid_of(mission.domain, test::sees_all);
  auto modes = *eigen_modes(grid, 12);
  modes.values.col(5) *= 1 - 1e-6;
  const auto bytes =
      std::make_shared<const std::vector<std::byte>>(encode_table(grid, modes, 12345));
  const ModesTable theirs = decode_table(*bytes, bytes).value();
  mission.basis.table_hash = theirs->hash;
  const auto problem = provide_table(mission);
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->find("--modes"), std::string::npos) << *problem;
  EXPECT_EQ(mission.basis.table, nullptr);
  keep_table(theirs);
  EXPECT_EQ(provide_table(mission), std::nullopt);
  EXPECT_EQ(mission.basis.table.get(), theirs.get());
}

// Like a file that was changed after it was named.
TEST(Provide, ComputesTheTableOfTheHashWhereItWasHandedAnotherOne) {
  Mission mission = mission_of(95);
  const FreeGrid grid = test::grid_of(mission.domain, test::sees_all);
  auto modes = *eigen_modes(grid, 12);
  const auto encoded = [&](const EigenModes& of) {
    auto bytes = std::make_shared<const std::vector<std::byte>>(encode_table(grid, of, 54321));
    return decode_table(*bytes, bytes).value();
  };
  const std::uint64_t ours = table_of(mission).value()->hash;
  modes.values.col(5) *= 1 - 1e-6;
  keep_table(encoded(modes));
  mission.basis.table_hash = ours;
  EXPECT_EQ(provide_table(mission), std::nullopt);
}

TEST(Provide, RefusesATableOfAnotherDomainOrOfOtherModes) {
  Mission mission = mission_of(100);
  mission.basis.table_hash = table_of(mission).value()->hash;
  Mission elsewhere = mission_of(101);
  elsewhere.basis.table_hash = mission.basis.table_hash;
  EXPECT_TRUE(provide_table(elsewhere));
  Mission finer = mission;
  finer.basis.modes_x = 4;
  EXPECT_TRUE(provide_table(finer));
}

TEST(Provide, LeavesCosinesAlone) {
  Mission mission;
  EXPECT_EQ(provide_table(mission), std::nullopt);
  EXPECT_EQ(mission.basis.table, nullptr);
}

// Teammates' sums of these modes keep the bounds that tables check for all sums.
TEST(Provide, SumsOfItsModesAreAccepted) {
  Mission mission = mission_of(110);
  mission.basis.table_hash = table_of(mission).value()->hash;
  ASSERT_EQ(provide_table(mission), std::nullopt);
  CoverageTable ours(mission.basis, 0.1), theirs(mission.basis, 0.1);
  for (int i = 0; i < 1000; ++i) {
    theirs.add_sample({3, 9}, BasisAt({0.11 * i, 0.01, 0}, mission.domain, mission.basis));
    Contribution block = theirs.block({3, 9}, 0);
    block.next_broadcast_tick = i + 1;
    ASSERT_EQ(ours.merge(block, 1000), Merge::kNewer) << i;
  }
}

}  // namespace
}  // namespace ergocast
