// SPDX-License-Identifier: BSD-3-Clause
// The coverage table on random histories: many incarnations, lost, late, repeated and relayed
// blocks, groups that merge in any order, authors that are forgotten. Only the received blocks
// decide what is held.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "core/base/noise.h"
#include "core/law/coverage_table.h"

namespace ergocast {
namespace {

constexpr double kStep_s = 0.1;
constexpr std::int64_t kMostSteps = 1000;
constexpr std::uint64_t kHistories = 40;
const Box kTwoSquares{{0, 0, 0}, {2000, 1000, 0}};
const std::vector<Author> kIncarnations{{0, 9}, {0, 7}, {1, 5}, {2, 1}, {2, 0xffffffffffffffff},
                                        {5, 3}};

/// 12 × 12 modes: two blocks.
Basis small_basis() {
  Basis basis;
  basis.modes_x = basis.modes_y = 12;
  return basis;
}
CoverageTable empty_table() { return {small_basis(), kStep_s}; }

/// Numbers of one history.
class Dice {
 public:
  explicit Dice(std::uint64_t history) : history_(history) {}
  std::uint64_t below(std::uint64_t limit) {
    return random_words(history_, Purpose::kFault, 1, ++throws_).first % limit;
  }
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  std::uint64_t history_, throws_ = 0;
};

/// All blocks that the incarnations of this history ever broadcast, in the order of their
/// sequences.
std::vector<Contribution> everything_sent(std::uint64_t history) {
  Dice dice(history);
  std::vector<Contribution> sent;
  for (const Author& author : kIncarnations) {
    CoverageTable own = empty_table();
    std::int64_t sequence = 0;
    const auto ticks = static_cast<Tick>(1 + dice.below(12));
    const Tick born = static_cast<Tick>(dice.below(50));
    for (Tick tick = born; tick < born + ticks; ++tick) {
      const Eigen::Vector3d x_m = uniform_in(kTwoSquares, history, Purpose::kStart,
                                             static_cast<std::uint32_t>(author.agent),
                                             author.incarnation + static_cast<std::uint64_t>(tick));
      own.add_sample(author, BasisAt(x_m, kTwoSquares, small_basis()));
      if (dice.below(3) == 0) continue;
      for (int b = 0; b < 2; ++b) {
        sent.push_back(own.block(author, b));
        sent.back().header.tick = tick;
        sent.back().header.sequence = ++sequence;
        sent.back().next_broadcast_tick = tick + 1 + static_cast<Tick>(dice.below(3));
      }
    }
  }
  return sent;
}

/// A random part of a history as it is received: some blocks twice, in any order.
std::vector<Contribution> part_of(const std::vector<Contribution>& sent, Dice& dice) {
  std::vector<Contribution> heard;
  for (const Contribution& block : sent) {
    for (std::uint64_t times = dice.below(3); times > 0; --times) heard.push_back(block);
  }
  dice.shuffle(heard);
  return heard;
}

CoverageTable table_after(const std::vector<Contribution>& heard) {
  CoverageTable table = empty_table();
  for (const Contribution& block : heard) table.merge(block, kMostSteps);
  return table;
}

/// Everything that `from` holds reaches `to`, as teammates pass it on.
void pass_on(const CoverageTable& from, CoverageTable& to) {
  for (const Author& author : kIncarnations) {
    for (int b = 0; b < from.block_count(); ++b) {
      const Contribution block = from.block(author, b);
      if (block.steps > 0) to.merge(block, kMostSteps);
    }
  }
}

Coefficients mean_of(const CoverageTable& table) {
  Coefficients average = Coefficients::Constant(144, 7);
  table.average(average);
  return average;
}

/// Bit for bit, the headers of what would be passed on included.
void expect_same(const CoverageTable& a, const CoverageTable& b) {
  EXPECT_EQ(a.row_count(), b.row_count());
  for (const Author& author : kIncarnations) {
    for (int block = 0; block < 2; ++block) {
      const Contribution one = a.block(author, block), other = b.block(author, block);
      EXPECT_EQ(one.steps, other.steps);
      EXPECT_EQ(one.sums, other.sums);
      EXPECT_EQ(one.elapsed_s, other.elapsed_s);
      EXPECT_EQ(one.next_broadcast_tick, other.next_broadcast_tick);
      EXPECT_EQ(one.header.sequence, other.header.sequence);
      EXPECT_EQ(one.header.tick, other.header.tick);
    }
  }
  EXPECT_EQ(mean_of(a), mean_of(b));
}

/// Checks the messages of each of many histories.
void in_every_history(
    const std::function<void(const std::vector<Contribution>& sent, Dice& dice)>& check) {
  for (std::uint64_t history = 0; history < kHistories; ++history) {
    SCOPED_TRACE("history " + std::to_string(history));
    Dice dice(1000 + history);
    check(everything_sent(history), dice);
  }
}

TEST(MergeProperty, IsCommutativeAndIdempotent) {
  in_every_history([](const auto& sent, Dice& dice) {
    std::vector<Contribution> heard = part_of(sent, dice);
    const CoverageTable once = table_after(heard);
    const std::vector<Contribution> again = heard;
    heard.insert(heard.end(), again.begin(), again.end());
    dice.shuffle(heard);
    expect_same(table_after(heard), once);
  });
}

TEST(MergeProperty, IsAssociative) {
  in_every_history([](const auto& sent, Dice& dice) {
    const auto a = part_of(sent, dice), b = part_of(sent, dice), c = part_of(sent, dice);
    CoverageTable ab = table_after(a), bc = table_after(b), left = table_after(c);
    pass_on(table_after(b), ab);
    pass_on(ab, left);
    pass_on(table_after(c), bc);
    CoverageTable right = table_after(a);
    pass_on(bc, right);
    expect_same(left, right);
  });
}

TEST(MergeProperty, KeepsOfEachBlockTheOneWithMostSteps) {
  in_every_history([](const auto& sent, Dice& dice) {
    const auto heard = part_of(sent, dice);
    const CoverageTable table = table_after(heard);
    std::map<std::pair<Author, int>, std::int64_t> most;
    for (const Contribution& block : heard) {
      auto& steps = most[{block.author(), block.block}];
      steps = std::max(steps, block.steps);
    }
    for (const Author& author : kIncarnations) {
      for (int b = 0; b < 2; ++b) EXPECT_EQ(table.block(author, b).steps, (most[{author, b}]));
    }
  });
}

TEST(MergeProperty, AddsUpInTheOrderOfAuthorsWhateverTheOrderOfArrival) {
  in_every_history([](const auto& sent, Dice& dice) {
    const CoverageTable table = table_after(part_of(sent, dice));
    std::set<Author> in_order(kIncarnations.begin(), kIncarnations.end());
    const Coefficients average = mean_of(table);
    for (int k = 0; k < 144; ++k) {
      double sum = 0;
      std::int64_t steps = 0;
      for (const Author& author : in_order) {
        const Contribution block = table.block(author, k / kBlockSize);
        sum += block.sums[static_cast<std::size_t>(k % kBlockSize)];
        steps += block.steps;
      }
      const double expected = steps > 0 ? sum * (1 / (static_cast<double>(steps) * kStep_s)) : 0;
      EXPECT_EQ(average.data()[k], expected) << k;
    }
  });
}

TEST(MergeProperty, WhatIsPassedOnIsWhatWasSent) {
  in_every_history([](const auto& sent, Dice& dice) {
    CoverageTable relay = table_after(part_of(sent, dice)), far = empty_table();
    pass_on(relay, far);
    expect_same(far, relay);
    std::map<std::pair<Author, std::int64_t>, const Contribution*> originals;
    for (const Contribution& block : sent)
      originals[{block.author(), block.header.sequence}] = &block;
    for (const Author& author : kIncarnations) {
      for (int b = 0; b < 2; ++b) {
        const Contribution passed = far.block(author, b);
        if (passed.steps == 0) continue;
        const Contribution& original = *originals.at({author, passed.header.sequence});
        EXPECT_EQ(passed.block, original.block);
        EXPECT_EQ(passed.steps, original.steps);
        EXPECT_EQ(passed.sums, original.sums);
        EXPECT_EQ(passed.header.tick, original.header.tick);
        EXPECT_EQ(passed.next_broadcast_tick, original.next_broadcast_tick);
      }
    }
  });
}

TEST(MergeProperty, ForgettingIsLeavingOutAndKeeping) {
  in_every_history([](const auto& sent, Dice& dice) {
    const auto heard = part_of(sent, dice);
    std::set<Author> forgotten;
    for (const Author& author : kIncarnations) {
      if (dice.below(2) == 0) forgotten.insert(author);
    }
    std::vector<Contribution> of_the_rest;
    for (const Contribution& block : heard) {
      if (!forgotten.contains(block.author())) of_the_rest.push_back(block);
    }
    CoverageTable table = table_after(heard);
    const CoverageTable all = table, rest = table_after(of_the_rest);
    for (const Author& author : forgotten) table.forget(author);
    EXPECT_EQ(mean_of(table), mean_of(rest)) << "bit for bit";
    EXPECT_EQ(table.covered_s(), rest.covered_s());
    CoverageTable far = empty_table();
    pass_on(table, far);
    expect_same(far, all);  // others may not know yet that it is to be forgotten
    table.remember_all();
    EXPECT_EQ(mean_of(table), mean_of(all)) << "as if nothing had been";
  });
}

TEST(MergeProperty, ForgettingDoesNotDependOnWhatHasArrived) {
  in_every_history([](const auto& sent, Dice& dice) {
    const auto heard = part_of(sent, dice);
    const Author gone = kIncarnations[dice.below(kIncarnations.size())];
    CoverageTable first = empty_table();
    first.forget(gone);
    for (const Contribution& block : heard) first.merge(block, kMostSteps);
    CoverageTable last = table_after(heard);
    last.forget(gone);
    EXPECT_EQ(mean_of(first), mean_of(last));
  });
}

}  // namespace
}  // namespace ergocast
