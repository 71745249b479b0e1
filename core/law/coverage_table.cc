// SPDX-License-Identifier: BSD-3-Clause
// Rows of blocks in one array: a block with more steps replaces one with fewer, and c_k adds the
// rows in ascending order.
#include "core/law/coverage_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/base/require.h"
#include "core/base/vectorized.h"

namespace ergocast {
namespace {

/// How far honest sums may be from steps·dt, relative: half an ulp for each addition, and room for
/// cosines by recurrence, which exceed 1 by about 3e-15.
double rounding_margin(std::int64_t steps) { return 1e-9 + static_cast<double>(steps) * 0x1p-53; }

static_assert(kBlockSize % kModesPerStride == 0 && kMostBlockSize % kModesPerStride == 0,
              "reading so many never leaves a row");
static_assert(kLowModes % kModesPerStride == 0);

/// Whether no sum of a block has changed by more than `limit`.
ERGOCAST_VECTORIZED
bool gains_within(std::span<const double> sums, const double* before, double limit) {
  std::int64_t beyond = 0;  // counted, because a loop with an early exit is not vectorised
  for (std::size_t k = 0; k < sums.size(); ++k) {
    beyond += !(std::abs(sums[k] - before[k]) <= limit);
  }
  return beyond == 0;
}

/// out = Σ rows · per_second, for the first `modes` modes of a block.
ERGOCAST_VECTORIZED
void average_rows(std::span<const double* const> rows, int modes, double per_second, double* out) {
  for (int first = 0; first < modes; first += kModesPerStride) {
    std::array<double, kModesPerStride> team{};
    for (const double* row : rows) {
      for (int k = 0; k < kModesPerStride; ++k) team[k] += row[first + k];
    }
    const int count = std::min(kModesPerStride, modes - first);
    for (int k = 0; k < count; ++k) out[first + k] = team[k] * per_second;
  }
}

/// out = Σ q rows · per_second.
ERGOCAST_VECTORIZED
void average_weighted(std::span<const double* const> rows, const double* qualities, int modes,
                      double per_second, double* out) {
  for (int first = 0; first < modes; first += kModesPerStride) {
    std::array<double, kModesPerStride> team{};
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (int k = 0; k < kModesPerStride; ++k) team[k] += qualities[row] * rows[row][first + k];
    }
    const int count = std::min(kModesPerStride, modes - first);
    for (int k = 0; k < count; ++k) out[first + k] = team[k] * per_second;
  }
}

/// Numbers that travelled in 16 bits may have been rounded up, but not beyond 1.
bool gains_in_range(const Contribution& c, double dt_s) {
  const double gained_s = static_cast<double>(c.gained_steps) * dt_s;
  return c.gained_steps >= 0 && c.gained_steps <= c.steps &&
         c.gains.largest() <= gained_s * (1 + rounding_margin(c.steps));
}

bool in_range(const Contribution& c, double dt_s) {
  const double expected_s = static_cast<double>(c.steps) * dt_s;
  const double margin_s = expected_s * rounding_margin(c.steps);
  if (!(std::abs(c.elapsed_s - expected_s) <= margin_s)) return false;
  // f_00 = 1, so S_00 is the time covered.
  if (c.block == 0 && !(std::abs(c.sums[0] - expected_s) <= margin_s)) return false;
  return c.sums.largest() <= expected_s + margin_s;
}

}  // namespace

CoverageTable::CoverageTable(const Basis& basis, double dt_s, Tick joined)
    : basis_(basis),
      dt_s_(dt_s),
      joined_(joined),
      layout_(basis, ContributionEncoding::kDouble),
      block_count_(layout_.block_count()) {}

void CoverageTable::set_layout(const BlockLayout& layout) {
  ERGOCAST_REQUIRE(rows_.empty());
  layout_ = layout;
  block_size_ = layout.block_size();
  block_count_ = layout.block_count();
  if (layout.in_basis_order()) return;
  by_mode_.resize(static_cast<std::size_t>(basis_.mode_count()));
  by_slot_.resize(static_cast<std::size_t>(layout.slot_count()));
}

CoverageTable::Row* CoverageTable::find(const Author& author) {
  return const_cast<Row*>(static_cast<const CoverageTable&>(*this).find(author));
}

