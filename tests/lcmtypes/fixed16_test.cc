// SPDX-License-Identifier: BSD-3-Clause
// Coverage that is sent in 16 bits. It is close to the exact one, errors do not add up, it merges
// in any order, and the two encodings never mix.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/noise.h"
#include "core/law/coverage_table.h"
#include "lcmtypes/codec.h"
#include "tests/lcmtypes/sample_messages.h"

namespace ergocast {
namespace {

using namespace test;

constexpr double kTick_s = 0.1;
constexpr std::int64_t kManySteps = 100000;
const Box kDomain{{0, 0, 0}, {2000, 1000, 0}};

/// 18 × 18 modes: two blocks of 256, or three of 128.
Basis modes() {
  Basis basis;
  basis.modes_x = basis.modes_y = 18;
  return basis;
}

CoverageTable table_in(ContributionEncoding encoding) {
  CoverageTable table(modes(), kTick_s);
  table.set_layout(BlockLayout(modes(), encoding));
  return table;
}
CoverageTable rounded_table() { return table_in(ContributionEncoding::kFixed16); }

Eigen::Vector3d place(AgentId agent, Tick tick) {
  return uniform_in(kDomain, 7, Purpose::kStart, static_cast<std::uint32_t>(agent),
                    static_cast<std::uint64_t>(tick));
}

/// Agent `id`, which samples every tick and broadcasts every `period` ticks, as in a mission.
class Author16 {
 public:
  explicit Author16(AgentId id) : author_{id, 5}, table_(rounded_table()) {}

  /// All blocks that it sends in so many ticks, as receivers decode them.
  std::vector<Contribution> run_ticks(Tick ticks, Tick period) {
    std::vector<Contribution> sent;
    std::vector<Contribution> before(static_cast<std::size_t>(table_.block_count()));
    for (Tick tick = 0; tick < ticks; ++tick) {
      table_.add_sample(author_, BasisAt(place(author_.agent, tick), kDomain, modes()));
      if (tick % period != 0) continue;
      for (int b = 0; b < table_.block_count(); ++b) {
        Contribution block = table_.block(author_, b);
        Contribution& last = before[static_cast<std::size_t>(b)];
        block.header.run = kRun;
        block.header.tick = tick;
        block.next_broadcast_tick = tick + period;
        block.gained_steps = block.steps - last.steps;
        const std::span<double> gains = block.gains.set_all(block.sums.size());
        for (std::size_t k = 0; k < gains.size(); ++k)
          gains[k] = block.sums[k] - last.sums.data()[k];
        sent.push_back(arrived(block));
        last = block;
      }
    }
    return sent;
  }
  static Contribution arrived(const Contribution& block) {
    return decoded_as<Contribution>(encoded(block));
  }
  const CoverageTable& table() const { return table_; }

