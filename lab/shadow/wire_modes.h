// SPDX-License-Identifier: BSD-3-Clause
// Which mode each number of a contribution belongs to. Shares no code with core/law/block_layout.h,
// so that no mistake there is one here, too.
#pragma once

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <vector>

#include "core/mission/mission.h"

namespace ergocast::lab {

/// The modes of each block, in the order of its numbers; by (l · modes_x + m) · modes_y + n.
using WireModes = std::vector<std::vector<int>>;

inline WireModes modes_on_wire(const Mission& mission) {
  const Basis& basis = mission.basis;
  std::vector<std::tuple<int, int>> order;  // |k|² or 0, the mode
  const bool sorted = mission.timing.high_mode_period_factor > 1 && basis.mode_count() > 64;
  for (int l = 0; l < basis.modes_z; ++l) {
    for (int m = 0; m < basis.modes_x; ++m) {
      for (int n = 0; n < basis.modes_y; ++n) {
        // The modes of a free domain already ascend.
        const int squared = sorted && !basis.free_domain ? l * l + m * m + n * n : 0;
        order.emplace_back(squared, static_cast<int>(order.size()));
      }
    }
  }
  std::sort(order.begin(), order.end());
  const int full = block_size_of(mission.timing.contribution_encoding);
  WireModes blocks;
  for (const auto& [squared, mode] : order) {
    const int room = sorted && blocks.size() == 1 ? 64 : full;
    if (blocks.empty() || static_cast<int>(blocks.back().size()) == room) blocks.emplace_back();
    blocks.back().push_back(mode);
  }
  return blocks;
}

}  // namespace ergocast::lab