const CoverageTable::Row* CoverageTable::find(const Author& author) const {
  const auto at = std::lower_bound(rows_.begin(), rows_.end(), author,
                                   [](const Row& row, const Author& a) { return row.author < a; });
  return at != rows_.end() && at->author == author ? &*at : nullptr;
}

CoverageTable::Row* CoverageTable::find_or_add(const Author& author) {
  auto at = std::lower_bound(rows_.begin(), rows_.end(), author,
                             [](const Row& row, const Author& a) { return row.author < a; });
  if (at != rows_.end() && at->author == author) return &*at;
  const auto incarnations = std::count_if(
      rows_.begin(), rows_.end(), [&](const Row& row) { return row.author.agent == author.agent; });
  if (incarnations >= kMaxIncarnationsPerAgent) return nullptr;
  if (author.agent < 0 || author.agent >= kMaxAgents) return nullptr;
  const auto blocks = static_cast<std::size_t>(block_count_);
  counted_.resize(rows_.size() + 1);
  qualities_.resize(rows_.size() + 1);
  return &*rows_.insert(at, Row{author, true, 0, kNeverSent, std::vector<Block>(blocks), {}, 1});
}

void CoverageTable::add_row(const Author& author) {
  ERGOCAST_REQUIRE(find_or_add(author) != nullptr);
}

void CoverageTable::set_quality(const Author& author, double quality) {
  Row* const row = find(author);
  if (row == nullptr) return;
  row->quality = quality;
  weighted_ = weighted_ || quality != 1;
}

void CoverageTable::add_sample(const Author& author, const BasisAt& at, const double* footprint) {
  Row* row = find_or_add(author);
  ERGOCAST_REQUIRE(row != nullptr);
  if (row->samples.empty()) {
    const auto size = static_cast<std::size_t>(block_size_);
    row->samples.resize(row->blocks.size() * size);
    for (std::size_t b = 0; b < row->blocks.size(); ++b) {
      std::ranges::copy(row->blocks[b].sums, row->samples.data() + b * size);
      row->blocks[b].gained_steps = 0;
    }
  }
  if (!layout_.in_basis_order()) {
    add_in_slots(at, footprint, row->samples.data());
  } else if (footprint == nullptr) {
    accumulate_basis(at, basis_, dt_s_, row->samples.data());
  } else {
    accumulate_basis(at, basis_, dt_s_, footprint, row->samples.data());
  }
  for (Block& block : row->blocks) ++block.steps;
  row->sum_up();
}

/// The same additions, each in its slot.
void CoverageTable::add_in_slots(const BasisAt& at, const double* footprint, double* samples) {
  set_basis(at, basis_, dt_s_, by_mode_.data());
  for (std::size_t k = 0; footprint != nullptr && k < by_mode_.size(); ++k)
    by_mode_[k] *= footprint[k];
  layout_.to_slots(by_mode_.data(), by_slot_.data());
  for (int b = 0; b < block_count_; ++b) {
    const auto [first, count] = layout_.slots_of(b);
    for (int slot = first; slot < first + count; ++slot)
      samples[slot] += by_slot_[static_cast<std::size_t>(slot)];
  }
}

bool CoverageTable::has_size(const Contribution& theirs) const {
  return theirs.sums.size() == static_cast<std::size_t>(layout_.size_of(theirs.block));
}