 private:
  Author author_;
  CoverageTable table_;
};

TEST(Fixed16, IsWithinHalfAUnitOfTheExactAverageHoweverLongTheMission) {
  for (const Tick ticks : {1, 10, 1000, 4999}) {
    Author16 author(1);
    CoverageTable heard = rounded_table();
    const Tick period = ticks > 1000 ? 7 : 1;  // its last broadcast is at its last tick
    for (const Contribution& block : author.run_ticks(ticks, period)) {
      ASSERT_EQ(heard.merge(block, kManySteps), Merge::kNewer);
    }
    double furthest = 0;
    for (int b = 0; b < heard.block_count(); ++b) {
      const Contribution ours = heard.block({1, 5}, b), theirs = author.table().block({1, 5}, b);
      ASSERT_EQ(ours.steps, theirs.steps);
      for (std::size_t k = 0; k < kMostBlockSize; ++k) {
        furthest = std::max(furthest, std::abs(ours.sums[k] - theirs.sums[k]) / theirs.elapsed_s);
      }
    }
    EXPECT_LE(furthest, (1 + 1e-9) / 65534) << ticks;
    EXPECT_GT(furthest, 0) << "it is rounded, " << ticks;
  }
}

TEST(Fixed16, PassedOnItIsTheSameBytes) {
  Author16 author(2);
  for (const Contribution& block : author.run_ticks(50, 3)) {
    CoverageTable one = rounded_table();
    ASSERT_EQ(one.merge(block, kManySteps), Merge::kNewer);
    Contribution relayed = one.block(block.author(), block.block);
    relayed.header.run = kRun;
    EXPECT_EQ(encoded(relayed), encoded(block));
  }
}

/// Both are equal bit for bit.
void expect_same(const CoverageTable& a, const CoverageTable& b) {
  Coefficients ours = Coefficients::Zero(324), theirs = Coefficients::Zero(324);
  a.average(ours);
  b.average(theirs);
  EXPECT_EQ(ours, theirs);
  ASSERT_EQ(a.row_count(), b.row_count());
  for (std::size_t row = 0; row < a.row_count(); ++row) {
    EXPECT_EQ(a.summary_of(row).state_hash, b.summary_of(row).state_hash);
    for (int block = 0; block < a.block_count(); ++block) {
      const Contribution one = a.block(a.author(row), block), other = b.block(a.author(row), block);
      EXPECT_EQ(one.sums, other.sums);
      EXPECT_EQ(one.gains, other.gains);
      EXPECT_EQ(one.gained_steps, other.gained_steps);
    }
  }
}

TEST(Fixed16, MergesInAnyOrderAndAnyNumberOfTimes) {
  std::vector<Contribution> sent;
  for (AgentId id = 0; id < 3; ++id) {
    const auto more = Author16(id).run_ticks(20, 2);
    sent.insert(sent.end(), more.begin(), more.end());
  }
  CoverageTable in_order = rounded_table();
  for (const Contribution& block : sent) in_order.merge(block, kManySteps);
  for (std::uint64_t shuffle = 0; shuffle < 20; ++shuffle) {
    std::vector<Contribution> heard = sent;
    heard.insert(heard.end(), sent.begin(), sent.end());
    for (std::size_t i = heard.size(); i > 1; --i) {
      std::swap(heard[i - 1], heard[random_words(shuffle, Purpose::kFault, 1, i).first % i]);
    }
    CoverageTable table = rounded_table();
    for (const Contribution& block : heard) table.merge(block, kManySteps);
    expect_same(table, in_order);
  }
}

TEST(Fixed16, NeverMixesWithDoubles) {
  const std::vector<Contribution> rounded = Author16(1).run_ticks(1, 1);
  CoverageTable doubles = table_in(ContributionEncoding::kDouble), rounds = rounded_table();
  EXPECT_EQ(doubles.merge(rounded.front(), kManySteps), Merge::kRefusedEncoding);
  EXPECT_EQ(doubles.row_count(), 0u);
  CoverageTable exact = table_in(ContributionEncoding::kDouble);
  exact.add_sample({1, 5}, BasisAt(place(1, 0), kDomain, modes()));
  EXPECT_EQ(rounds.merge(exact.block({1, 5}, 0), kManySteps), Merge::kRefusedEncoding);
  EXPECT_EQ(rounds.row_count(), 0u);
}

TEST(Fixed16, RefusesAverageBeyondOneAndGainsOfMoreStepsThanThereAre) {
  const Contribution honest = Author16(1).run_ticks(1, 1).front();
  Bytes bytes = encoded(honest);
  constexpr std::size_t kFirstAverage = 101;
  bytes[kFirstAverage + 2] = std::byte{0x80};  // −32768
  bytes[kFirstAverage + 3] = std::byte{0};
  EXPECT_EQ(verdict(retagged(bytes)), "range");
  Contribution lie = honest;
  lie.gained_steps = lie.steps + 1;
  EXPECT_EQ(rounded_table().merge(lie, kManySteps), Merge::kRefusedRange);
  lie = honest;
  lie.sums.edit()[0] *= 32766.0 / 32767;
  EXPECT_EQ(rounded_table().merge(lie, kManySteps), Merge::kRefusedRange) << "S_00 is the time";
}

}  // namespace
}  // namespace ergocast
