// SPDX-License-Identifier: BSD-3-Clause
// Forgetting by halving: a row is the same whether its author or a receiver halves it, and
// nothing that is stored or relayed changes.
#include "core/mission/half_life.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/noise.h"
#include "core/law/coverage_table.h"

namespace ergocast {
namespace {

constexpr double kTick_s = 0.1;
constexpr std::int64_t kManyTicks = 1000000;
constexpr Tick kHalfLife = 7;
const Box kDomain{{0, 0, 0}, {2000, 1000, 0}};
const std::vector<Author> kAuthors{{0, 7}, {0, 9}, {1, 5}, {2, 1}};

/// 12 × 12 modes: two blocks.
Basis basis() {
  Basis basis;
  basis.modes_x = basis.modes_y = 12;
  return basis;
}

CoverageTable forgetful_table() {
  CoverageTable table(basis(), kTick_s);
  table.set_half_life(HalfLife(kHalfLife * kTick_s, kTick_s));
  return table;
}

Eigen::Vector3d place(const Author& author, Tick tick) {
  return uniform_in(kDomain, author.incarnation, Purpose::kStart,
                    static_cast<std::uint32_t>(author.agent), static_cast<std::uint64_t>(tick));
}

/// Samples of `author` at the ticks from `from` to `until`, as of the last one.
CoverageTable row_of(const Author& author, Tick from, Tick until) {
  CoverageTable table = forgetful_table();
  for (Tick tick = from; tick <= until; ++tick) {
    table.set_now(tick);
    table.add_sample(author, BasisAt(place(author, tick), kDomain, basis()));
  }
  return table;
}

std::vector<Contribution> blocks_of(const Author& author, Tick from, Tick until) {
  const CoverageTable own = row_of(author, from, until);
  std::vector<Contribution> sent;
  for (int b = 0; b < own.block_count(); ++b) {
    sent.push_back(own.block(author, b));
    sent.back().header.tick = until;
  }
  return sent;
}

void merge_all(const std::vector<Contribution>& blocks, CoverageTable& table) {
  for (const Contribution& block : blocks) EXPECT_EQ(table.merge(block, kManyTicks), Merge::kNewer);
}

Coefficients average_of(const CoverageTable& table) {
  Coefficients average = Coefficients::Constant(144, 7);
  table.average(average);
  return average;
}

// ---- the rule ----

TEST(HalfLife, IsWholeTicksAndAtLeastOne) {
  EXPECT_FALSE(HalfLife().any());
  EXPECT_FALSE(HalfLife(0, 0.1).any());
  EXPECT_EQ(HalfLife(0.74, 0.1).ticks(), 7);
  EXPECT_EQ(HalfLife(1e-3, 0.1).ticks(), 1);
}

TEST(HalfLife, HalvesBeforeTheSampleOfEachOfItsTicks) {
  const HalfLife half_life(0.7, 0.1);
  EXPECT_EQ(half_life.halvings(-1), 0);
  EXPECT_EQ(half_life.halvings(6), 0);
  EXPECT_EQ(half_life.halvings(7), 1);
  EXPECT_EQ(half_life.halvings(13), 1);
  EXPECT_EQ(half_life.halvings(14), 2);
  EXPECT_EQ(half_life.tick_of(2), 14);
  EXPECT_EQ(HalfLife().halvings(Tick{1} << 48), 0);
}

TEST(HalfLife, HasAFiniteFactorForAnyTick) {
  EXPECT_EQ(HalfLife::factor(3, 3), 1);
  EXPECT_EQ(HalfLife::factor(0, 3), 0.125);
  EXPECT_EQ(HalfLife::factor(3, 0), 8);
  EXPECT_EQ(HalfLife::factor(0, std::int64_t{1} << 60), std::ldexp(1.0, -512));
  EXPECT_EQ(HalfLife::factor(std::int64_t{1} << 60, 0), std::ldexp(1.0, 64));
}

TEST(HalfLife, LeavesWhatTheFormulaSays) {
  const Tick until = 5 * kHalfLife + 3;
  const CoverageTable own = row_of(kAuthors[0], 2, until);
  Coefficients sums = Coefficients::Zero(144);
  double time_s = 0;
  for (Tick tick = 2; tick <= until; ++tick) {
    const double left = std::pow(0.5, static_cast<double>(until / kHalfLife - tick / kHalfLife));
    sums += left * kTick_s * basis_values(place(kAuthors[0], tick), kDomain, basis());
    time_s += left * kTick_s;
  }
  EXPECT_NEAR(own.covered_s(), time_s, 1e-12);
  EXPECT_LT((average_of(own) - sums / time_s).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_EQ(own.block(kAuthors[0], 0).steps, until - 1) << "samples ever";
}

TEST(HalfLife, DoesNotMoveTheCoverageOfARowThatRests) {
  CoverageTable own = row_of(kAuthors[0], 0, 20);
  const Coefficients before = average_of(own);
  for (const Tick tick : {21, 22, 28, 70, 7000, 700000}) {
    own.set_now(tick);
    EXPECT_EQ(average_of(own), before) << tick;
  }
}

TEST(HalfLife, SumsUpWhatTicksWeigh) {
  const HalfLife half_life(0.7, 0.1);
  for (const auto& [from, until, halved] :
       {std::tuple<Tick, Tick, std::int64_t>{0, 5, 0}, {3, 16, 2}, {-4, 30, 9}, {20, 21, 1}}) {
    double expected = 0;
    for (Tick tick = from; tick < until; ++tick)
      expected += HalfLife::factor(half_life.halvings(tick), halved);
    EXPECT_EQ(half_life.remembered_ticks(from, until, halved), expected) << from << ' ' << until;
  }
  EXPECT_EQ(half_life.remembered_ticks(5, 5, 0), 0);
  EXPECT_NEAR(half_life.remembered_ticks(0, Tick{7} << 40, Tick{1} << 40), 7, 1e-15);
  EXPECT_EQ(HalfLife().remembered_ticks(3, 16, 0), 13);
}

// ---- rows that travel ----

/// Halving and merging commute, bit for bit, for rows of every age.
TEST(HalfLife, IsTheSameBeforeAndAfterMerging) {
  for (const Tick now : {20, 21, 27, 28, 60, 100, 4000}) {
    CoverageTable early = forgetful_table(), late = forgetful_table();
    for (Tick tick = 0; tick <= now; ++tick) {
      early.set_now(tick);
      for (const Author& author : kAuthors) {
        const Tick sent = 4 + 5 * (author.agent + static_cast<Tick>(author.incarnation % 2));
        if (tick == sent) merge_all(blocks_of(author, 1, sent), early);
      }
    }
    for (const Author& author : kAuthors) {
      const Tick sent = 4 + 5 * (author.agent + static_cast<Tick>(author.incarnation % 2));
      merge_all(blocks_of(author, 1, sent), late);
    }
    late.set_now(now);
    EXPECT_EQ(average_of(early), average_of(late)) << now;
    EXPECT_EQ(early.covered_s(), late.covered_s()) << now;
  }
}

/// An author and a teammate that has its row as it was sent compute the same.
TEST(HalfLife, IsTheSameAtTheAuthorAndAtAReceiver) {
  const Author author = kAuthors[2];
  for (const Tick sent : {3, 6, 7, 8, 20, 48}) {
    CoverageTable own = row_of(author, 0, sent), receiver = forgetful_table();
    merge_all(blocks_of(author, 0, sent), receiver);
    merge_all(blocks_of(kAuthors[0], 0, 30), own);
    merge_all(blocks_of(kAuthors[0], 0, 30), receiver);
    for (const Tick now : {48, 49, 56, 80}) {
      own.set_now(now);
      receiver.set_now(now);
      EXPECT_EQ(average_of(own), average_of(receiver)) << sent << ' ' << now;
      EXPECT_EQ(own.covered_s(), receiver.covered_s()) << sent << ' ' << now;
    }
  }
}

TEST(HalfLife, ChangesNothingThatIsRelayed) {
  const Author author = kAuthors[2];
  const std::vector<Contribution> sent = blocks_of(author, 0, 20);
  CoverageTable first = forgetful_table(), second = forgetful_table();
  merge_all(sent, first);
  first.set_now(70);
  for (const Contribution& block : sent) {
    const Contribution relayed = first.block(author, block.block);
    EXPECT_EQ(relayed.sums, block.sums);
    EXPECT_EQ(relayed.elapsed_s, block.elapsed_s);
    EXPECT_EQ(relayed.steps, block.steps);
    EXPECT_EQ(relayed.header.tick, block.header.tick);
    second.merge(relayed, kManyTicks);
  }
  second.set_now(70);
  EXPECT_EQ(average_of(first), average_of(second));
  EXPECT_NEAR(first.covered_s(), sent[0].elapsed_s / 256, 1e-15);
}

/// A receiver that is behind weighs a row from after a halving as it will be.
TEST(HalfLife, WeighsARowFromAheadAsOfNow) {
  CoverageTable behind = row_of(kAuthors[0], 0, kHalfLife - 1), ahead = behind;
  const std::vector<Contribution> theirs = blocks_of(kAuthors[2], 0, kHalfLife + 2);
  merge_all(theirs, behind);
  ahead.set_now(kHalfLife + 2);
  merge_all(theirs, ahead);
  EXPECT_EQ(average_of(behind), average_of(ahead));
  EXPECT_EQ(behind.covered_s(), 2 * ahead.covered_s());
}

/// An agent that has counted too many ticks does not halve twice, and names the halving when it
/// sends.
TEST(HalfLife, IsNotRepeatedWhereTicksAreCountedAgain) {
  CoverageTable own = row_of(kAuthors[0], 0, kHalfLife + 1);
  const double covered_s = own.covered_s();
  own.set_now(kHalfLife - 3);
  EXPECT_EQ(own.covered_s(), covered_s);
  EXPECT_EQ(own.block(kAuthors[0], 0).header.tick, kHalfLife);
  own.set_now(kHalfLife + 1);
  EXPECT_EQ(own.covered_s(), covered_s);
  own.set_now(2 * kHalfLife);
  EXPECT_EQ(own.covered_s(), covered_s / 2);
}

TEST(HalfLife, FadesARowThatIsSampledAfterItHasArrived) {
  CoverageTable table = forgetful_table();
  merge_all(blocks_of(kAuthors[0], 0, 20), table);
  table.set_now(30);
  table.add_sample(kAuthors[0], BasisAt(place(kAuthors[0], 30), kDomain, basis()));
  CoverageTable own = row_of(kAuthors[0], 0, 20);
  own.set_now(30);
  own.add_sample(kAuthors[0], BasisAt(place(kAuthors[0], 30), kDomain, basis()));
  EXPECT_EQ(average_of(table), average_of(own));
  EXPECT_EQ(table.covered_s(), own.covered_s());
}

// ---- gains ----

TEST(HalfLife, HalvesTheBlockBeforeOfAGain) {
  const Author author = kAuthors[2];
  for (const auto& [before, then, now] :
       {std::tuple<Tick, Tick, Tick>{3, 5, 5}, {5, 9, 9}, {5, 9, 16}, {5, 30, 30}, {5, 30, 70}}) {
    CoverageTable table = forgetful_table();
    merge_all(blocks_of(author, 0, before), table);
    merge_all(blocks_of(author, 0, then), table);
    table.set_now(now);
    const CoverageTable::Gains gains = table.gains(0, 0);
    ASSERT_EQ(gains.steps, then - before);
    double time_s = 0, of_mode_5 = 0;
    for (Tick tick = before + 1; tick <= then; ++tick) {
      const double left = std::pow(0.5, static_cast<double>(now / kHalfLife - tick / kHalfLife));
      time_s += left * kTick_s;
      of_mode_5 += left * kTick_s * basis_values(place(author, tick), kDomain, basis())[5];
    }
    EXPECT_NEAR(gains.time_steps * kTick_s, time_s, 1e-12 * time_s) << then << ' ' << now;
    EXPECT_NEAR(table.view(0, 0).sums[5] - gains.before[5], of_mode_5, 1e-12 * time_s) << then;
  }
}

// ---- what is possible ----

TEST(HalfLife, RefusesTimesThatNoAgentRemembers) {
  const HalfLife half_life(100, kTick_s);
  Contribution block;
  block.steps = 10000;
  block.sums.edit()[0] = block.elapsed_s = 180;
  EXPECT_TRUE(is_possible(block, kTick_s, 1, half_life));
  EXPECT_FALSE(is_possible(block, kTick_s)) << "without forgetting it is steps dt";
  for (const double elapsed_s : {0.0, -1.0, 261.0, 1000.0, std::nan("")}) {
    Contribution lie = block;
    lie.sums.edit()[0] = lie.elapsed_s = elapsed_s;
    EXPECT_FALSE(is_possible(lie, kTick_s, 1, half_life)) << elapsed_s;
  }
  Contribution lie = block;
  lie.steps = 1799;
  EXPECT_FALSE(is_possible(lie, kTick_s, 1, half_life)) << "more than steps dt";
  lie = block;
  lie.sums.edit()[0] = 179;
  EXPECT_FALSE(is_possible(lie, kTick_s, 1, half_life)) << "S_00 is the time covered";
  lie = block;
  lie.sums.edit()[5] = -181;
  EXPECT_FALSE(is_possible(lie, kTick_s, 1, half_life));
}

}  // namespace
}  // namespace ergocast
