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

/// A time that has no effect beside a step [s].
constexpr double kFaded_s = 0x1p-400;

/// Multiplies sums by a power of two.
ERGOCAST_VECTORIZED
void multiply(std::span<double> sums, double factor) {
  for (double& sum : sums) sum *= factor;
}

/// With a half-life any time up to a longest one is possible.
bool elapsed_is_possible(const Contribution& c, double dt_s, const HalfLife& half_life) {
  const double expected_s = static_cast<double>(c.steps) * dt_s;
  const double margin_s = expected_s * rounding_margin(c.steps);
  if (!half_life.any()) return std::abs(c.elapsed_s - expected_s) <= margin_s;
  return c.elapsed_s > 0 && c.elapsed_s <= expected_s + margin_s &&
         c.elapsed_s <= half_life.longest_memory_s(dt_s);
}

bool sums_are_possible(const Contribution& c, double dt_s, double range,
                       const HalfLife& half_life) {
  if (!elapsed_is_possible(c, dt_s, half_life)) return false;
  const double expected_s = half_life.any() ? c.elapsed_s : static_cast<double>(c.steps) * dt_s;
  const double margin_s = expected_s * rounding_margin(c.steps);
  // f_00 = 1, so S_00 is the time covered.
  if (c.block == 0 && !(std::abs(c.sums[0] - expected_s) <= margin_s)) return false;
  return c.sums.largest() <= range * (expected_s + margin_s);
}

/// Numbers that travelled in 16 bits may have been rounded up, but not beyond 1.
bool gains_are_possible(const Contribution& c, double dt_s, double range,
                        const HalfLife& half_life) {
  const double step_s = half_life.any() ? c.elapsed_s / static_cast<double>(c.steps) : dt_s;
  const double gained_s = static_cast<double>(c.gained_steps) * step_s;
  return c.gained_steps >= 0 && c.gained_steps <= c.steps &&
         c.gains.largest() <= range * gained_s * (1 + rounding_margin(c.steps));
}

}  // namespace

bool is_possible(const Contribution& theirs, double dt_s, double range, const HalfLife& half_life) {
  return sums_are_possible(theirs, dt_s, range, half_life) &&
         gains_are_possible(theirs, dt_s, range, half_life);
}

bool CoverageBlock::looks_like(const CoverageBlock& other) const {
  return steps_ == other.steps_ && remembered_steps_ == other.remembered_steps_ &&
         tick_ == other.tick_ && next_broadcast_tick_ == other.next_broadcast_tick_;
}

void CoverageBlock::replace(const Contribution& theirs, const GainRule& rule) {
  std::int64_t gained_steps = 0;
  if (theirs.encoding == ContributionEncoding::kFixed16) {
    announced_gains_ = theirs.gains;
    gained_steps = theirs.gained_steps;
    announced_time_steps_ = static_cast<double>(gained_steps);
    // The gains of a row that forgets are rates, times so many of its mean steps.
    if (rule.half_life.any())
      announced_time_steps_ *= theirs.elapsed_s / (static_cast<double>(theirs.steps) * rule.dt_s);
  } else if (rule.noted) {
    gained_steps = compare(theirs, rule);
  }
  replace_sums(theirs, rule);
  gained_steps_ = gained_steps;
}

void CoverageBlock::replace_sums(const Contribution& theirs, const GainRule& rule) {
  steps_ = theirs.steps;
  elapsed_s_ = theirs.elapsed_s;
  gained_steps_ = 0;
  sequence_ = theirs.header.sequence;
  tick_ = theirs.header.tick;
  next_broadcast_tick_ = theirs.next_broadcast_tick;
  range_ = theirs.range;
  sums_ = theirs.sums;
  fade(rule);
}

/// Sets the time that the sums cover at the present tick, where they have this factor.
void CoverageBlock::weigh(const GainRule& rule, double factor) {
  remembered_s_ = elapsed_s_ * factor;
  remembered_steps_ =
      rule.half_life.any() ? remembered_s_ / rule.dt_s : static_cast<double>(steps_);
}

