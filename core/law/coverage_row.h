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
#include "core/mission/half_life.h"

namespace ergocast {

/// Whether an honest agent can have sent these sums and gains: the elapsed time is steps·dt, S_00
/// is the elapsed time, and neither |S| nor a gain exceeds `range` times its time, all up to
/// rounding (1e-9 and half an ulp a step). With a half-life the elapsed time is positive, at most
/// steps·dt, and at most HalfLife::longest_memory_s().
/// @param range  1, or kShiftedRange once a target has changed
bool is_possible(const Contribution& theirs, double dt_s, double range = 1,
                 const HalfLife& half_life = {});

/// How a table finds what a block has gained since the one held before, and what it still weighs.
struct GainRule {
  double dt_s;
  Tick joined;        ///< no block is compared with one that was sent before this tick
  bool noted = true;  ///< false: blocks in doubles are not compared
  double range = 1;   ///< of samples: kShiftedRange once a target has changed
  HalfLife half_life = {};
  std::int64_t halvings = 0;  ///< of all sums at the present tick
};

/// One block of a row, as it has arrived.
class CoverageBlock {
 public:
  /// All that is known of a block except for its gains.
  struct View {
    const double* sums;  ///< those of the block's slots, halved up to the present tick [s]
    std::int64_t steps;
    double
        remembered_steps;  ///< the time that these sums cover [steps]; `steps` without a half-life
    double remembered_s;   ///< the same [s], only with a half-life
    Tick tick;             ///< when it was sent
    Tick period;           ///< until its author's next broadcast, as announced
  };
  /// What a block has gained since the one held before.
  struct Gains {
    const double* before;     ///< the sums of the one held before [s]; null if `announced` is set
    const double* announced;  ///< the gains that the author has sent [s], or null
    std::int64_t steps;  ///< the steps gained; 0 if the gains are not noted, or impossible: |gain|
                         ///< > their time
    double time_steps;   ///< the time that the gains cover [steps]; `steps` without a half-life
  };

  std::int64_t steps() const { return steps_; }
  /// The steps over which it has gained; 0 if no agent can gain that much in them.
  std::int64_t gained_steps() const { return gained_steps_; }
  /// The time that the gains cover [steps]. @param announced  whether their author has sent them
  double gained_time_steps(bool announced) const {
    return announced ? announced_time_steps_ : remembered_steps_ - steps_before_;
  }
  /// As they were sent; the time that they covered then, only with a half-life [s].
  const BlockSums& sums() const { return sums_; }
  double elapsed_s() const { return elapsed_s_; }
  /// The sums halved up to the present tick, the time that they cover [steps], and the sums of the
  /// block before, halved as often.
  const BlockSums& remembered() const { return faded_ ? faded_sums_ : sums_; }
  double remembered_steps() const { return remembered_steps_; }
  const BlockSums& sums_before() const { return sums_before_; }
  const BlockSums& announced_gains() const { return announced_gains_; }
  /// Until its author's next broadcast, as announced.
  Tick period() const { return next_broadcast_tick_ - tick_; }
  /// The tick of that broadcast; before every tick if no block has arrived.
  Tick due_tick() const {
    return steps_ > 0 ? next_broadcast_tick_ : std::numeric_limits<Tick>::min();
  }
  /// Its view, for a row whose sums of this block are at `sums`.
  View view(const double* sums) const {
    return {sums, steps_, remembered_steps_, remembered_s_, tick_, period()};
  }
  /// Whether the views of two blocks differ only in their sums.
  bool looks_like(const CoverageBlock& other) const;

  /// Takes over a newer block and what it has gained since this one.
  void replace(const Contribution& theirs, const GainRule& rule);
  /// Takes over a newer block without gains.
  void replace_sums(const Contribution& theirs, const GainRule& rule);
  /// The present tick has more halvings than when this was last called, or fewer: from the block as
  /// it was sent follows what it weighs now.
  void fade(const GainRule& rule);
  /// Its author will broadcast only at a later tick, because it rests until then.
  void postpone(Tick next_broadcast_tick) {
    next_broadcast_tick_ = std::max(next_broadcast_tick_, next_broadcast_tick);
  }
  /// One more step, whose sample the row has.
  void add_step(const GainRule& rule);
  void forgo_gains() { gained_steps_ = 0; }
  /// For a block whose sums the row has: what it covers is halved as often as at the present tick.
  /// Returns by what the row has to multiply its sums.
  double halve(const GainRule& rule);
  /// Sets steps, ticks and sequence of a message with this block.
  void write_header(Contribution& out) const;

 private:
  std::int64_t compare(const Contribution& theirs, const GainRule& rule);
  void weigh(const GainRule& rule, double factor);
  void fade_before(std::int64_t halvings);

  std::int64_t steps_ = 0;
  double elapsed_s_ = 0;  // as sent, only with a half-life
  double remembered_s_ = 0, remembered_steps_ = 0;
  std::int64_t sequence_ = 0;  // of the message that brought it, for a relay
  Tick tick_ = 0, next_broadcast_tick_ = 0;
  std::int32_t range_ = 1;
  std::int64_t gained_steps_ = 0;
  double announced_time_steps_ = 0;  // of announced_gains_
  bool faded_ = false;               // whether faded_sums_ are the sums of the present tick
  BlockSums faded_sums_;
  BlockSums sums_;
  // kDouble: of the block that it is compared with, the time that they cover, and their halvings.
  BlockSums sums_before_;
  double steps_before_ = 0;
  std::int64_t halvings_before_ = 0;
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
  /// The sums of a block's slots, halved up to the present tick [s].
  const double* sums(int block) const {
    if (samples_.empty()) return this->block(block).remembered().data();
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
  double* sampled(const GainRule& rule);
  /// Counts one more step in every block.
  void add_step(const GainRule& rule);
  /// The present tick has another number of halvings.
  void fade(const GainRule& rule);

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
  /// Halves the samples of all blocks up to the present tick.
  void halve_samples(const GainRule& rule);

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
