// SPDX-License-Identifier: BSD-3-Clause
// Targets whose coefficients are drawn.
#pragma once

#include <cstdint>

#include "core/base/noise.h"
#include "core/mission/amendments.h"

namespace ergocast::test {

/// A target of 20 modes with all digits of a double.
inline TargetChange target_of(std::uint64_t seed, bool free_domain = false) {
  TargetChange change;
  for (Coefficients* numbers : {&change.target, &change.cosine}) {
    if (numbers == &change.cosine && !free_domain) break;
    *numbers = Coefficients::Zero(20);
    for (int k = 0; k < 20; k += 2) {
      const auto pair = uniform_pair(seed, Purpose::kStart, numbers == &change.cosine, k);
      numbers->segment(k, 2) = 0.2 * (pair - Eigen::Vector2d(0.5, 0.5));
    }
    (*numbers)[0] = 1;
  }
  return change;
}

}  // namespace ergocast::test