void CoverageBlock::fade(const GainRule& rule) {
  const double factor = HalfLife::factor(rule.half_life.halvings(tick_), rule.halvings);
  weigh(rule, factor);
  faded_ = factor != 1 && steps_ > 0;
  faded_sums_ = faded_ ? sums_ : BlockSums();
  if (faded_) multiply(faded_sums_.edit(), factor);
  fade_before(rule.halvings);
}

void CoverageBlock::fade_before(std::int64_t halvings) {
  const double factor = HalfLife::factor(halvings_before_, halvings);
  halvings_before_ = halvings;
  if (factor == 1 || steps_before_ == 0) return;
  steps_before_ *= factor;
  multiply(sums_before_.edit(), factor);
}

double CoverageBlock::halve(const GainRule& rule) {
  const std::int64_t had = rule.half_life.halvings(tick_);
  if (had == rule.halvings) return 1;
  // A row that rests for ever fades no further than this: c_k stays a ratio of normal numbers.
  const double factor = elapsed_s_ < kFaded_s ? 1 : HalfLife::factor(had, rule.halvings);
  tick_ = rule.half_life.tick_of(rule.halvings);
  elapsed_s_ *= factor;
  weigh(rule, 1);
  return factor;
}

void CoverageBlock::add_step(const GainRule& rule) {
  ++steps_;
  if (rule.half_life.any()) elapsed_s_ += rule.dt_s;
  weigh(rule, 1);
}

/// Keeps the sums that `theirs` is compared with; returns the steps gained.
std::int64_t CoverageBlock::compare(const Contribution& theirs, const GainRule& rule) {
  // An agent that joined after this block was sent has no earlier block to compare with.
  const bool comparable = tick_ >= rule.joined;
  const std::int64_t steps = theirs.steps - (comparable ? steps_ : 0);
  sums_before_ = comparable ? std::move(sums_) : BlockSums();
  const double margin_s =
      static_cast<double>(theirs.steps) * rule.dt_s * rounding_margin(theirs.steps);
  double gained_s = static_cast<double>(steps) * rule.dt_s;
  if (rule.half_life.any()) {
    // Both as halved as theirs.
    steps_before_ = comparable ? elapsed_s_ / rule.dt_s : 0;
    halvings_before_ = rule.half_life.halvings(tick_);
    fade_before(rule.half_life.halvings(theirs.header.tick));
    gained_s = theirs.elapsed_s - steps_before_ * rule.dt_s;
    if (!(gained_s > 2 * margin_s)) return 0;
  } else {
    steps_before_ = comparable ? static_cast<double>(steps_) : 0;
  }
  const double most_s = rule.range * (gained_s + 2 * margin_s);
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

double* CoverageRow::sampled(const GainRule& rule) {
  if (samples_.empty()) {
    samples_.resize(blocks_.size() * static_cast<std::size_t>(block_size_));
    double* at = samples_.data();
    for (CoverageBlock& block : blocks_) {
      std::ranges::copy(block.sums(), at);
      block.forgo_gains();
      at += block_size_;
    }
    halve_samples(rule);
  }
  return samples_.data();
}

void CoverageRow::add_step(const GainRule& rule) {
  for (CoverageBlock& block : blocks_) block.add_step(rule);
  sum_up();
}

void CoverageRow::fade(const GainRule& rule) {
  if (!samples_.empty()) return halve_samples(rule);
  for (CoverageBlock& block : blocks_) block.fade(rule);
}

void CoverageRow::halve_samples(const GainRule& rule) {
  double* at = samples_.data();
  for (CoverageBlock& block : blocks_) {
    const double factor = block.halve(rule);
    if (factor != 1) multiply({at, static_cast<std::size_t>(block_size_)}, factor);
    at += block_size_;
  }
}

void CoverageRow::replace(const Contribution& theirs, const GainRule& rule) {
  CoverageBlock& block = blocks_[static_cast<std::size_t>(theirs.block)];
  if (samples_.empty()) {
    block.replace(theirs, rule);
  } else {
    std::ranges::copy(theirs.sums, samples_.data() + theirs.block * block_size_);
    block.replace_sums(theirs, rule);
    halve_samples(rule);
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
    const CoverageBlock& first = blocks_.front();
    return block.gained_steps() == first.gained_steps() &&
           block.gained_time_steps(true) == first.gained_time_steps(true) &&
           block.gained_time_steps(false) == first.gained_time_steps(false);
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
