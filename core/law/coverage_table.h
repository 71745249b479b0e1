// SPDX-License-Identifier: BSD-3-Clause
// The coverage of all agents as one agent knows it: a state-based CRDT (a replicated value whose
// copies merge in any order) of cumulative sums.
//
// One row per (agent, incarnation), each in blocks with their own step counts. A block with more
// steps replaces one with fewer, so merging is commutative, associative and idempotent: loss,
// repetition and reordering need no protocol. The team's c_k is rebuilt in ascending
// (agent, incarnation) order, because the order of additions changes trajectories.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/block_sums.h"
#include "core/base/contribution.h"
#include "core/base/ids.h"
#include "core/base/line_aligned.h"
#include "core/basis/basis.h"
#include "core/law/block_layout.h"

namespace ergocast {

enum class Merge { kNewer, kStale, kRefusedRange, kRefusedLimit, kRefusedEncoding };

class CoverageTable {
 public:
  /// @param joined  the tick from which its holder takes part. Earlier blocks depend on when the
  ///                holder joined, so no block is compared with one that was sent before that tick.
  CoverageTable(const Basis& basis, double dt_s, Tick joined = 0);

  /// From now on the table does not note what blocks gain, and gains() returns none. Holders that
  /// do not look ahead use it.
  void forgo_gains() { notes_gains_ = false; }

  /// From now on blocks arrive and are returned in this layout and its encoding. Before the first
  /// call they are doubles in the order of the basis.
  /// @pre no rows
  void set_layout(const BlockLayout& layout);

  int block_count() const { return block_count_; }
  int block_size() const { return block_size_; }

  /// Adds an empty row, if `author` has none.
  /// @pre the table has room.
  void add_row(const Author& author);

  /// S += f(x)·dt for the row of `author`, (4)'s integral; creates the row if it is new.
  /// @param footprint  null, or g of core/mission/kinds.h: S += g f(x)·dt
  void add_sample(const Author& author, const BasisAt& at, const double* footprint = nullptr);

  /// From now on the row of `author`, if there is one, counts with this quality. The default is 1.
  void set_quality(const Author& author, double quality);

  /// Merges one block. These are refused without effect: another encoding; another number of modes;
  /// a block that does not exist or has another length; an elapsed time that is not steps·dt; an
  /// S_00 that is not the elapsed time, or |S| > elapsed, both up to rounding (1e-9 and half an ulp
  /// a step); more steps than `max_steps` (a forged future would win for ever); a new row for a
  /// full table.
  Merge merge(const Contribution& theirs, std::int64_t max_steps);

  /// One block of a row as its author sent it, with the header except for the run. If the block is
  /// unknown, steps is 0.
  Contribution block(const Author& author, int block) const;

  /// From now on the row of `author` does not count, even if it arrives later. It is kept and
  /// relayed.
  void forget(const Author& author);
  /// From now on every row counts, with all blocks that arrived meanwhile.
  void remember_all();

  /// c_k = Σ_j q_j S_j / Σ_j q_j elapsed_j per block, (4) weighted by quality and by the time that
  /// each row covers.
  /// Entries of blocks without any samples are 0. Does not allocate.
  /// @param coverage  in the order of the basis, for every layout
  void average(Coefficients& coverage) const;

  /// The fewest steps among a row's blocks; nothing if the row is unknown.
  std::optional<std::int64_t> steps_held(const Author& author) const;

  /// The longest time that `author` has announced between two of its broadcasts; 0 if unknown.
  Tick announced_period(const Author& author) const;

  /// One row as a digest describes it.
  struct RowSummary {
    Author author;
    std::int64_t steps;         ///< the fewest among its blocks
    std::int64_t newest_steps;  ///< the most
    Tick announced_period;
    std::uint64_t state_hash;  ///< equal for equal steps of every block
  };
  /// Row `i` of row_count(), in ascending order of authors.
  RowSummary summary_of(std::size_t i) const;
  const Author& author(std::size_t i) const { return rows_[i].author; }
  bool counts(std::size_t i) const { return rows_[i].counts; }
  double quality(std::size_t i) const { return rows_[i].quality; }
  std::int64_t min_steps(std::size_t i) const { return rows_[i].fewest_steps; }
  /// The row of `author`; all 0 if it is unknown.
  RowSummary summary_of(const Author& author) const;

  /// One block of a row.
  struct BlockView {
    const double* sums;  ///< those of the block's slots [s]
    std::int64_t steps;
    Tick tick;    ///< when it was sent
    Tick period;  ///< until its author's next broadcast, as announced
  };
  BlockView view(std::size_t row, int block) const;
  /// What a block has gained since the one held before.
  struct Gains {
    const double* before;     ///< the sums of the one held before [s]; null if `announced` is set
    const double* announced;  ///< the gains that the author has sent [s], or null
    std::int64_t steps;  ///< the steps gained; 0 if the gains are not noted, or impossible: |gain|
                         ///< > their time
  };
  Gains gains(std::size_t row, int block) const;
  /// Whether the views of all blocks of a row differ only in their sums.
  bool uniform_blocks(std::size_t row) const;
  /// Whether all blocks have gained over the same number of steps.
  bool uniform_gains(std::size_t row) const;

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
  static constexpr std::int64_t kNotCompared = -1;
  static constexpr Tick kNeverSent = std::numeric_limits<Tick>::min();
  struct Block {
    std::int64_t steps = 0;
    Tick next_broadcast_tick = 0;
    std::int64_t sequence = 0;  // of the message that brought it, for a relay
    Tick tick = 0;
    std::int64_t steps_before = 0;  // of the block that it is compared with
    BlockSums sums, sums_before;    // the latter in kFixed16: gains
    mutable std::int64_t gained_steps = kNotCompared;
    bool looks_like(const Block& other) const;
  };
  struct Row {
    Author author;
    bool counts = true;
    std::int64_t fewest_steps = 0;  // among the blocks
    Tick due_tick = kNeverSent;     // of the block that is due first
    std::vector<Block> blocks;
    AlignedDoubles samples;  // instead of the blocks' sums, once there are samples
    double quality = 1;
    const double* sums(std::size_t block, int block_size) const;
    /// Call it after a block has changed.
    void sum_up();
    std::int64_t max_steps() const;
    std::uint64_t state_hash() const;
    RowSummary summary_of() const;
    Tick announced_period() const;
  };

  const Row* find(const Author& author) const;
  Row* find(const Author& author);
  Row* find_or_add(const Author& author);

  std::int64_t gained_steps(const Block& block) const;
  bool has_size(const Contribution& theirs) const;
  void add_in_slots(const BasisAt& at, const double* footprint, double* samples);
  void average_slots(double* coverage) const;

  Basis basis_;
  double dt_s_;
  Tick joined_;
  BlockLayout layout_;
  int block_size_ = kBlockSize;
  int block_count_;
  bool notes_gains_ = true;
  bool weighted_ = false;                       // whether any row has a quality other than 1
  std::vector<Row> rows_;                       // ascending by author
  mutable std::vector<const double*> counted_;  // of each row that counts, the sums of a block
  mutable std::vector<double> qualities_;       // and its quality
  // Numbers by mode and by slot, only for a layout other than the order of the basis.
  std::vector<double> by_mode_;
  mutable std::vector<double> by_slot_;
};

}  // namespace ergocast
