// SPDX-License-Identifier: BSD-3-Clause
// Where all agents have searched, as one agent knows it: a state-based CRDT (a replicated value
// whose copies merge in any order) of counts.
//
// One row per (agent, incarnation): for each cell, how often this agent has looked at it and, with
// false alarms, how often it has reported something there. A row is
// kept in tiles of 8 × 8 cells, each with the counted tick of its newest look. A tile with a later
// tick replaces one with an earlier tick, so loss, repetition and reordering need no protocol.
// Counts are integers, so their sum over all rows does not depend on the order of merging.
//
// If the mission forgets (law.memory_half_life_s), all counts are halved and rounded down at
// counted ticks H, 2H, 3H …, as core/mission/half_life.h says.
//
// Sightings and dismissals (core/mission/search_note.h) make a team forget counts of some cells. At
// the note's counted tick, before the look of that tick, an author's row loses them, and its tile
// has changed. In other rows, tiles whose newest look was before that tick lose them, also when
// they are merged later. So forgetting commutes with merging. In real time an author may learn of a
// note late: its tile then replaces those that it sent in between.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/half_life.h"
#include "core/mission/hold.h"
#include "core/mission/mission.h"
#include "core/mission/search_note.h"
#include "core/search/search_cells.h"

namespace ergocast {

struct EffortTile {
  Tick newest_look = -1;  ///< counted; −1: this agent has never looked here
  std::array<std::uint16_t, kTileCells> looks{};  ///< and reports: SearchCells::looks_in()
};

/// The cells whose counts a note makes a team forget, by number: those whose middles are at most
/// 2 σ from a sighting, and its own cell; or a contact's cell and its neighbours.
std::vector<std::int32_t> forgotten_cells(const SearchNote& note, const SearchCells& cells);

class Efforts {
 public:
  /// @pre a plane
  explicit Efforts(const Mission& mission);

  const SearchCells& cells() const { return cells_; }

  /// Adds an empty row, if `author` has none.
  void add_row(const Author& author);
  /// Takes in all notes of the mission. The next set_now() forgets what those of its tick and
  /// before say; it forgets for each note once.
  void note(std::span<const SearchNote> notes, std::span<const Hold> holds);
  /// The counted tick has come: all counts are as they are remembered at it. An earlier tick has no
  /// effect.
  /// @return whether counts were halved or forgotten
  bool set_now(Tick counted);
  /// The agent's sensor is at `x_m` at tick `counted`, and looks if it is time to look, once at
  /// each tick, also if ticks are counted again. Does not allocate. @pre `author` has a row
  void look(const Author& author, Tick counted, const Eigen::Vector3d& x_m);

  /// The agent's sensor reports something in a cell at tick `counted`, at most once at each tick. A
  /// cell in which no more looks count takes no more reports either, because they would be evidence
  /// without their looks. A cell that does not exist has no effect. @pre `author` has a row
  void report(const Author& author, Tick counted, std::int32_t cell);

  /// Whether a tile of tick `sent` has been halved more often than ours: it is from after the next
  /// halving.
  bool is_early(Tick sent) const { return half_life_.halvings(sent) > halvings_; }
  /// Takes in a tile as its author had it at tick `sent`. A tile that is early, or not newer than
  /// the one held, has no effect.
  /// @return false without effect: no agent can have looked so often
  /// @pre tile < cells().tile_count()
  bool merge(const Author& author, std::size_t tile, EffortTile theirs, Tick sent);

  std::size_t row_count() const { return rows_.size(); }
  const Author& author(std::size_t row) const { return rows_[row].author; }
  /// The row of `author`; null: there is none.
  const std::vector<EffortTile>* row_of(const Author& author) const;

  /// How often all agents have looked at a cell, each up to cells().most_looks.
  std::uint32_t looks(const TileCell& cell) const { return sums_[cell.tile][cell.slot].looks; }
  /// How often all agents have reported something in a cell.
  std::uint32_t reports(const TileCell& cell) const { return sums_[cell.tile][cell.slot].reports; }

 private:
  struct Row {
    Author author;
    std::vector<EffortTile> tiles;
    Tick newest_look = -1, newest_report = -1;  // that look() and report() have done
  };
  /// What a note makes us forget.
  struct Forgetting {
    SearchNote note;
    Tick counted = 0;
    std::vector<TileCell> cells{};
    bool done = false;

    std::uint16_t left(std::uint16_t count, const SearchCells& cells) const {
      return note.is_sighting() ? 0 : cells.count_of(cells.looks_in(count), 0);
    }
  };
  struct Sum {
    std::uint32_t looks = 0, reports = 0;
  };
  Row& row(const Author& author);
  bool possible(const EffortTile& tile, Tick sent) const;
  void halve(EffortTile& tile, std::int64_t times) const;
  void forget(const Forgetting& one, Tick counted);
  void add(std::size_t tile, const EffortTile& counts);
  void subtract(std::size_t tile, const EffortTile& counts);

  SearchCells cells_;
  HalfLife half_life_;
  std::int64_t halvings_ = 0;
  std::vector<Forgetting> forgettings_;
  std::vector<Row> rows_;  // ascending by author
  std::vector<std::array<Sum, kTileCells>> sums_;
};

}  // namespace ergocast
