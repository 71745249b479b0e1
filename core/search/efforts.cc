// SPDX-License-Identifier: BSD-3-Clause
// Keeps the sums over all rows up to date: they change by single looks and tiles.
#include "core/search/efforts.h"

#include <algorithm>

#include "core/base/require.h"

namespace ergocast {

Efforts::Efforts(const Mission& mission)
    : cells_(mission), half_life_(mission), sums_(cells_.tile_count()) {}

Efforts::Row& Efforts::row(const Author& author) {
  const auto at = std::ranges::lower_bound(rows_, author, {}, &Row::author);
  if (at != rows_.end() && at->author == author) return *at;
  return *rows_.insert(at, {author, std::vector<EffortTile>(cells_.tile_count())});
}

const std::vector<EffortTile>* Efforts::row_of(const Author& author) const {
  const auto at = std::ranges::lower_bound(rows_, author, {}, &Row::author);
  return at != rows_.end() && at->author == author ? &at->tiles : nullptr;
}

void Efforts::add_row(const Author& author) { row(author); }

void Efforts::halve(EffortTile& tile, std::int64_t times) const {
  const int shift = static_cast<int>(std::clamp<std::int64_t>(times, 0, 16));
  for (std::uint16_t& count : tile.looks)
    count = cells_.count_of(cells_.looks_in(count) >> shift, cells_.reports_in(count) >> shift);
}

void Efforts::set_now(Tick counted) {
  const std::int64_t halvings = half_life_.halvings(counted);
  if (halvings <= halvings_) return;
  std::ranges::fill(sums_, std::array<Sum, kTileCells>{});
  for (Row& row : rows_) {
    for (std::size_t tile = 0; tile < row.tiles.size(); ++tile) {
      halve(row.tiles[tile], halvings - halvings_);
      add(tile, row.tiles[tile]);
    }
  }
  halvings_ = halvings;
}

void Efforts::add(std::size_t tile, const EffortTile& counts) {
  for (std::size_t slot = 0; slot < kTileCells; ++slot) {
    sums_[tile][slot].looks += cells_.looks_in(counts.looks[slot]);
    sums_[tile][slot].reports += cells_.reports_in(counts.looks[slot]);
  }
}

void Efforts::subtract(std::size_t tile, const EffortTile& counts) {
  for (std::size_t slot = 0; slot < kTileCells; ++slot) {
    sums_[tile][slot].looks -= cells_.looks_in(counts.looks[slot]);
    sums_[tile][slot].reports -= cells_.reports_in(counts.looks[slot]);
  }
}

void Efforts::look(const Author& author, Tick counted, const Eigen::Vector3d& x_m) {
  if (!cells_.looks_at(counted)) return;
  Row& own = row(author);
  if (counted <= own.newest_look) return;
  own.newest_look = counted;
  cells_.cells.for_near(x_m, cells_.radius_m, [&](int i, int j, int) {
    const TileCell cell = cells_.tile_cell(i, j);
    EffortTile& tile = own.tiles[cell.tile];
    if (cells_.looks_in(tile.looks[cell.slot]) >= cells_.most_looks) return;
    tile.newest_look = counted;
    ++tile.looks[cell.slot];
    ++sums_[cell.tile][cell.slot].looks;
  });
}

void Efforts::report(const Author& author, Tick counted, std::int32_t cell) {
  Row& own = row(author);
  const bool exists = cell >= 0 && static_cast<std::size_t>(cell) < cells_.cells.total();
  if (!cells_.reports() || !exists || counted <= own.newest_report) return;
  own.newest_report = counted;
  const TileCell at = cells_.tile_cell(cell);
  EffortTile& tile = own.tiles[at.tile];
  std::uint16_t& count = tile.looks[at.slot];
  const std::uint32_t looks = cells_.looks_in(count), reports = cells_.reports_in(count);
  if (looks >= cells_.most_looks || reports >= kMaxReports) return;
  tile.newest_look = counted;
  count = cells_.count_of(looks, reports + 1);
  ++sums_[at.tile][at.slot].reports;
}

/// A look counts once in each cell, so no count is above the number of looks.
bool Efforts::possible(const EffortTile& tile, Tick sent) const {
  if (tile.newest_look < 0 || tile.newest_look > sent) return false;
  const std::int64_t most =
      std::min<std::int64_t>(cells_.most_looks, cells_.looks_by(tile.newest_look));
  return std::ranges::all_of(tile.looks,
                             [&](std::uint16_t count) { return cells_.looks_in(count) <= most; });
}

bool Efforts::merge(const Author& author, std::size_t tile, EffortTile theirs, Tick sent) {
  ERGOCAST_REQUIRE(tile < cells_.tile_count());
  if (!possible(theirs, sent)) return false;
  EffortTile& ours = row(author).tiles[tile];
  if (theirs.newest_look <= ours.newest_look || is_early(sent)) return true;
  halve(theirs, halvings_ - half_life_.halvings(sent));
  subtract(tile, ours);
  add(tile, theirs);
  ours = theirs;
  return true;
}

}  // namespace ergocast
