// SPDX-License-Identifier: BSD-3-Clause
// Sums that copies share: what one holder changes, the others do not see.
#include "core/base/block_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace ergocast {
namespace {

BlockSums filled(double value, std::size_t size = kBlockSize) {
  BlockSums sums;
  std::ranges::fill(sums.set_all(size), value);
  return sums;
}

TEST(BlockSums, AreZerosAtFirst) {
  const BlockSums sums;
  EXPECT_EQ(sums.size(), std::size_t{kBlockSize});
  for (std::size_t k = 0; k < kMostBlockSize; ++k) ASSERT_EQ(sums.data()[k], 0);
  EXPECT_EQ(sums.largest(), 0);
  EXPECT_EQ(sums, filled(0));
}

TEST(BlockSums, ACopySharesThemUntilOneOfTheTwoIsChanged) {
  BlockSums original = filled(1);
  BlockSums copy = original;
  EXPECT_EQ(copy.data(), original.data());
  copy.edit()[3] = 7;
  EXPECT_EQ(original, filled(1));
  EXPECT_EQ(copy[3], 7);
  EXPECT_EQ(copy[4], 1) << "the rest is as it was";
  BlockSums third = original;
  std::ranges::fill(original.set_all(), 2);
  EXPECT_EQ(third, filled(1));
  EXPECT_EQ(original, filled(2));
}

TEST(BlockSums, AChangeByTheOnlyHolderCopiesNothing) {
  BlockSums sums = filled(1);
  const double* const before = sums.data();
  { const BlockSums gone = sums; }
  sums.edit()[0] = 2;
  EXPECT_EQ(sums.data(), before);
  const BlockSums moved = std::move(sums);
  EXPECT_EQ(moved.data(), before);
}

TEST(BlockSums, KnowTheirLargestAlsoAfterAChange) {
  BlockSums sums = filled(1);
  sums.edit()[100] = -3;
  EXPECT_EQ(sums.largest(), 3);
  const BlockSums copy = sums;
  sums.edit()[127] = 4;
  EXPECT_EQ(sums.largest(), 4);
  EXPECT_EQ(copy.largest(), 3);
  sums.edit()[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sums.largest(), std::numeric_limits<double>::infinity());
}

TEST(BlockSums, OfAnotherSizeAreOthers) {
  BlockSums sums = filled(1, kMostBlockSize);
  EXPECT_EQ(sums.size(), std::size_t{kMostBlockSize});
  EXPECT_NE(sums, filled(1));
  sums.edit()[255] = -9;
  EXPECT_EQ(sums.largest(), 9);
  std::ranges::fill(sums.set_all(kBlockSize), 1);
  EXPECT_EQ(sums, filled(1));
}

TEST(BlockSums, OfManyHoldersAreReleasedAndUsedAgainWithoutAMixUp) {
  std::vector<BlockSums> held;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 200; ++i) held.push_back(filled(i));
    for (int i = 0; i < 200; ++i) ASSERT_EQ(held[static_cast<std::size_t>(i)], filled(i));
    held.clear();
  }
}

}  // namespace
}  // namespace ergocast
