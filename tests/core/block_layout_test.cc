// SPDX-License-Identifier: BSD-3-Clause
// Which modes are in which block, and that tables and forecasts do not depend on it.
#include "core/law/block_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/base/noise.h"
#include "core/law/forecast.h"
#include "tests/core/forecast_history.h"

namespace ergocast {
namespace {

using namespace test;

Mission mission_with(int modes_x, int modes_y, int modes_z, int factor,
                     ContributionEncoding encoding = ContributionEncoding::kDouble) {
  Mission mission = mission_of(true);
  mission.basis.modes_x = modes_x;
  mission.basis.modes_y = modes_y;
  mission.basis.modes_z = modes_z;
  if (modes_z > 1) mission.domain.size_m.z() = 300;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.timing.high_mode_period_factor = factor;
  mission.timing.contribution_encoding = encoding;
  return mission;
}

/// The modes of all blocks in the order in which they travel.
std::vector<std::vector<int>> modes_by_block(const Mission& mission) {
  const BlockLayout layout(mission);
  std::vector<double> modes(static_cast<std::size_t>(mission.basis.mode_count()));
  std::iota(modes.begin(), modes.end(), 0);
  std::vector<double> slots(static_cast<std::size_t>(layout.slot_count()), -1);
  if (layout.in_basis_order()) {
    slots = modes;
  } else {
    layout.to_slots(modes.data(), slots.data());
  }
  std::vector<std::vector<int>> blocks;
  for (int b = 0; b < layout.block_count(); ++b) {
    const auto [first, count] = layout.slots_of(b);
    EXPECT_EQ(first, b * layout.block_size());
    EXPECT_LE(count, layout.size_of(b));
    blocks.emplace_back(slots.begin() + first, slots.begin() + first + count);
  }
  EXPECT_EQ(blocks.size(), static_cast<std::size_t>(block_count_of(mission)));
  return blocks;
}

std::vector<std::size_t> sizes_of(const Mission& mission) {
  std::vector<std::size_t> sizes;
  for (const auto& block : modes_by_block(mission)) sizes.push_back(block.size());
  return sizes;
}

TEST(BlockLayout, FillsBlocksAndLeavesLowModesAlone) {
  using Sizes = std::vector<std::size_t>;
  constexpr auto kFixed16 = ContributionEncoding::kFixed16;
  EXPECT_EQ(sizes_of(mission_with(20, 20, 1, 1)), (Sizes{128, 128, 128, 16}));
  EXPECT_EQ(sizes_of(mission_with(20, 20, 1, 4)), (Sizes{64, 128, 128, 80}));
  EXPECT_EQ(sizes_of(mission_with(20, 20, 1, 4, kFixed16)), (Sizes{64, 256, 80}));
  EXPECT_EQ(sizes_of(mission_with(13, 5, 1, 4)), (Sizes{64, 1}));
  EXPECT_EQ(sizes_of(mission_with(8, 8, 1, 4)), (Sizes{64})) << "there are no others";
  EXPECT_EQ(sizes_of(mission_with(8, 6, 4, 4)), (Sizes{64, 128}));
}

TEST(BlockLayout, HasTheOrderOfTheBasisUnlessHighModesAreRare) {
  for (const Mission& mission : {mission_with(20, 20, 1, 1), mission_with(8, 8, 1, 9)}) {
    EXPECT_TRUE(BlockLayout(mission).in_basis_order());
    int next = 0;
    for (const auto& block : modes_by_block(mission)) {
      for (const int mode : block) EXPECT_EQ(mode, next++);
    }
  }
}

TEST(BlockLayout, AscendsByWaveNumberAndThenAsTheBasis) {
  for (const Mission& mission : {mission_with(20, 20, 1, 4), mission_with(30, 3, 1, 2),
                                 mission_with(7, 5, 4, 4), mission_with(4, 4, 16, 10)}) {
    const Basis& basis = mission.basis;
    std::vector<std::tuple<int, int, int, int>> expected, found;  // |k|², l, m, n
    for (int l = 0; l < basis.modes_z; ++l) {
      for (int m = 0; m < basis.modes_x; ++m) {
        for (int n = 0; n < basis.modes_y; ++n)
          expected.emplace_back(l * l + m * m + n * n, l, m, n);
      }
    }
    std::sort(expected.begin(), expected.end());
    for (const auto& block : modes_by_block(mission)) {
      for (const int mode : block) {
        const int n = mode % basis.modes_y, m = mode / basis.modes_y % basis.modes_x;
        const int l = mode / (basis.modes_y * basis.modes_x);
        found.emplace_back(l * l + m * m + n * n, l, m, n);
      }
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(BlockLayout, GivesBackWhatItTook) {
  const BlockLayout layout(mission_with(20, 20, 1, 4));
  Coefficients modes = Coefficients::Random(400), back = Coefficients::Zero(400);
  std::vector<double> slots(static_cast<std::size_t>(layout.slot_count()));
  layout.to_slots(modes.data(), slots.data());
  layout.from_slots(slots.data(), back.data());
  EXPECT_EQ(back, modes);
}

// ---- tables ----

CoverageTable table_of(const Mission& mission) {
  CoverageTable table(mission.basis, kDt);
  table.set_layout(BlockLayout(mission));
  return table;
}

/// The blocks that an author has sent after `steps` steps, in their order.
std::vector<Contribution> sent_by(const Author& author, const Mission& mission, std::int64_t steps,
                                  const double* footprint = nullptr) {
  CoverageTable own = table_of(mission);
  for (std::int64_t step = 0; step < steps; ++step) {
    const BasisAt at(place(author.agent, step, mission), mission.domain, mission.basis);
    own.add_sample(author, at, footprint);
  }
  std::vector<Contribution> blocks;
  for (int b = 0; b < own.block_count(); ++b) {
    blocks.push_back(own.block(author, b));
    blocks.back().next_broadcast_tick = steps;
  }
  return blocks;
}

Coefficients average_of(const CoverageTable& table, const Mission& mission) {
  Coefficients c = Coefficients::Zero(mission.basis.mode_count());
  table.average(c);
  return c;
}

TEST(RareModes, ATableKnowsTheSameCoverageWhateverTheLayout) {
  for (const int modes_z : {1, 3}) {
    const Mission rare = mission_with(14, 12, modes_z, 4);
    Mission usual = rare;
    usual.timing.high_mode_period_factor = 1;
    Coefficients footprint = Coefficients::Random(rare.basis.mode_count()).cwiseAbs();
    footprint[0] = 1;
    const double* const footprints[] = {nullptr, footprint.data()};
    CoverageTable by_rank = table_of(rare), by_mode = table_of(usual);
    for (AgentId id = 0; id < 4; ++id) {
      const double* seen = footprints[id % 2];
      const Author author{id, 5};
      for (const Contribution& block : sent_by(author, rare, 3 + id, seen))
        EXPECT_EQ(by_rank.merge(block, kManySteps), Merge::kNewer);
      for (const Contribution& block : sent_by(author, usual, 3 + id, seen))
        by_mode.merge(block, kManySteps);
      EXPECT_EQ(average_of(by_rank, rare), average_of(by_mode, usual)) << "bit for bit";
    }
  }
}

TEST(RareModes, ABlockHasTheLengthOfItsModes) {
  const Mission rare = mission_with(20, 20, 1, 4), usual = mission_with(20, 20, 1, 1);
  const auto rare_blocks = sent_by({1, 5}, rare, 3), usual_blocks = sent_by({1, 5}, usual, 3);
  EXPECT_EQ(rare_blocks[0].sums.size(), std::size_t{kLowModes});
  EXPECT_EQ(rare_blocks[1].sums.size(), std::size_t{kBlockSize});
  CoverageTable by_rank = table_of(rare), by_mode = table_of(usual);
  EXPECT_EQ(by_mode.merge(rare_blocks[0], kManySteps), Merge::kRefusedRange);
  EXPECT_EQ(by_rank.merge(usual_blocks[0], kManySteps), Merge::kRefusedRange);
  Contribution moved = rare_blocks[0];
  moved.block = 1;
  EXPECT_EQ(by_rank.merge(moved, kManySteps), Merge::kRefusedRange);
  EXPECT_EQ(by_rank.row_count() + by_mode.row_count(), 0U);
}

TEST(RareModes, BlocksMergeInAnyOrderAndAnyNumberOfTimes) {
  const Mission mission = mission_with(20, 20, 1, 4);
  std::vector<Contribution> sent;
  for (const Author& author : {Author{0, 7}, Author{0, 9}, Author{1, 5}}) {
    for (const std::int64_t steps : {1, 4, 8}) {
      const auto blocks = sent_by(author, mission, steps);
      // High modes are sent now and then.
      sent.insert(sent.end(), blocks.begin(), steps == 4 ? blocks.begin() + 1 : blocks.end());
    }
  }
  const auto held_after = [&](const std::vector<Contribution>& blocks) {
    CoverageTable table = table_of(mission);
    for (const Contribution& block : blocks) table.merge(block, kManySteps);
    return average_of(table, mission);
  };
  const Coefficients expected = held_after(sent);
  for (std::uint64_t round = 0; round < 20; ++round) {
    Dice dice(round);
    std::vector<Contribution> shuffled = sent;
    for (std::size_t i = shuffled.size(); i > 1; --i)
      std::swap(shuffled[i - 1], shuffled[dice.below(i)]);
    for (int again = 0; again < 5; ++again) shuffled.push_back(sent[dice.below(sent.size())]);
    EXPECT_EQ(held_after(shuffled), expected) << "bit for bit, round " << round;
  }
}

TEST(RareModes, HighOnesAreWeighedByTheTimeThatTheyCover) {
  const Mission mission = mission_with(20, 20, 1, 4);
  const Author one{0, 1}, two{1, 1};
  CoverageTable table = table_of(mission), at_three = table_of(mission),
                at_nine = table_of(mission);
  const auto three = sent_by(two, mission, 3), nine = sent_by(two, mission, 9);
  for (const Contribution& block : sent_by(one, mission, 6)) {
    for (CoverageTable* each : {&table, &at_three, &at_nine}) each->merge(block, kManySteps);
  }
  for (std::size_t b = 0; b < three.size(); ++b) {
    table.merge(b == 0 ? nine[b] : three[b], kManySteps);
    at_three.merge(three[b], kManySteps);
    at_nine.merge(nine[b], kManySteps);
  }
  const Coefficients c = average_of(table, mission), low = average_of(at_nine, mission);
  const Coefficients high = average_of(at_three, mission);
  const auto blocks = modes_by_block(mission);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (const int mode : blocks[b]) ASSERT_EQ(c[mode], b == 0 ? low[mode] : high[mode]) << mode;
  }
}

// ---- forecasts ----

TEST(RareModes, WhatIsReckonedNeedNotBeSentBitForBit) {
  for (const int modes_z : {1, 2}) {
    const Mission rare = mission_with(12, 12, modes_z, 4);
    Mission usual = rare;
    usual.timing.high_mode_period_factor = 1;
    Forecast by_rank(rare, kSelf), by_mode(usual, kSelf);
    CoverageTable rare_table = table_of(rare), usual_table = table_of(usual);
    std::vector<CoverageTable> rare_own(3, table_of(rare)), usual_own(3, table_of(usual));
    const std::vector<RosterEntry> roster{{{0, 9}, 0, -1}, {{1, 9}, 0, -1}, {{2, 9}, 0, -1}};
    const auto count = rare.basis.mode_count();
    const auto send_block = [](CoverageTable& table, const CoverageTable& own, const Author& author,
                               const Mission& mission, Tick tick) {
      for (int b = 0; b < own.block_count(); ++b) {
        const bool due = tick == 0 || next_broadcast(mission, author.agent, tick - 1, b) == tick;
        if (author.agent != 0 && !due) continue;
        Contribution block = own.block(author, b);
        block.header.tick = tick;
        block.next_broadcast_tick = next_broadcast(mission, author.agent, tick, b);
        table.merge(block, kManySteps);
      }
    };
    for (Tick tick = 0; tick < 70; ++tick) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Author author = roster[i].author;
        const Eigen::Vector3d x_m = place(author.agent, tick, rare);
        const BasisAt at(x_m, rare.domain, rare.basis);
        rare_own[i].add_sample(author, at);
        usual_own[i].add_sample(author, at);
        by_rank.see(author.agent, tick, x_m);
        by_mode.see(author.agent, tick, x_m);
        send_block(rare_table, rare_own[i], author, rare, tick);
        send_block(usual_table, usual_own[i], author, usual, tick);
      }
      Coefficients ranks(count), modes(count);
      by_rank.look_ahead(rare_table, roster, tick, ranks);
      by_mode.look_ahead(usual_table, roster, tick, modes);
      ASSERT_EQ(ranks, modes) << tick;
    }
  }
}

}  // namespace
}  // namespace ergocast
