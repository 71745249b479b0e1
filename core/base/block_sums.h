// SPDX-License-Identifier: BSD-3-Clause
// The sums of one block, which messages and tables share instead of copying their kilobyte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ergocast {

/// Sums in one block of a contribution in doubles; the last block of a mission is padded with
/// zeros.
/// Limit (Messages): modes in a block of a contribution. Beyond it: the contribution takes several
/// messages.
inline constexpr int kBlockSize = 128;
/// Sums in the longest block.
/// Limit (Messages): modes in a block with `contribution_encoding: FIXED16`. Beyond it: the
/// contribution takes several messages.
inline constexpr int kMostBlockSize = 256;
/// Sums in the first block where the other modes are sent less often; core/law/block_layout.h.
/// Limit (Messages): modes in a first block with `high_mode_period_factor`. Beyond it: the others
/// are sent more rarely.
inline constexpr int kLowModes = 64;

/// The numbers of a block, by default kBlockSize. A copy shares them with its original until one of
/// the two is edited. All copies belong to one thread, because the holders are counted without
/// atomic operations.
class BlockSums {
 public:
  BlockSums() = default;  ///< zeros
  BlockSums(const BlockSums& other) : held_(other.held_) {
    if (held_ != nullptr) ++held_->holders;
  }
  BlockSums(BlockSums&& other) noexcept : held_(other.held_) { other.held_ = nullptr; }
  BlockSums& operator=(BlockSums other) noexcept {
    Held* const mine = held_;
    held_ = other.held_;
    other.held_ = mine;
    return *this;
  }
  ~BlockSums() {
    if (held_ != nullptr && --held_->holders == 0) release(held_);
  }

  std::size_t size() const { return held_ != nullptr ? held_->size : kBlockSize; }
  /// kMostBlockSize zeros until values are set.
  const double* data() const { return held_ != nullptr ? held_->values() : kZeros; }
  const double* begin() const { return data(); }
  const double* end() const { return data() + size(); }
  double operator[](std::size_t k) const { return data()[k]; }
  bool operator==(const BlockSums& other) const;

  /// The greatest |value|; infinite if one is not a number. Found once for all copies.
  double largest() const {
    if (held_ == nullptr) return 0;
    if (held_->largest < 0) held_->largest = largest_of({begin(), end()});
    return held_->largest;
  }

  /// The values, for this holder alone. Change them before the next call of another method.
  std::span<double> edit();
  /// The same for a caller that sets all values, `size` ≤ kMostBlockSize: they are not initialised.
  std::span<double> set_all(std::size_t size = kBlockSize);

 private:
  /// Stands before its `size` numbers, in one piece of memory.
  struct Held {
    double largest;  // negative: not known yet
    int holders;
    std::uint32_t size;
    double* values() { return reinterpret_cast<double*>(this + 1); }
  };
  static Held* make(std::size_t size);
  static void release(Held* held);
  static double largest_of(std::span<const double> values);
  static const double kZeros[kMostBlockSize];

  Held* held_ = nullptr;  // null: zeros
};

}  // namespace ergocast
