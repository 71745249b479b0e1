// SPDX-License-Identifier: BSD-3-Clause
// The common part of the targets of all map formats: read every row, and check the guarantees of
// target/maps/map_file.h.
#pragma once

#include <vector>

#include "target/maps/map_file.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

/// Reads at most a million cells: later rows are read by the same code.
inline void read_map(Input input, OpenedMap (*open)(const std::filesystem::path&)) {
  const OpenedMap opened = open(memory_file(input));
  if (!opened) {
    ERGOCAST_REQUIRE(!opened.error().what.empty() && !opened.error().remedy.empty());
    return;
  }
  MapFile& map = **opened;
  ERGOCAST_REQUIRE(map.columns() >= 1 && map.columns() <= kMaxMapSide);
  ERGOCAST_REQUIRE(map.rows() >= 1 && map.rows() <= kMaxMapSide);
  std::vector<double> row(static_cast<std::size_t>(map.columns()));
  const int rows = std::min(map.rows(), 1 + (1 << 20) / map.columns());
  for (int i = 0; i < rows; ++i) {
    const auto problem = map.next_row(row);
    if (problem && !problem->ends_row) return;
    if (problem) continue;
    for (const double value : row) ERGOCAST_REQUIRE(value >= 0 && value <= kMaxMapValue);
  }
}

}  // namespace ergocast::fuzz
