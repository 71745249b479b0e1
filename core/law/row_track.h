// SPDX-License-Identifier: BSD-3-Clause
// A teammate's row since its last blocks, for the dead reckoning of core/law/forecast.h.
//
// S += f dt at each place since a block was sent, in every block that does not contain the step, as
// its author does. Places that were lost are those of core/law/lost_places.h. The table is not
// changed. The newest step of each block stays due until it is needed, because a forecast adds it
// in the same loop as the row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "core/base/line_aligned.h"
#include "core/basis/basis.h"
#include "core/law/coverage_table.h"
#include "core/law/forecast_sums.h"
#include "core/law/lost_places.h"
#include "core/law/sampling.h"
#include "core/mission/roster.h"

namespace ergocast {

class RowTrack {
 public:
  /// @param most_places  how many places count; older ones are forgotten
  explicit RowTrack(std::size_t most_places) : most_places_(most_places) {}

  /// Notes a place of the vehicle, which is not one of an incarnation. A tick that is not newer
  /// than all known ones has no effect. Allocates only for the first place.
  void see(Tick tick, const Eigen::Vector3d& x_m);

  /// Extends the row to the newest place at which its author was active.
  /// @param entry  of the row's author
  /// @param look   the number of this forecast. Additions are dropped if another author is followed
  ///               or a number is left out.
  void extend(const CoverageTable& table, std::size_t row, const RosterEntry& entry,
              std::uint64_t look, Sampling& sampling);

  /// The tick of the newest place; −1 without one.
  Tick newest_tick() const { return newest_tick_; }
  /// The time that a block covers, with the steps at places [steps].
  double remembered_steps(int block) const { return of(block).remembered_steps; }
  /// The steps of a block that are at places.
  std::int64_t added_steps(int block) const { return of(block).steps - of(block).sent_steps; }
  /// Whether any step of a block is at a place. If so, sums() has the block.
  bool extends(int block) const { return added_steps(block) > 0; }
  /// Whether all blocks have the same steps, and the same ones due.
  bool uniform() const;

  int kind() const { return kind_; }
  /// The sums with all steps that are not due [s]. They begin with the first slot.
  double* sums() { return sums_.data(); }
  /// Whether the newest step of a block is due. The caller adds it to sums(): it is due no more.
  bool take_due_step(int block);
  /// The gain at the newest place. @pre newest_tick() ≥ 0
  sums::PlaceGain newest_gain(const Sampling& sampling) const {
    return sampling.gain(*newest_, kind_);
  }
  /// The same by slot [s]; only where slots are not modes.
  const double* newest_gains_in_slots() const { return in_slots_.data(); }

 private:
  struct Block {
    std::int64_t sent_steps = -1;  // of the block that was taken from the row
    std::int64_t steps = 0;        // with the places added since
    double elapsed_s = 0;          // the time that they cover, halved as the sums …
    double remembered_steps = 0;  // … and the same in steps, which is `steps` without a half-life
    Tick until = 0;               // the tick of the last step
    bool due = false;             // whether that step counts, but is not in the sums yet
  };

  const Block& of(int block) const { return blocks_[static_cast<std::size_t>(block)]; }
  void restart(const RosterEntry& entry, const BlockLayout& layout);
  void take_newer_blocks(const CoverageTable& table, std::size_t row);
  void fade(const CoverageTable& table, const Sampling& sampling);
  Tick oldest_block() const;
  std::vector<PlaceAtTick>::const_iterator first_to_add() const;
  void add_lost(std::vector<PlaceAtTick>::const_iterator place, const CoverageTable& table,
                std::size_t row, Sampling& sampling);
  void add_at(const PlaceAtTick& place, const CoverageTable& table, std::size_t row,
              Sampling& sampling);
  void move_to(const PlaceAtTick& place, Sampling& sampling);
  void add_due_steps(const Sampling& sampling, double weight = 1);
  void add_step(Tick tick, const CoverageTable& table, std::size_t row, const Sampling& sampling);

  static constexpr std::size_t kErasedAtOnce = 16;

  std::size_t most_places_;
  std::vector<PlaceAtTick> places_;  // ascending by tick; the last most_places_ count
  Author author_;                    // author of the row that is extended
  Tick active_from_ = 0;             // of that author, from the roster, …
  int kind_ = 0;                     // … and its kind
  std::uint64_t look_ = 0;           // of the forecast that extended it last
  std::vector<Block> blocks_;
  AlignedDoubles sums_;              // with the places; not set for blocks that are not extended
  std::int64_t halvings_ = 0;        // of these sums
  std::optional<CosinesAt> newest_;  // at the newest place, and its tick
  Tick newest_tick_ = -1;
  AlignedDoubles in_slots_;  // g f dt there, by slot; only where that is not the mode
};

}  // namespace ergocast
