// SPDX-License-Identifier: BSD-3-Clause
// The coverage of all agents as one agent knows it: a state-based CRDT (a replicated value whose
// copies merge in any order) of cumulative sums.
//
// One row per (agent, incarnation), each in blocks with their own step counts. A block with more
// steps replaces one with fewer, so merging is commutative, associative and idempotent: loss,
// repetition and reordering need no protocol. The team's c_k is rebuilt in ascending
// (agent, incarnation) order, because the order of additions changes trajectories.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/contribution.h"
#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/law/block_layout.h"
#include "core/law/coverage_row.h"
#include "core/mission/half_life.h"

namespace ergocast {

enum class Merge {
  kNewer,
  kStale,
  kRefusedRange,
  kRefusedLimit,
  kRefusedEncoding,
  kRefusedShift,  ///< sums that need a change of the target, and the table knows of none
};

class CoverageTable {
 public:
  /// @param joined  the tick from which its holder takes part. Only some holders have blocks from
  ///                before, so no block is compared with one that was sent before that tick.
  CoverageTable(const Basis& basis, double dt_s, Tick joined = 0);

  /// From now on the table does not note what blocks gain, and gains() returns none. Holders that
  /// do not look ahead use it.
  void forgo_gains() { gain_rule_.noted = false; }

  /// From now on blocks arrive and are returned in this layout and its encoding. Before the first
  /// call they are doubles in the order of the basis.
  /// @pre no rows
  void set_layout(const BlockLayout& layout);

  /// From now on rows are forgotten by halving. Without it, or with no half-life, nothing is.
  /// @pre no rows
  void set_half_life(const HalfLife& half_life);
  const HalfLife& half_life() const { return gain_rule_.half_life; }

  /// Sets the present tick, among those that count. What the table returns from now on, except by
  /// block(), is as remembered at this tick. Call it before the tick's sample. An earlier tick has
  /// no effect. With a half-life it may allocate at ticks at which sums are halved.
  void set_now(Tick counted);

  /// How often sums have been halved by the present tick.
  std::int64_t halvings() const { return gain_rule_.halvings; }
  /// What a step at a counted tick weighs at the present tick: a power of two; 1 without a
  /// half-life.
  double weight_at(Tick counted) const {
    return HalfLife::factor(half_life().halvings(counted), halvings());
  }

  int block_count() const { return layout_.block_count(); }
  int block_size() const { return layout_.block_size(); }

  /// Adds an empty row, if `author` has none.
  /// @pre the table has room.
  void add_row(const Author& author);

  /// S += f(x)·dt for the row of `author`, (4)'s integral; creates the row if it is new.
  /// @param footprint  null, or g of core/mission/kinds.h: S += g f(x)·dt
  void add_sample(const Author& author, const BasisAt& at, const double* footprint = nullptr);

  /// S −= shift·dt for the row of `author`, after its newest sample (core/law/target_shift.h).
  /// @param shift  one number for each slot
  /// @pre allows_shifts(), and `author` has samples
  void shift_sample(const Author& author, const double* shift);
  /// From now on samples may be shifted, so sums may be up to kShiftedRange times their time.
  void allow_shifts() { gain_rule_.range = kShiftedRange; }
  bool allows_shifts() const { return gain_rule_.range == kShiftedRange; }

  /// From now on the row of `author`, if there is one, counts with this quality. The default is 1.
  void set_quality(const Author& author, double quality);

  /// Merges one block. A block with as many steps as the held one changes no sum, but may postpone
  /// its author's next broadcast. These are refused without effect: another encoding;
  /// another number of modes; a block that does not exist or has another length; numbers that are
  /// not possible (core/law/coverage_row.h); more steps than `max_steps` (a forged number would win
  /// for ever); a new row for a full table.
  Merge merge(const Contribution& theirs, std::int64_t max_steps);

  /// One block of a row as its author sent it, with the header except for the run. If the block is
  /// unknown, steps is 0. With a half-life, the tick of a row with samples is that of its last
  /// halving.
  Contribution block(const Author& author, int block) const;

  /// From now on the row of `author` does not count, even if it arrives later. It is kept and
  /// relayed.
  void forget(const Author& author);
  /// From now on every row counts, with all blocks that arrived meanwhile.
  void remember_all();

  /// c_k = Σ_j q_j S_j / Σ_j q_j elapsed_j per block, (4) weighted by quality and by the time that
  /// each row covers, both as remembered at the present tick.
  /// Entries of blocks without any samples are 0. Does not allocate.
  /// @param coverage  in the order of the basis, for every layout
  void average(Coefficients& coverage) const;

  /// The fewest steps among a row's blocks; nothing if the row is unknown.
  std::optional<std::int64_t> steps_held(const Author& author) const;

  /// The longest time that `author` has announced between two of its broadcasts; 0 if unknown.
  Tick announced_period(const Author& author) const;

  using RowSummary = CoverageRow::Summary;
  /// Row `i` of row_count(), in ascending order of authors.
  RowSummary summary_of(std::size_t i) const { return rows_[i].summary(); }
  const Author& author(std::size_t i) const { return rows_[i].author(); }
  bool counts(std::size_t i) const { return rows_[i].counts(); }
  double quality(std::size_t i) const { return rows_[i].quality(); }
  std::int64_t min_steps(std::size_t i) const { return rows_[i].fewest_steps(); }
  /// The row of `author`; all 0 if it is unknown.
  RowSummary summary_of(const Author& author) const;

  using BlockView = CoverageBlock::View;
  BlockView view(std::size_t row, int block) const { return rows_[row].view(block); }
  using Gains = CoverageBlock::Gains;
  Gains gains(std::size_t row, int block) const;
  /// Whether the views of all blocks of a row differ only in their sums.
  bool uniform_blocks(std::size_t row) const { return rows_[row].uniform_blocks(); }
  /// Whether all blocks have gained over the same number of steps.
  bool uniform_gains(std::size_t row) const { return rows_[row].uniform_gains(); }

  /// The sums of a row that only add_sample() fills [s]: one for each slot, then zeros.
  /// @pre `author` has samples
  const double* sums_of(const Author& author) const;

  /// Time covered by all rows that count, by their first block, each with its quality: the
  /// denominator of c_k [s].
  double covered_s() const;

  /// Whether every block that `author` was due to send by `tick` is held.
  bool holds_due(const Author& author, Tick tick) const;

  std::size_t row_count() const { return rows_.size(); }

 private:
  /// Working memory: neither a sample nor average(), which is const, may allocate.
  struct Scratch {
    std::vector<const double*> counted;  // of each row that counts, the sums of a block
    std::vector<double> qualities;       // and its quality
    // Numbers by mode and by slot, only for a layout other than the order of the basis.
    std::vector<double> by_mode, by_slot;
  };

  std::size_t place_of(const Author& author) const;
  const CoverageRow* find(const Author& author) const;
  CoverageRow* find(const Author& author);
  CoverageRow* find_or_add(const Author& author);

  bool fits(const Contribution& theirs) const;
  void add_in_slots(const BasisAt& at, const double* footprint, double* samples);
  void average_slots(double* coverage) const;

  Basis basis_;
  BlockLayout layout_;
  GainRule gain_rule_;
  bool weighted_ = false;          // whether any row has a quality other than 1
  std::vector<CoverageRow> rows_;  // ascending by author
  mutable Scratch scratch_;
};

}  // namespace ergocast
