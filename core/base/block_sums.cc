// SPDX-License-Identifier: BSD-3-Clause
// Counts the holders of a block's sums, and keeps the memory of released blocks for the next ones.
#include "core/base/block_sums.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <new>
#include <utility>

#include "core/base/vectorized.h"

namespace ergocast {

const double BlockSums::kZeros[kMostBlockSize] = {};

namespace {

/// Released memory of blocks of one size, kept for the next blocks. malloc takes long for a
/// kilobyte, and with it a step that takes in messages allocates nothing. The memory is freed with
/// its thread.
struct Spares {
  ~Spares() {
    while (count > 0) ::operator delete(pieces[--count]);
    room = 0;
  }
  std::size_t count = 0, room = 64;
  void* pieces[64] = {};
};
constinit thread_local Spares spares_of_doubles, spares_of_averages, spares_of_low_modes;

Spares* spares_of(std::size_t size) {
  if (size == kBlockSize) return &spares_of_doubles;
  if (size == kLowModes) return &spares_of_low_modes;
  return size == kMostBlockSize ? &spares_of_averages : nullptr;
}

}  // namespace

BlockSums::Held* BlockSums::make(std::size_t size) {
  Spares* const spares = spares_of(size);
  void* const room = spares != nullptr && spares->count > 0
                         ? spares->pieces[--spares->count]
                         : ::operator new(sizeof(Held) + size * sizeof(double));
  return ::new (room) Held{.largest = -1, .holders = 1, .size = static_cast<std::uint32_t>(size)};
}

void BlockSums::release(Held* held) {
  Spares* const spares = spares_of(held->size);
  if (spares != nullptr && spares->count < spares->room) {
    spares->pieces[spares->count++] = held;
  } else {
    ::operator delete(held);
  }
}

bool BlockSums::operator==(const BlockSums& other) const {
  return held_ == other.held_ || std::equal(begin(), end(), other.begin(), other.end());
}

ERGOCAST_VECTORIZED
double BlockSums::largest_of(std::span<const double> values) {
  // Lanes, because the order of comparisons does not matter. A NaN is never the greater number.
  double lanes[kModesPerStride] = {};
  std::size_t numbers = 0;
  for (std::size_t k = 0; k < values.size(); k += kModesPerStride) {
    for (std::size_t lane = 0; lane < kModesPerStride; ++lane) {
      const double value = std::abs(values[k + lane]);
      lanes[lane] = value > lanes[lane] ? value : lanes[lane];
      numbers += value == value;
    }
  }
  if (numbers != values.size()) return std::numeric_limits<double>::infinity();
  return *std::max_element(std::begin(lanes), std::end(lanes));
}

std::span<double> BlockSums::edit() {
  if (held_ == nullptr || held_->holders > 1) {
    BlockSums own;
    std::copy(begin(), end(), own.set_all(size()).begin());
    *this = std::move(own);
  }
  held_->largest = -1;
  return {held_->values(), held_->size};
}

std::span<double> BlockSums::set_all(std::size_t size) {
  if (held_ == nullptr || held_->holders > 1 || held_->size != size) {
    *this = BlockSums();
    held_ = make(size);
  }
  held_->largest = -1;
  return {held_->values(), held_->size};
}

}  // namespace ergocast