Merge CoverageTable::merge(const Contribution& theirs, std::int64_t max_steps) {
  if (theirs.encoding != layout_.encoding()) return Merge::kRefusedEncoding;
  if (theirs.mode_count != basis_.mode_count() || theirs.block < 0 ||
      theirs.block >= block_count_ || theirs.steps < 1 || theirs.steps > max_steps ||
      theirs.next_broadcast_tick < 0 || !has_size(theirs) || !in_range(theirs, dt_s_) ||
      !gains_in_range(theirs, dt_s_)) {
    return Merge::kRefusedRange;
  }
  Row* row = find_or_add(theirs.author());
  if (row == nullptr) return Merge::kRefusedLimit;
  const auto number = static_cast<std::size_t>(theirs.block);
  Block& block = row->blocks[number];
  if (theirs.steps <= block.steps) return Merge::kStale;
  if (!row->samples.empty()) {
    const auto size = static_cast<std::size_t>(block_size_);
    std::ranges::copy(theirs.sums, row->samples.data() + number * size);
    block.gained_steps = 0;
  } else if (layout_.encoding() == ContributionEncoding::kFixed16) {
    block.sums_before = theirs.gains;
    block.gained_steps = theirs.gained_steps;
  } else if (notes_gains_) {
    // An agent that joined after this block was sent has no earlier block to compare with.
    const bool comparable = block.tick >= joined_;
    block.steps_before = comparable ? block.steps : 0;
    block.sums_before = comparable ? std::move(block.sums) : BlockSums();
    block.gained_steps = kNotCompared;
  } else {
    block.gained_steps = 0;
  }
  block.steps = theirs.steps;
  block.next_broadcast_tick = theirs.next_broadcast_tick;
  block.sequence = theirs.header.sequence;
  block.tick = theirs.header.tick;
  block.sums = theirs.sums;
  row->sum_up();
  return Merge::kNewer;
}

const double* CoverageTable::Row::sums(std::size_t block, int block_size) const {
  if (samples.empty()) return blocks[block].sums.data();
  return samples.data() + block * static_cast<std::size_t>(block_size);
}

CoverageTable::BlockView CoverageTable::view(std::size_t row, int block) const {
  const Row& one = rows_[row];
  const auto number = static_cast<std::size_t>(block);
  const Block& held = one.blocks[number];
  return {one.sums(number, block_size_), held.steps, held.tick,
          held.next_broadcast_tick - held.tick};
}

/// The number of steps over which a block has gained; 0 if no agent can gain that much in them.
std::int64_t CoverageTable::gained_steps(const Block& block) const {
  if (block.gained_steps != kNotCompared) return block.gained_steps;
  const std::int64_t steps = block.steps - block.steps_before;
  const double margin_s = static_cast<double>(block.steps) * dt_s_ * rounding_margin(block.steps);
  const double most_s = static_cast<double>(steps) * dt_s_ + 2 * margin_s;
  const bool possible = gains_within(block.sums, block.sums_before.data(), most_s);
  return block.gained_steps = possible ? steps : 0;
}

CoverageTable::Gains CoverageTable::gains(std::size_t row, int block) const {
  const Block& held = rows_[row].blocks[static_cast<std::size_t>(block)];
  const std::int64_t steps = notes_gains_ ? gained_steps(held) : 0;
  if (layout_.encoding() == ContributionEncoding::kFixed16)
    return {nullptr, held.sums_before.data(), steps};
  return {held.sums_before.data(), nullptr, steps};
}

bool CoverageTable::Block::looks_like(const Block& other) const {
  return steps == other.steps && tick == other.tick &&
         next_broadcast_tick == other.next_broadcast_tick;
}

bool CoverageTable::uniform_blocks(std::size_t row) const {
  const auto& blocks = rows_[row].blocks;
  return std::all_of(blocks.begin() + 1, blocks.end(),
                     [&](const Block& block) { return block.looks_like(blocks.front()); });
}

bool CoverageTable::uniform_gains(std::size_t row) const {
  const auto& blocks = rows_[row].blocks;
  return std::all_of(blocks.begin() + 1, blocks.end(), [&](const Block& block) {
    return gained_steps(block) == gained_steps(blocks.front());
  });
}

Contribution CoverageTable::block(const Author& author, int block) const {
  Contribution out;
  out.header.sender = author.agent;
  out.header.incarnation = author.incarnation;
  out.block = block;
  out.mode_count = basis_.mode_count();
  out.encoding = layout_.encoding();
  if (const Row* row = find(author)) {
    const Block& held = row->blocks[static_cast<std::size_t>(block)];
    out.header.sequence = held.sequence;
    out.header.tick = held.tick;
    out.steps = held.steps;
    out.next_broadcast_tick = held.next_broadcast_tick;
    out.elapsed_s = static_cast<double>(held.steps) * dt_s_;
    if (row->samples.empty()) {
      out.sums = held.sums;
    } else {
      const auto size = static_cast<std::size_t>(layout_.size_of(block));
      std::copy_n(row->sums(static_cast<std::size_t>(block), block_size_), size,
                  out.sums.set_all(size).begin());
    }
    if (layout_.encoding() == ContributionEncoding::kFixed16 && row->samples.empty()) {
      out.gains = held.sums_before;
      out.gained_steps = held.gained_steps;
    }
  }
  return out;
}

