// SPDX-License-Identifier: BSD-3-Clause
// Replaces blocks by newer ones, and finds what each has gained when it arrives.
#include "core/law/coverage_row.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/vectorized.h"

namespace ergocast {
namespace {

/// How far honest sums may be from steps·dt, relative: half an ulp for each addition, and room for
/// cosines by recurrence, which exceed 1 by about 3e-15.
double rounding_margin(std::int64_t steps) { return 1e-9 + static_cast<double>(steps) * 0x1p-53; }

/// Whether no sum of a block has changed by more than `limit`.
ERGOCAST_VECTORIZED
bool gains_within(std::span<const double> sums, const double* before, double limit) {
  std::int64_t beyond = 0;  // counted, because a loop with an early exit is not vectorised
  for (std::size_t k = 0; k < sums.size(); ++k) {
    beyond += !(std::abs(sums[k] - before[k]) <= limit);
  }
  return beyond == 0;
}

bool sums_are_possible(const Contribution& c, double dt_s, double range) {
  const double expected_s = static_cast<double>(c.steps) * dt_s;
  const double margin_s = expected_s * rounding_margin(c.steps);
  if (!(std::abs(c.elapsed_s - expected_s) <= margin_s)) return false;
  // f_00 = 1, so S_00 is the time covered.
  if (c.block == 0 && !(std::abs(c.sums[0] - expected_s) <= margin_s)) return false;
  return c.sums.largest() <= range * (expected_s + margin_s);
}

/// Numbers that travelled in 16 bits may have been rounded up, but not beyond 1.
bool gains_are_possible(const Contribution& c, double dt_s, double range) {
  const double gained_s = static_cast<double>(c.gained_steps) * dt_s;
  return c.gained_steps >= 0 && c.gained_steps <= c.steps &&
         c.gains.largest() <= range * gained_s * (1 + rounding_margin(c.steps));
}

}  // namespace

bool is_possible(const Contribution& theirs, double dt_s, double range) {
  return sums_are_possible(theirs, dt_s, range) && gains_are_possible(theirs, dt_s, range);
}

bool CoverageBlock::looks_like(const CoverageBlock& other) const {
  return steps_ == other.steps_ && tick_ == other.tick_ &&
         next_broadcast_tick_ == other.next_broadcast_tick_;
}

void CoverageBlock::replace(const Contribution& theirs, const GainRule& rule) {
  std::int64_t gained_steps = 0;
  if (theirs.encoding == ContributionEncoding::kFixed16) {
    announced_gains_ = theirs.gains;
    gained_steps = theirs.gained_steps;
  } else if (rule.noted) {
    gained_steps = compare(theirs, rule);
  }
  replace(theirs);
  gained_steps_ = gained_steps;
}

void CoverageBlock::replace(const Contribution& theirs) {
  steps_ = theirs.steps;
  gained_steps_ = 0;
  sequence_ = theirs.header.sequence;
  tick_ = theirs.header.tick;
  next_broadcast_tick_ = theirs.next_broadcast_tick;
  range_ = theirs.range;
  sums_ = theirs.sums;
}

/// Keeps the sums that `theirs` is compared with; returns the steps gained.
std::int64_t CoverageBlock::compare(const Contribution& theirs, const GainRule& rule) {
  // An agent that joined after this block was sent has no earlier block to compare with.
  const bool comparable = tick_ >= rule.joined;
  const std::int64_t steps = theirs.steps - (comparable ? steps_ : 0);
  sums_before_ = comparable ? std::move(sums_) : BlockSums();
  const double margin_s =
      static_cast<double>(theirs.steps) * rule.dt_s * rounding_margin(theirs.steps);
  const double most_s = rule.range * (static_cast<double>(steps) * rule.dt_s + 2 * margin_s);
  return gains_within(theirs.sums, sums_before_.data(), most_s) ? steps : 0;
}

void CoverageBlock::write_header(Contribution& out) const {
  out.header.sequence = sequence_;
  out.header.tick = tick_;
  out.steps = steps_;
  out.next_broadcast_tick = next_broadcast_tick_;
  out.range = range_;
}

CoverageRow::CoverageRow(const Author& author, const BlockLayout& layout)
    : author_(author),
      block_size_(layout.block_size()),
      blocks_(static_cast<std::size_t>(layout.block_count())) {}

double* CoverageRow::sampled() {
  if (samples_.empty()) {
    samples_.resize(blocks_.size() * static_cast<std::size_t>(block_size_));
    double* at = samples_.data();
    for (CoverageBlock& block : blocks_) {
      std::ranges::copy(block.sums(), at);
      block.forgo_gains();
      at += block_size_;
    }
  }
  return samples_.data();
}

void CoverageRow::add_step() {
  for (CoverageBlock& block : blocks_) block.add_step();
  sum_up();
}

void CoverageRow::replace(const Contribution& theirs, const GainRule& rule) {
  CoverageBlock& block = blocks_[static_cast<std::size_t>(theirs.block)];
  if (samples_.empty()) {
    block.replace(theirs, rule);
  } else {
    std::ranges::copy(theirs.sums, samples_.data() + theirs.block * block_size_);
    block.replace(theirs);
  }
  sum_up();
}

void CoverageRow::postpone(const Contribution& theirs) {
  blocks_[static_cast<std::size_t>(theirs.block)].postpone(theirs.next_broadcast_tick);
  sum_up();
}

void CoverageRow::write(Contribution& out, std::size_t size) const {
  const CoverageBlock& held = block(out.block);
  held.write_header(out);
  if (!samples_.empty()) {
    std::copy_n(sums(out.block), size, out.sums.set_all(size).begin());
    return;
  }
  out.sums = held.sums();
  if (out.encoding != ContributionEncoding::kFixed16) return;
  out.gains = held.announced_gains();
  out.gained_steps = held.gained_steps();
}

void CoverageRow::sum_up() {
  fewest_steps_ = blocks_.front().steps();
  due_tick_ = std::numeric_limits<Tick>::max();
  for (const CoverageBlock& block : blocks_) {
    fewest_steps_ = std::min(fewest_steps_, block.steps());
    due_tick_ = std::min(due_tick_, block.due_tick());
  }
}

bool CoverageRow::uniform_blocks() const {
  return std::all_of(blocks_.begin() + 1, blocks_.end(),
                     [&](const CoverageBlock& block) { return block.looks_like(blocks_.front()); });
}

bool CoverageRow::uniform_gains() const {
  return std::all_of(blocks_.begin() + 1, blocks_.end(), [&](const CoverageBlock& block) {
    return block.gained_steps() == blocks_.front().gained_steps();
  });
}

Tick CoverageRow::announced_period() const {
  Tick longest = 0;
  for (const CoverageBlock& block : blocks_) longest = std::max(longest, block.period());
  return longest;
}

CoverageRow::Summary CoverageRow::summary() const {
  std::int64_t newest_steps = 0;
  std::uint64_t state_hash = 0;
  for (const CoverageBlock& block : blocks_) {
    newest_steps = std::max(newest_steps, block.steps());
    state_hash = (state_hash ^ static_cast<std::uint64_t>(block.steps())) * 0x9e3779b97f4a7c15;
    state_hash ^= state_hash >> 32;
  }
  return {author_, fewest_steps_, newest_steps, announced_period(), state_hash};
}

}  // namespace ergocast
