// SPDX-License-Identifier: BSD-3-Clause
// The cells in which a team notes where it has searched.
//
// Rows of them have to fit into few messages, so they are larger than the cells of core/measure: at
// most 64 along the longer side of the domain. A sensor that sees less than three quarters of a
// cell is replaced by one that sees so much, with a lower rate: its rate times its area is the
// same.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/ids.h"
#include "core/measure/cells.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Cells of a tile along each axis. A tile travels as one.
inline constexpr int kTileSide = 8;
inline constexpr std::size_t kTileCells = std::size_t{kTileSide} * kTileSide;
/// Limit (Team): cells of a search along the longer side of the domain. Beyond it: a sensor with a
/// small radius is replaced by one that sees three quarters of a cell at a lower rate.
inline constexpr int kMaxSearchCellsPerSide = 64;
inline constexpr std::size_t kMaxTiles =
    std::size_t{kMaxSearchCellsPerSide / kTileSide} * (kMaxSearchCellsPerSide / kTileSide);

inline constexpr int kMaxSearchCells = kMaxSearchCellsPerSide * kMaxSearchCellsPerSide;
/// Limit (Team): reports of one agent in a cell, with false alarms. Beyond it: more of them do not
/// count.
inline constexpr std::uint32_t kMaxReports = 15;
/// The number of no cell.
inline constexpr std::int32_t kNoCell = -1;

/// A cell as rows have it: they are in tiles.
struct TileCell {
  std::size_t tile, slot;
};

struct SearchCells {
  /// @pre a plane
  explicit SearchCells(const Mission& mission);

  Cells cells;
  int tile_rows, tile_columns;
  double radius_m;           ///< of the sensor
  Tick ticks_per_look;       ///< sensors look once in so many ticks, for all of them
  double nats_per_look;      ///< −ln of the share of objects that one look misses
  std::uint16_t most_looks;  ///< of one agent that count in a cell: about 8 nats, at least 1; with
                             ///< false alarms 16
  int look_bits;  ///< of a count, the lowest; with false alarms the four others are reports

  /// Whether sensors report anything: they have false alarms.
  bool reports() const { return look_bits < 16; }
  std::uint32_t looks_in(std::uint16_t count) const {
    return count & ((std::uint32_t{1} << look_bits) - 1);
  }
  std::uint32_t reports_in(std::uint16_t count) const { return std::uint32_t{count} >> look_bits; }
  std::uint16_t count_of(std::uint32_t looks, std::uint32_t reports) const {
    return static_cast<std::uint16_t>(reports << look_bits | looks);
  }
  std::size_t tile_count() const {
    return static_cast<std::size_t>(tile_rows) * static_cast<std::size_t>(tile_columns);
  }
  /// The middle of a cell, by its number in `cells`.
  Eigen::Vector2d middle_m(std::int32_t cell) const {
    return {cells.center_m(0, cell / cells.count.y()), cells.center_m(1, cell % cells.count.y())};
  }
  /// A cell by its number in `cells`.
  TileCell tile_cell(std::int32_t cell) const {
    return tile_cell(cell / cells.count.y(), cell % cells.count.y());
  }
  /// The cell in column `i`, along x, and row `j`, along y.
  TileCell tile_cell(int i, int j) const {
    return {static_cast<std::size_t>(i / kTileSide * tile_rows + j / kTileSide),
            static_cast<std::size_t>(i % kTileSide * kTileSide + j % kTileSide)};
  }
  /// Whether sensors look at a tick that counts.
  bool looks_at(Tick counted) const { return counted % ticks_per_look == ticks_per_look / 2; }
  /// How often an agent can have looked by a tick that counts, that one included.
  std::int64_t looks_by(Tick counted) const {
    return counted < 0 ? 0 : (counted + ticks_per_look - ticks_per_look / 2) / ticks_per_look;
  }
};

}  // namespace ergocast