void CoverageTable::forget(const Author& author) {
  if (Row* row = find_or_add(author)) row->counts = false;
}

void CoverageTable::remember_all() {
  for (Row& row : rows_) row.counts = true;
}

void CoverageTable::average(Coefficients& coverage) const {
  if (layout_.in_basis_order()) return average_slots(coverage.data());
  average_slots(by_slot_.data());
  layout_.from_slots(by_slot_.data(), coverage.data());
}

void CoverageTable::average_slots(double* coverage) const {
  for (int b = 0; b < block_count_; ++b) {
    const auto number = static_cast<std::size_t>(b);
    double steps = 0;  // each with its quality
    std::size_t count = 0;
    for (const Row& row : rows_) {
      if (!row.counts) continue;
      steps += row.quality * static_cast<double>(row.blocks[number].steps);
      qualities_[count] = row.quality;
      counted_[count++] = row.sums(number, block_size_);
    }
    const double per_second = steps > 0 ? 1 / (steps * dt_s_) : 0;
    const auto [first, modes] = layout_.slots_of(b);
    const std::span<const double* const> rows(counted_.data(), count);
    if (weighted_) {
      average_weighted(rows, qualities_.data(), modes, per_second, coverage + first);
    } else {
      average_rows(rows, modes, per_second, coverage + first);
    }
  }
}

void CoverageTable::Row::sum_up() {
  fewest_steps = blocks.front().steps;
  due_tick = std::numeric_limits<Tick>::max();
  for (const Block& block : blocks) {
    fewest_steps = std::min(fewest_steps, block.steps);
    due_tick = std::min(due_tick, block.steps > 0 ? block.next_broadcast_tick : kNeverSent);
  }
}

Tick CoverageTable::Row::announced_period() const {
  Tick longest = 0;
  for (const Block& block : blocks) {
    longest = std::max(longest, block.next_broadcast_tick - block.tick);
  }
  return longest;
}

Tick CoverageTable::announced_period(const Author& author) const {
  const Row* row = find(author);
  return row == nullptr ? 0 : row->announced_period();
}

std::optional<std::int64_t> CoverageTable::steps_held(const Author& author) const {
  const Row* row = find(author);
  return row == nullptr ? std::nullopt : std::optional(row->fewest_steps);
}

std::int64_t CoverageTable::Row::max_steps() const {
  std::int64_t most = 0;
  for (const Block& block : blocks) most = std::max(most, block.steps);
  return most;
}

std::uint64_t CoverageTable::Row::state_hash() const {
  std::uint64_t state_hash = 0;
  for (const Block& block : blocks) {
    state_hash = (state_hash ^ static_cast<std::uint64_t>(block.steps)) * 0x9e3779b97f4a7c15;
    state_hash ^= state_hash >> 32;
  }
  return state_hash;
}

CoverageTable::RowSummary CoverageTable::Row::summary_of() const {
  return {author, fewest_steps, max_steps(), announced_period(), state_hash()};
}

CoverageTable::RowSummary CoverageTable::summary_of(std::size_t i) const {
  return rows_[i].summary_of();
}

CoverageTable::RowSummary CoverageTable::summary_of(const Author& author) const {
  const Row* row = find(author);
  return row == nullptr ? RowSummary{author, 0, 0, 0, 0} : row->summary_of();
}

const double* CoverageTable::sums_of(const Author& author) const {
  const Row* row = find(author);
  ERGOCAST_REQUIRE(row != nullptr && !row->samples.empty());
  return row->samples.data();
}

double CoverageTable::covered_s() const {
  double steps = 0;
  for (const Row& row : rows_) {
    if (row.counts) steps += row.quality * static_cast<double>(row.blocks.front().steps);
  }
  return steps * dt_s_;
}

bool CoverageTable::holds_due(const Author& author, Tick tick) const {
  const Row* row = find(author);
  return row != nullptr && row->due_tick > tick;
}

}  // namespace ergocast
