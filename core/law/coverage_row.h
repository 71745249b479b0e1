// SPDX-License-Identifier: BSD-3-Clause
// One row of the table in core/law/coverage_table.h: the blocks of one (agent, incarnation).
//
// The blocks of a row that arrives have their own step counts and share their sums with the
// messages. A row that is sampled keeps all its sums in one array instead.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/block_sums.h"
#include "core/base/contribution.h"
#include "core/base/ids.h"
#include "core/base/line_aligned.h"
#include "core/law/block_layout.h"

namespace ergocast {

/// Whether an honest agent can have sent these sums and gains: the elapsed time is steps·dt, S_00
/// is the elapsed time, and neither |S| nor a gain exceeds `range` times its time, all up to
/// rounding (1e-9 and half an ulp a step).
/// @param range  1, or kShiftedRange once a target has changed
bool is_possible(const Contribution& theirs, double dt_s, double range = 1);

/// How a table finds what a block has gained since the one held before.
struct GainRule {
  double dt_s;
  Tick joined;        ///< no block is compared with one that was sent before this tick
  bool noted = true;  ///< false: blocks in doubles are not compared
  double range = 1;   ///< of samples: kShiftedRange once a target has changed
};

/// One block of a row, as it has arrived.
class CoverageBlock {
 public:
  /// All that is known of a block except for its gains.
  struct View {
    const double* sums;  ///< those of the block's slots [s]
    std::int64_t steps;
    Tick tick;    ///< when it was sent
    Tick period;  ///< until its author's next broadcast, as announced
  };
  /// What a block has gained since the one held before.
  struct Gains {
    const double* before;     ///< the sums of the one held before [s]; null if `announced` is set
    const double* announced;  ///< the gains that the author has sent [s], or null
    std::int64_t steps;  ///< the steps gained; 0 if the gains are not noted, or impossible: |gain|
                         ///< > their time
  };

  std::int64_t steps() const { return steps_; }
  /// The steps over which it has gained; 0 if no agent can gain that much in them.
  std::int64_t gained_steps() const { return gained_steps_; }
  const BlockSums& sums() const { return sums_; }
  const BlockSums& sums_before() const { return sums_before_; }
  const BlockSums& announced_gains() const { return announced_gains_; }
  /// Until its author's next broadcast, as announced.
  Tick period() const { return next_broadcast_tick_ - tick_; }
  /// The tick of that broadcast; before every tick if no block has arrived.
  Tick due_tick() const {
    return steps_ > 0 ? next_broadcast_tick_ : std::numeric_limits<Tick>::min();
  }
  /// Its view, for a row whose sums of this block are at `sums`.
  View view(const double* sums) const { return {sums, steps_, tick_, period()}; }
  /// Whether the views of two blocks differ only in their sums.
  bool looks_like(const CoverageBlock& other) const;

  /// Takes over a newer block and what it has gained since this one.
  void replace(const Contribution& theirs, const GainRule& rule);
  /// Takes over a newer block without gains.
  void replace(const Contribution& theirs);
  /// Its author will broadcast only at a later tick, because it rests until then.
  void postpone(Tick next_broadcast_tick) {
    next_broadcast_tick_ = std::max(next_broadcast_tick_, next_broadcast_tick);
  }
  /// One more step, whose sample the row has.
  void add_step() { ++steps_; }
  void forgo_gains() { gained_steps_ = 0; }
  /// Sets steps, ticks and sequence of a message with this block.
  void write_header(Contribution& out) const;

 private:
  std::int64_t compare(const Contribution& theirs, const GainRule& rule);

  std::int64_t steps_ = 0;
  std::int64_t sequence_ = 0;  // of the message that brought it, for a relay
  Tick tick_ = 0, next_broadcast_tick_ = 0;
  std::int32_t range_ = 1;
  std::int64_t gained_steps_ = 0;
  BlockSums sums_;
  BlockSums sums_before_;      // kDouble: of the block that it is compared with
  BlockSums announced_gains_;  // kFixed16
};

class CoverageRow {
 public:
  /// One row as a digest describes it.
  struct Summary {
    Author author;
    std::int64_t steps;         ///< the fewest among its blocks
    std::int64_t newest_steps;  ///< the most
    Tick announced_period;
    std::uint64_t state_hash;  ///< equal for equal steps of every block
  };

  /// An empty row, which counts.
  CoverageRow(const Author& author, const BlockLayout& layout);

  const Author& author() const { return author_; }
  bool counts() const { return counts_; }
  void set_counts(bool counts) { counts_ = counts; }
  double quality() const { return quality_; }
  void set_quality(double quality) { quality_ = quality; }

  /// The fewest steps among its blocks.
  std::int64_t fewest_steps() const { return fewest_steps_; }
  /// The first tick at which one of its blocks is due; before every tick if any has not arrived.
  Tick due_tick() const { return due_tick_; }
  /// The longest time that its author has announced between two of its broadcasts.
  Tick announced_period() const;
  Summary summary() const;

  const CoverageBlock& block(int block) const { return blocks_[static_cast<std::size_t>(block)]; }
  /// The sums of a block's slots [s].
  const double* sums(int block) const {
    if (samples_.empty()) return this->block(block).sums().data();
    return samples_.data() + static_cast<std::ptrdiff_t>(block) * block_size_;
  }
  CoverageBlock::View view(int block) const { return this->block(block).view(sums(block)); }
  /// Whether the views of all blocks differ only in their sums.
  bool uniform_blocks() const;
  /// Whether all blocks have gained over the same number of steps.
  bool uniform_gains() const;

  /// The sums of a row that is sampled [s]: one for each slot, then zeros. Empty for other rows.
  const AlignedDoubles& samples() const { return samples_; }
  /// Makes the row one that is sampled. The caller adds f(x)·dt to these sums and calls add_step().
  double* sampled();
  /// Counts one more step in every block.
  void add_step();

  /// Takes over a newer block.
  void replace(const Contribution& theirs, const GainRule& rule);
  /// Takes over when the block with the same steps comes next, if that is later than announced.
  void postpone(const Contribution& theirs);
  /// Sets all that the row has of the block `out.block`, except for its elapsed time. The message
  /// already has its block and encoding.
  /// @param size  how many numbers this block has on the wire
  void write(Contribution& out, std::size_t size) const;

 private:
  /// Call it after a block has changed.
  void sum_up();

  Author author_;
  int block_size_;
  bool counts_ = true;
  double quality_ = 1;
  std::int64_t fewest_steps_ = 0;
  Tick due_tick_ = std::numeric_limits<Tick>::min();
  std::vector<CoverageBlock> blocks_;
  AlignedDoubles samples_;  // instead of the blocks' sums, once there are samples
};

}  // namespace ergocast
