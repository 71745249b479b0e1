// SPDX-License-Identifier: BSD-3-Clause
// What an agent says about its coverage: the only message that the method needs.
#pragma once

#include <cstdint>

#include "core/block_sums.h"
#include "core/ids.h"

namespace ergocast {

/// One block of an agent's running sums: the numerator of (4), cumulative since its start.
struct Contribution {
  Header header;
  std::int64_t steps = 0;        ///< samples in the sums; more steps win
  Tick next_broadcast_tick = 0;  ///< when its sender will broadcast again
  double elapsed_s = 0;          ///< time the sums cover, steps · dt
  std::int32_t block = 0;
  std::int32_t mode_count = 0;
  BlockSums sums;  ///< Σ f_k(x) dt, not divided by h_k [s]

  Author author() const { return {header.sender, header.incarnation}; }
};

}  // namespace ergocast
