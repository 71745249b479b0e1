// SPDX-License-Identifier: BSD-3-Clause
// What an agent sends about its coverage: the only message that the method needs.
#pragma once

#include <cstdint>

#include "core/base/block_sums.h"
#include "core/base/ids.h"

namespace ergocast {

/// How the numbers of contributions travel, the same for all of a run.
enum class ContributionEncoding {
  kDouble,   ///< sums, kBlockSize in a block
  kFixed16,  ///< averages and rates in 16 bits, kMostBlockSize in a block
};

inline constexpr int block_size_of(ContributionEncoding encoding) {
  return encoding == ContributionEncoding::kFixed16 ? kMostBlockSize : kBlockSize;
}
/// The number of blocks that `mode_count` modes need.
inline constexpr int block_count_of(int mode_count, ContributionEncoding encoding) {
  return (mode_count + block_size_of(encoding) - 1) / block_size_of(encoding);
}
/// How far an average that has travelled may be from the exact one.
inline constexpr double rounding_of(ContributionEncoding encoding) {
  return encoding == ContributionEncoding::kFixed16 ? 1.0 / 65534 : 0;
}

/// Averages of samples are within ±1. Once a target has changed (core/law/target_shift.h), samples
/// are shifted by μ − μ₀, and averages are within ±kShiftedRange.
inline constexpr std::int32_t kShiftedRange = 3;

/// One block of an agent's running sums: the numerator of (4), cumulative since its start.
struct Contribution {
  Header header;
  std::int64_t steps = 0;        ///< samples in the sums; more steps win
  Tick next_broadcast_tick = 0;  ///< when its sender will broadcast again
  double elapsed_s = 0;          ///< time the sums cover: steps · dt, or what is remembered of it
  std::int32_t block = 0;
  std::int32_t mode_count = 0;
  BlockSums sums;  ///< Σ f_k(x) dt, not divided by h_k [s]; BlockLayout::size_of() numbers
  ContributionEncoding encoding = ContributionEncoding::kDouble;
  std::int32_t range = 1;  ///< kFixed16: averages travel as parts of it, 1 or kShiftedRange
  /// kFixed16: what the sums have gained in the last `gained_steps` steps [s]. Receivers cannot
  /// compute it from two rounded averages.
  BlockSums gains;
  std::int64_t gained_steps = 0;

  Author author() const { return {header.sender, header.incarnation}; }
};

}  // namespace ergocast
