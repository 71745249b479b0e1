// SPDX-License-Identifier: BSD-3-Clause
// Keeps the sums over all rows up to date: they change by single looks and tiles.
#include "core/search/efforts.h"

#include <algorithm>

#include "core/base/require.h"

namespace ergocast {

std::vector<std::int32_t> forgotten_cells(const SearchNote& note, const SearchCells& search) {
  const Cells& cells = search.cells;
  const int columns = cells.count.x(), rows = cells.count.y();
  const auto own = static_cast<std::int32_t>(cells.cell_of(on_ground(note.x_m)));
  std::vector<std::int32_t> forgotten;
  if (note.is_sighting()) {
    cells.for_near(on_ground(note.x_m), kForgottenSigmas * note.sigma_m,
                   [&](int i, int j, int) { forgotten.push_back(i * rows + j); });
    if (std::ranges::find(forgotten, own) == forgotten.end()) forgotten.push_back(own);
    return forgotten;
  }
  for (int i = std::max(0, own / rows - 1); i <= std::min(columns - 1, own / rows + 1); ++i)
    for (int j = std::max(0, own % rows - 1); j <= std::min(rows - 1, own % rows + 1); ++j)
      forgotten.push_back(i * rows + j);
  return forgotten;
}

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

void Efforts::note(std::span<const SearchNote> notes, std::span<const Hold> holds) {
  std::vector<Forgetting> all;
  for (const SearchNote& note : notes) {
    const auto known = std::ranges::find(forgettings_, note, &Forgetting::note);
    Forgetting& one = all.emplace_back(known != forgettings_.end() ? *known : Forgetting{note});
    one.counted = counted_ticks(holds, note.from);
    if (!one.cells.empty()) continue;
    for (const std::int32_t cell : forgotten_cells(note, cells_))
      one.cells.push_back(cells_.tile_cell(cell));
  }
  forgettings_ = std::move(all);
}

/// A tile of our own row has then changed, so that it is sent again. Authors of other rows have
/// forgotten by themselves what they sent later.
void Efforts::forget(const Forgetting& one, Tick counted) {
  for (Row& row : rows_) {
    const bool is_own = row.newest_look >= 0;
    for (const TileCell& cell : one.cells) {
      EffortTile& tile = row.tiles[cell.tile];
      if (!is_own && tile.newest_look >= one.counted) continue;
      const std::uint16_t before = tile.looks[cell.slot], left = one.left(before, cells_);
      if (left == before) continue;
      tile.looks[cell.slot] = left;
      Sum& sum = sums_[cell.tile][cell.slot];
      sum.looks -= cells_.looks_in(before) - cells_.looks_in(left);
      sum.reports -= cells_.reports_in(before) - cells_.reports_in(left);
      if (is_own) tile.newest_look = counted;
    }
  }
}

bool Efforts::set_now(Tick counted) {
  bool changed = false;
  for (Forgetting& one : forgettings_) {
    if (one.done || one.counted > counted) continue;
    one.done = changed = true;
    forget(one, counted);
  }
  const std::int64_t halvings = half_life_.halvings(counted);
  if (halvings <= halvings_) return changed;
  std::ranges::fill(sums_, std::array<Sum, kTileCells>{});
  for (Row& row : rows_) {
    for (std::size_t tile = 0; tile < row.tiles.size(); ++tile) {
      halve(row.tiles[tile], halvings - halvings_);
      add(tile, row.tiles[tile]);
    }
  }
  halvings_ = halvings;
  return true;
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
  for (const Forgetting& one : forgettings_) {
    if (!one.done || theirs.newest_look >= one.counted) continue;
    for (const TileCell& cell : one.cells)
      if (cell.tile == tile) theirs.looks[cell.slot] = one.left(theirs.looks[cell.slot], cells_);
  }
  subtract(tile, ours);
  add(tile, theirs);
  ours = theirs;
  return true;
}

}  // namespace ergocast
