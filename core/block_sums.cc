// SPDX-License-Identifier: BSD-3-Clause
// Counts who holds a block's sums.
#include "core/block_sums.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "core/vectorized.h"

namespace ergocast {

alignas(32) const double BlockSums::kZeros[kBlockSize] = {};

BlockSums::Held* BlockSums::make() {
  Held* const held = new Held;
  held->holders = 1;
  return held;
}

void BlockSums::release(Held* held) { delete held; }

bool BlockSums::operator==(const BlockSums& other) const {
  return held_ == other.held_ || std::equal(begin(), end(), other.begin());
}

ERGOCAST_VECTORIZED
double BlockSums::largest_of(const double* values) {
  // Lanes, because the order of comparisons does not matter; not a number is never the greater one.
  double lanes[kModesPerStride] = {};
  std::int64_t numbers = 0;
  for (std::size_t k = 0; k < kBlockSize; k += kModesPerStride) {
    for (std::size_t lane = 0; lane < kModesPerStride; ++lane) {
      const double value = std::abs(values[k + lane]);
      lanes[lane] = value > lanes[lane] ? value : lanes[lane];
      numbers += value == value;
    }
  }
  if (numbers != kBlockSize) return std::numeric_limits<double>::infinity();
  return *std::max_element(std::begin(lanes), std::end(lanes));
}

std::span<double, kBlockSize> BlockSums::edit() {
  if (held_ == nullptr || held_->holders > 1) {
    BlockSums own;
    std::copy(begin(), end(), own.set_all().begin());
    *this = std::move(own);
  }
  held_->largest = -1;
  return std::span<double, kBlockSize>(held_->values);
}

std::span<double, kBlockSize> BlockSums::set_all() {
  if (held_ == nullptr || held_->holders > 1) {
    if (held_ != nullptr) --held_->holders;
    held_ = make();
  }
  held_->largest = -1;
  return std::span<double, kBlockSize>(held_->values);
}

}  // namespace ergocast
