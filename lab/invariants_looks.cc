// SPDX-License-Identifier: BSD-3-Clause
// Checks that what agents hold of each other's looks is what its author sent, and counts once.
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/mission/hold.h"
#include "lab/invariants.h"

namespace ergocast::lab {
namespace {

/// Whether a tile has the counts that its author sent, but for those of some cells: the holder may
/// have forgotten them.
bool same_counts(const std::array<std::uint16_t, kTileCells>& sent, const EffortTile& held,
                 std::size_t tile, std::span<const TileCell> forgotten) {
  for (std::size_t slot = 0; slot < kTileCells; ++slot) {
    const bool may_differ = std::ranges::any_of(
        forgotten, [&](const TileCell& cell) { return cell.tile == tile && cell.slot == slot; });
    if (may_differ ? held.looks[slot] > sent[slot] : held.looks[slot] != sent[slot]) return false;
  }
  return true;
}

std::vector<TileCell> cells_of(const SearchNote& note, const SearchCells& cells) {
  std::vector<TileCell> all;
  for (const std::int32_t cell : forgotten_cells(note, cells)) all.push_back(cells.tile_cell(cell));
  return all;
}

}  // namespace

/// An author sends the same counts of a tile as long as it has not looked there again.
void Invariants::note_looks(const Effort& own) {
  const auto tiles = std::span(own.tiles).first(static_cast<std::size_t>(own.tile_count));
  auto& sent = looks_sent_[own.author()];
  for (const SentTile& tile : tiles)
    sent[{tile.number, tile.content.newest_look}] = tile.content.looks;
}

/// Which cell has counts from before a note that makes its holder forget them; empty if none has.
/// In lockstep all agents know a note at its tick.
std::string Invariants::remembered(const TableView& holder) const {
  const Efforts& efforts = *holder.efforts;
  const SearchCells& cells = efforts.cells();
  if (mission_.timing.pace != Pace::kLockstep) return {};
  for (const SearchNote& note : truth_.amendments().notes) {
    const Tick from = counted_ticks(truth_.holds(), note.from);
    if (from > holder.counted || holder.held) continue;
    for (const TileCell& at : cells_of(note, cells)) {
      for (std::size_t row = 0; row < efforts.row_count(); ++row) {
        const EffortTile& tile = (*efforts.row_of(efforts.author(row)))[at.tile];
        const std::uint16_t count = tile.looks[at.slot];
        const bool any = note.is_sighting() ? count > 0 : cells.reports_in(count) > 0;
        if (tile.newest_look < from && any)
          return text("counts of ", name_of(efforts.author(row)), " in tile ", at.tile,
                      ", which the note of amendment ", note.number, " makes it forget");
      }
    }
  }
  return {};
}

/// Without a half-life: counts that are halved differ from those that were sent.
void Invariants::check_looks(double t_s, const TableView& holder) {
  if (holder.efforts == nullptr || mission_.law.memory_half_life_s > 0) return;
  const Efforts& efforts = *holder.efforts;
  std::string wrong = remembered(holder);
  const SearchCells& cells = efforts.cells();
  std::vector<TileCell> forgotten;
  for (const SearchNote& note : truth_.amendments().notes)
    std::ranges::copy(cells_of(note, cells), std::back_inserter(forgotten));
  std::vector<std::array<std::pair<std::uint32_t, std::uint32_t>, kTileCells>> sums(
      cells.tile_count());
  for (std::size_t row = 0; row < efforts.row_count(); ++row) {
    const Author& author = efforts.author(row);
    const auto& sent = looks_sent_[author];
    std::size_t number = 0, reports = 0;
    for (const EffortTile& tile : *efforts.row_of(author)) {
      for (std::size_t slot = 0; slot < kTileCells; ++slot) {
        sums[number][slot].first += cells.looks_in(tile.looks[slot]);
        sums[number][slot].second += cells.reports_in(tile.looks[slot]);
        reports += cells.reports_in(tile.looks[slot]);
      }
      const auto known = sent.find({static_cast<std::int32_t>(number++), tile.newest_look});
      if (tile.newest_look < 0 || author == holder.self) continue;
      if (known == sent.end() || !same_counts(known->second, tile, number - 1, forgotten))
        wrong = text("tile ", number - 1, " of ", name_of(author), " at tick ", tile.newest_look);
    }
    if (reports > reports_[author.agent].size())
      wrong = text(reports, " reports of ", name_of(author), ", whose sensor has made ",
                   reports_[author.agent].size());
  }
  for (std::size_t tile = 0; tile < sums.size(); ++tile)
    for (std::size_t slot = 0; slot < kTileCells; ++slot)
      if (std::pair(efforts.looks({tile, slot}), efforts.reports({tile, slot})) != sums[tile][slot])
        wrong = text("the sum in tile ", tile, ", ", sums[tile][slot].first, " looks and ",
                     sums[tile][slot].second, " reports in its rows");
  if (!wrong.empty()) violate(t_s, Invariant::kLooksAreTrue, name_of(holder.self), wrong);
}

}  // namespace ergocast::lab
