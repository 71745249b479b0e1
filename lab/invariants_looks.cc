// SPDX-License-Identifier: BSD-3-Clause
// Checks that what agents hold of each other's looks is what its author sent, and counts once.
#include <optional>
#include <string>
#include <utility>

#include "lab/invariants.h"

namespace ergocast::lab {

/// An author sends the same counts of a tile as long as it has not looked there again.
void Invariants::note_looks(const Effort& own) {
  const auto tiles = std::span(own.tiles).first(static_cast<std::size_t>(own.tile_count));
  auto& sent = looks_sent_[own.author()];
  for (const SentTile& tile : tiles)
    sent[{tile.number, tile.content.newest_look}] = tile.content.looks;
}

/// Without a half-life: counts that are halved differ from those that were sent.
void Invariants::check_looks(double t_s, const TableView& holder) {
  if (holder.efforts == nullptr || mission_.law.memory_half_life_s > 0) return;
  const Efforts& efforts = *holder.efforts;
  std::string wrong;
  const SearchCells& cells = efforts.cells();
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
      if (known == sent.end() || known->second != tile.looks)
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
