// SPDX-License-Identifier: BSD-3-Clause
// The coverage table as a CRDT: with any loss, repetition or order, tables that received the same
// blocks are equal; and c_k, (4), from its blocks.
#include "core/law/coverage_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/noise.h"

namespace ergocast {
namespace {

constexpr double kDt = 0.1;
constexpr std::int64_t kManySteps = 1000000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Box kRectangle{{0, 0, 0}, {2000, 1000, 0}};

/// 15 × 15 modes: two blocks, the second with 97 modes and 31 zeros.
Basis basis_of(int modes_per_axis = 15) {
  Basis basis;
  basis.modes_x = basis.modes_y = modes_per_axis;
  return basis;
}

CoverageTable table_of(int modes_per_axis = 15) { return {basis_of(modes_per_axis), kDt}; }

Eigen::Vector3d point(AgentId agent, std::int64_t step) {
  return uniform_in(kRectangle, 3, Purpose::kStart, static_cast<std::uint32_t>(agent),
                    static_cast<std::uint64_t>(step));
}

/// An agent's own blocks after `steps` samples of its path.
std::vector<Contribution> blocks_of(const Author& author, std::int64_t steps) {
  CoverageTable own = table_of();
  for (std::int64_t step = 0; step < steps; ++step) {
    own.add_sample(author, BasisAt(point(author.agent, step), kRectangle, basis_of()));
  }
  std::vector<Contribution> blocks{own.block(author, 0), own.block(author, 1)};
  for (Contribution& block : blocks) block.next_broadcast_tick = steps;
  return blocks;
}

/// Everything that a table holds of these authors, and the average.
struct Held {
  std::vector<Contribution> blocks;
  Coefficients average = Coefficients::Zero(225);
  std::size_t rows = 0;
};
Held held(const CoverageTable& table, const std::vector<Author>& authors) {
  Held all;
  for (const Author& author : authors) {
    for (int b = 0; b < table.block_count(); ++b) all.blocks.push_back(table.block(author, b));
  }
  table.average(all.average);
  all.rows = table.row_count();
  return all;
}
void expect_same(const Held& a, const Held& b) {
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i) {
    EXPECT_EQ(a.blocks[i].steps, b.blocks[i].steps);
    EXPECT_EQ(a.blocks[i].next_broadcast_tick, b.blocks[i].next_broadcast_tick);
    EXPECT_EQ(a.blocks[i].sums, b.blocks[i].sums);
  }
  EXPECT_EQ(a.average, b.average) << "bit for bit";
  EXPECT_EQ(a.rows, b.rows);
}

const std::vector<Author> kTeam{{0, 7}, {0, 9}, {1, 5}, {2, 1}};

/// All messages: each author's blocks after 1, 2, 5 and 8 steps.
std::vector<Contribution> everything_sent() {
  std::vector<Contribution> sent;
  for (const Author& author : kTeam) {
    for (const std::int64_t steps : {1, 2, 5, 8}) {
      for (const Contribution& block : blocks_of(author, steps)) sent.push_back(block);
    }
  }
  return sent;
}

Held held_after(const std::vector<Contribution>& sent) {
  CoverageTable table = table_of();
  for (const Contribution& block : sent) table.merge(block, kManySteps);
  return held(table, kTeam);
}

// ---- a state-based CRDT ----

TEST(CoverageTable, OrderAndRepetitionOfMessagesDoNotMatter) {
  std::vector<Contribution> sent = everything_sent();
  const Held in_order = held_after(sent);
  for (std::uint64_t round = 0; round < 50; ++round) {
    // Shuffled by our own generator, with some messages twice.
    std::vector<std::pair<std::uint64_t, Contribution>> keyed;
    for (std::uint32_t i = 0; i < sent.size(); ++i) {
      const RandomBits words = random_words(round, Purpose::kFault, i, 0);
      keyed.emplace_back(words.first, sent[i]);
      if (words.second % 3 == 0) keyed.emplace_back(words.second, sent[i]);
    }
    std::sort(keyed.begin(), keyed.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Contribution> shuffled;
    for (const auto& [key, block] : keyed) shuffled.push_back(block);
    expect_same(held_after(shuffled), in_order);
  }
}

TEST(CoverageTable, MergingIsAssociative) {
  // Two groups that exchange what they hold end up with what one group would hold.
  const std::vector<Contribution> sent = everything_sent();
  CoverageTable left = table_of(), right = table_of();
  for (std::size_t i = 0; i < sent.size(); ++i) {
    (i % 2 == 0 ? left : right).merge(sent[i], kManySteps);
  }
  for (const Author& author : kTeam) {
    for (int b = 0; b < 2; ++b) {
      const Contribution relayed = right.block(author, b);
      if (relayed.steps > 0) left.merge(relayed, kManySteps);
    }
  }
  expect_same(held(left, kTeam), held_after(sent));
}

TEST(CoverageTable, LostMessagesAreContainedInTheNext) {
  std::vector<Contribution> last;
  for (const Author& author : kTeam) {
    for (const Contribution& block : blocks_of(author, 8)) last.push_back(block);
  }
  expect_same(held_after(last), held_after(everything_sent()));
}

TEST(CoverageTable, WithoutGainsItHoldsTheSame) {
  const std::vector<Contribution> sent = everything_sent();
  CoverageTable table = table_of();
  table.forgo_gains();
  for (const Contribution& block : sent) table.merge(block, kManySteps);
  expect_same(held(table, kTeam), held_after(sent));
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    EXPECT_EQ(table.gains(row, 0).steps, 0);
  }
}

TEST(CoverageTable, ReportsWhetherAMessageWasNew) {
  CoverageTable table = table_of();
  const Contribution older = blocks_of({1, 5}, 3)[0], newer = blocks_of({1, 5}, 4)[0];
  EXPECT_EQ(table.merge(older, kManySteps), Merge::kNewer);
  EXPECT_EQ(table.merge(older, kManySteps), Merge::kStale);
  EXPECT_EQ(table.merge(newer, kManySteps), Merge::kNewer);
  EXPECT_EQ(table.merge(older, kManySteps), Merge::kStale) << "an older one never wins";
  EXPECT_EQ(table.block({1, 5}, 0).steps, 4);
  EXPECT_EQ(table.block({1, 5}, 0).sums, newer.sums);
}

TEST(CoverageTable, EachBlockIsMergedByItself) {
  CoverageTable table = table_of();
  table.merge(blocks_of({1, 5}, 3)[0], kManySteps);
  table.merge(blocks_of({1, 5}, 7)[1], kManySteps);
  EXPECT_EQ(table.block({1, 5}, 0).steps, 3);
  EXPECT_EQ(table.block({1, 5}, 1).steps, 7);
  EXPECT_EQ(table.steps_held({1, 5}), 3) << "the fewest of its blocks";
}

TEST(CoverageTable, IncarnationsOfOneAgentAreRowsOfTheirOwn) {
  CoverageTable table = table_of();
  table.merge(blocks_of({0, 7}, 3)[0], kManySteps);
  table.merge(blocks_of({0, 9}, 2)[0], kManySteps);
  EXPECT_EQ(table.row_count(), 2u);
  EXPECT_EQ(table.block({0, 7}, 0).steps, 3);
  EXPECT_EQ(table.block({0, 9}, 0).steps, 2);
}

// ---- c_k ----

TEST(CoverageTable, OneSampleGivesTheLimitOf4AtTheStart) {
  CoverageTable table = table_of();
  const Eigen::Vector3d x_m(123.4, 567.8, 0);
  table.add_sample({0, 1}, BasisAt(x_m, kRectangle, basis_of()));
  Coefficients average = Coefficients::Zero(225);
  table.average(average);
  const Coefficients f = basis_values(x_m, kRectangle, basis_of());
  // ·dt, /dt: two roundings of numbers of at most 1.
  EXPECT_LE((average - f).cwiseAbs().maxCoeff(), 3 * 0x1p-53);
}

TEST(CoverageTable, AverageWeighsEachRowByTheTimeItCoversBlockByBlock) {
  CoverageTable table = table_of();
  // Agent 1 is known in both blocks, but with different ages; agent 2 only in the second.
  const auto one_old = blocks_of({1, 5}, 2), one_new = blocks_of({1, 5}, 6);
  const auto two = blocks_of({2, 1}, 3);
  table.merge(one_new[0], kManySteps);
  table.merge(one_old[1], kManySteps);
  table.merge(two[1], kManySteps);
  Coefficients average = Coefficients::Constant(225, 77);
  table.average(average);

  Coefficients expected = Coefficients::Zero(225);
  const auto add = [&](AgentId agent, std::int64_t steps, int block, double total_steps) {
    for (std::int64_t step = 0; step < steps; ++step) {
      const Coefficients f = basis_values(point(agent, step), kRectangle, basis_of());
      for (int k = 128 * block; k < std::min(128 * (block + 1), 225); ++k) {
        expected[k] += f[k] / total_steps;
      }
    }
  };
  add(1, 6, 0, 6);
  add(1, 2, 1, 5);
  add(2, 3, 1, 5);
  // At most 9 additions and 3 products of numbers of at most 1, on either side.
  EXPECT_LE((average - expected).cwiseAbs().maxCoeff(), 2 * 12 * 0x1p-53);
  EXPECT_DOUBLE_EQ(average[0], 1) << "S_00 is the time covered";
}

TEST(CoverageTable, BlocksThatNoAgentHasCoveredAreZero) {
  CoverageTable table = table_of();
  Coefficients average = Coefficients::Constant(225, kNan);
  table.average(average);
  EXPECT_EQ(average, Coefficients::Zero(225)) << "no row at all";
  table.merge(blocks_of({1, 5}, 2)[0], kManySteps);
  average.setConstant(kNan);
  table.average(average);
  for (int k = 128; k < 225; ++k) EXPECT_EQ(average.data()[k], 0) << k;
  EXPECT_NE(average.data()[127], 0);
}

TEST(CoverageTable, ItsOwnSamplesAndItsOwnMessagesAreTheSame) {
  // A teammate that receives everything has the same row, bit for bit.
  CoverageTable own = table_of(), teammate = table_of();
  const Author self{3, 33};
  for (std::int64_t step = 0; step < 50; ++step) {
    own.add_sample(self, BasisAt(point(3, step), kRectangle, basis_of()));
  }
  for (int b = 0; b < 2; ++b) EXPECT_EQ(teammate.merge(own.block(self, b), 50), Merge::kNewer);
  expect_same(held(own, {self}), held(teammate, {self}));
}

TEST(CoverageTable, TheLastBlockIsPaddedWithZeros) {
  const Contribution last = blocks_of({0, 1}, 9)[1];
  for (std::size_t k = 225 - 128; k < 128; ++k) EXPECT_EQ(last.sums[k], 0) << k;
  EXPECT_NE(last.sums[225 - 128 - 1], 0);
}

TEST(CoverageTable, HasAsManyBlocksAsTheModesNeed) {
  const auto blocks = [](int modes_x, int modes_y) {
    Basis basis;
    basis.modes_x = modes_x;
    basis.modes_y = modes_y;
    return CoverageTable(basis, kDt).block_count();
  };
  EXPECT_EQ(blocks(1, 1), 1);
  EXPECT_EQ(blocks(16, 8), 1);
  EXPECT_EQ(blocks(43, 3), 2);
  EXPECT_EQ(blocks(64, 64), 32);
}

// ---- what lockstep asks ----

TEST(CoverageTable, HoldsADueBlockUntilTheNextIsDue) {
  CoverageTable table = table_of();
  const Author author{1, 5};
  EXPECT_FALSE(table.holds_due(author, 0)) << "unknown";
  auto blocks = blocks_of(author, 3);
  blocks[0].next_broadcast_tick = blocks[1].next_broadcast_tick = 6;
  table.merge(blocks[0], kManySteps);
  EXPECT_FALSE(table.holds_due(author, 3)) << "one of two blocks";
  table.merge(blocks[1], kManySteps);
  EXPECT_TRUE(table.holds_due(author, 3));
  EXPECT_TRUE(table.holds_due(author, 5));
  EXPECT_FALSE(table.holds_due(author, 6));
}

TEST(CoverageTable, KnowsNothingOfAStranger) {
  const CoverageTable table = table_of();
  EXPECT_EQ(table.steps_held({4, 4}), std::nullopt);
  EXPECT_EQ(table.block({4, 4}, 1).steps, 0);
  EXPECT_EQ(table.block({4, 4}, 1).elapsed_s, 0);
}

// ---- limits ----

void expect_refused(const Contribution& lie, std::int64_t max_steps = kManySteps) {
  CoverageTable table = table_of();
  table.merge(blocks_of({1, 5}, 2)[0], kManySteps);
  const Held before = held(table, {{1, 5}});
  const Merge merged = table.merge(lie, max_steps);
  EXPECT_TRUE(merged == Merge::kRefusedRange || merged == Merge::kRefusedShift);
  expect_same(held(table, {{1, 5}}), before);
}

TEST(CoverageTableRefuses, WhatDoesNotFitTheMission) {
  const Contribution honest = blocks_of({1, 5}, 4)[0];
  Contribution lie = honest;
  lie.mode_count = 224;
  expect_refused(lie);
  for (const std::int32_t block : {-1, 2, std::numeric_limits<std::int32_t>::max(),
                                   std::numeric_limits<std::int32_t>::min()}) {
    lie = honest;
    lie.block = block;
    expect_refused(lie);
  }
  lie = honest;
  lie.next_broadcast_tick = -1;
  expect_refused(lie);
}

TEST(CoverageTableRefuses, AnElapsedTimeThatIsNotThatOfItsSteps) {
  for (const double elapsed_s : {0.4 * (1 + 1e-8), 0.4 * (1 - 1e-8), 0.0, -0.4, kNan,
                                 std::numeric_limits<double>::infinity()}) {
    Contribution lie = blocks_of({1, 5}, 4)[0];
    lie.elapsed_s = elapsed_s;
    expect_refused(lie);
  }
  for (const std::int64_t steps : {std::int64_t{0}, std::int64_t{-4}, std::int64_t{5},
                                   std::numeric_limits<std::int64_t>::min()}) {
    Contribution lie = blocks_of({1, 5}, 4)[0];
    lie.steps = steps;
    expect_refused(lie);
  }
}

TEST(CoverageTableRefuses, SumsThatCannotBeTrue) {
  for (const std::size_t mode : {0u, 1u, 127u}) {
    for (const double sum : {0.4 * (1 + 1e-8), -0.4 * (1 + 1e-8), kNan, -kNan,
                             std::numeric_limits<double>::infinity()}) {
      Contribution lie = blocks_of({1, 5}, 4)[0];
      lie.sums.edit()[mode] = sum;
      expect_refused(lie);
    }
  }
  // The padding is checked too: unused numbers must be 0.
  Contribution lie = blocks_of({1, 5}, 4)[1];
  lie.sums.edit()[127] = 0.5;
  expect_refused(lie);
}

TEST(CoverageTableRefuses, AnS00ThatIsNotTheTimeItCovers) {
  for (const double s00 : {0.0, 0.2, -0.4, 0.4 * (1 - 1e-8)}) {
    Contribution lie = blocks_of({1, 5}, 4)[0];
    lie.sums.edit()[0] = s00;
    expect_refused(lie);
  }
}

TEST(CoverageTableRefuses, AForgedFutureWhichWouldWinForEver) {
  CoverageTable table = table_of();
  const Contribution block = blocks_of({1, 5}, 4)[0];
  EXPECT_EQ(table.merge(block, 3), Merge::kRefusedRange);
  EXPECT_EQ(table.row_count(), 0u);
  EXPECT_EQ(table.merge(block, 4), Merge::kNewer);
}

TEST(CoverageTableAccepts, HonestRoundingOfACosine) {
  // |cos| by recurrence may exceed 1 by 3e-15.
  Contribution block = blocks_of({1, 5}, 1)[0];
  std::ranges::fill(block.sums.edit(), 0.1 * (1 + 3e-15));
  block.sums.edit()[0] = 0.1;
  CoverageTable table = table_of();
  EXPECT_EQ(table.merge(block, kManySteps), Merge::kNewer);
}

TEST(CoverageTableAccepts, HonestRoundingOfManyAdditions) {
  // 0.3 s added 1e8 times, the longest mission, is 5e-2 s off: more than any fixed share of 1e-9.
  constexpr std::int64_t kSteps = 100000000;
  double s00 = 0;
  for (std::int64_t i = 0; i < kSteps; ++i) s00 += 0.3;
  const double elapsed_s = static_cast<double>(kSteps) * 0.3;
  ASSERT_GT(std::abs(s00 / elapsed_s - 1), 1e-9) << "the case is worth a test";
  Contribution block;
  block.header.sender = 1;
  block.header.incarnation = 5;
  block.steps = kSteps;
  block.elapsed_s = elapsed_s;
  block.mode_count = 225;
  block.sums.edit()[0] = s00;
  CoverageTable table(basis_of(), 0.3);
  EXPECT_EQ(table.merge(block, kSteps), Merge::kNewer);
}

/// The block after the first step, with four modes.
Contribution first_step() {
  Contribution block;
  block.steps = 1;
  block.elapsed_s = kDt;
  block.mode_count = 4;
  block.sums.edit()[0] = kDt;
  return block;
}

TEST(CoverageTableLimits, SixteenIncarnationsOfAnAgentAndTheOthersAreNotAffected) {
  CoverageTable table = table_of(2);
  Contribution block = first_step();
  block.header.sender = 3;
  for (Incarnation incarnation = 1; incarnation <= 40; ++incarnation) {
    block.header.incarnation = incarnation;
    EXPECT_EQ(table.merge(block, 10),
              incarnation <= kMaxIncarnationsPerAgent ? Merge::kNewer : Merge::kRefusedLimit);
  }
  EXPECT_EQ(table.row_count(), static_cast<std::size_t>(kMaxIncarnationsPerAgent));
  block.header.sender = 4;
  EXPECT_EQ(table.merge(block, 10), Merge::kNewer);
  block.header.sender = 3;
  block.header.incarnation = 7;
  block.steps = 2;
  block.elapsed_s = block.sums.edit()[0] = 2 * kDt;
  EXPECT_EQ(table.merge(block, 10), Merge::kNewer) << "a known life goes on";
}

TEST(CoverageTableLimits, AgentsBeyondTheLimitGetNoRow) {
  CoverageTable table = table_of(2);
  Contribution block = first_step();
  block.header.incarnation = 1;
  for (const AgentId agent : {-1, -5, kMaxAgents, std::numeric_limits<AgentId>::max()}) {
    block.header.sender = agent;
    EXPECT_EQ(table.merge(block, 10), Merge::kRefusedLimit);
  }
  EXPECT_EQ(table.row_count(), 0u);
  block.header.sender = kMaxAgents - 1;
  EXPECT_EQ(table.merge(block, 10), Merge::kNewer);
}

}  // namespace
}  // namespace ergocast
