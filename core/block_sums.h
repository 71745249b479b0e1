// SPDX-License-Identifier: BSD-3-Clause
// The sums of one block, which messages and tables share instead of copying their kilobyte.
#pragma once

#include <cstddef>
#include <span>

namespace ergocast {

/// Sums in one block of a contribution; the last block of a mission is padded with zeros.
inline constexpr int kBlockSize = 128;

/// kBlockSize numbers. A copy shares them with its original until one of the two is edited. All
/// copies belong to one thread, because the holders are counted without atomic operations.
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

  static constexpr std::size_t size() { return kBlockSize; }
  const double* data() const { return held_ != nullptr ? held_->values : kZeros; }
  const double* begin() const { return data(); }
  const double* end() const { return data() + kBlockSize; }
  double operator[](std::size_t k) const { return data()[k]; }
  bool operator==(const BlockSums& other) const;

  /// The greatest |value|; infinite if one is not a number. Found once for all copies.
  double largest() const {
    if (held_ == nullptr) return 0;
    if (held_->largest < 0) held_->largest = largest_of(held_->values);
    return held_->largest;
  }

  /// The values, for this holder alone to change before anything else is asked of it.
  std::span<double, kBlockSize> edit();
  /// The same for one who sets all of them: they are anything yet.
  std::span<double, kBlockSize> set_all();

 private:
  struct Held {
    alignas(32) double values[kBlockSize];
    mutable double largest;  // negative: not known yet
    int holders;
  };
  static Held* make();
  static void release(Held* held);
  static double largest_of(const double* values);
  alignas(32) static const double kZeros[kBlockSize];

  Held* held_ = nullptr;  // null: zeros
};

}  // namespace ergocast
