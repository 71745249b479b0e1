// SPDX-License-Identifier: BSD-3-Clause
// Rows of blocks in one array: a block with more steps replaces one with fewer, and c_k adds the
// rows in ascending order.
#include "core/coverage_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/require.h"
#include "core/vectorized.h"

namespace ergocast {
namespace {

/// How far honest sums may be from steps·dt, relative: half an ulp for each addition, and room for
/// cosines by recurrence, which exceed 1 by about 3e-15.
double rounding_margin(std::int64_t steps) { return 1e-9 + static_cast<double>(steps) * 0x1p-53; }

static_assert(kBlockSize % kModesPerStride == 0, "reading so many never leaves a row");

/// Whether none of a block's |values| exceeds `limit`, and none is NaN.
ERGOCAST_VECTORIZED
bool all_within(const double* values, double limit) {
  std::int64_t beyond = 0;  // counted, because a loop with a way out is not vectorised
  for (std::size_t k = 0; k < kBlockSize; ++k) beyond += !(std::abs(values[k]) <= limit);
  return beyond == 0;
}

ERGOCAST_VECTORIZED
void subtract(const double* a, const double* b, double* difference) {
  for (std::size_t k = 0; k < kBlockSize; ++k) difference[k] = a[k] - b[k];
}

bool in_range(const Contribution& c, double dt_s) {
  const double expected_s = static_cast<double>(c.steps) * dt_s;
  const double margin_s = expected_s * rounding_margin(c.steps);
  if (!(std::abs(c.elapsed_s - expected_s) <= margin_s)) return false;
  // f_00 = 1, so S_00 is the time covered.
  if (c.block == 0 && !(std::abs(c.sums[0] - expected_s) <= margin_s)) return false;
  return all_within(c.sums.data(), expected_s + margin_s);
}

}  // namespace

CoverageTable::CoverageTable(const Basis& basis, double dt_s, Tick joined)
    : basis_(basis),
      dt_s_(dt_s),
      joined_(joined),
      block_count_((basis.mode_count() + kBlockSize - 1) / kBlockSize) {}

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
  return &*rows_.insert(
      at, Row{author, true, std::vector<Block>(blocks), std::vector<double>(blocks * kBlockSize),
              std::vector<double>(blocks * kBlockSize)});
}

void CoverageTable::add_row(const Author& author) {
  ERGOCAST_REQUIRE(find_or_add(author) != nullptr);
}

void CoverageTable::add_sample(const Author& author, const BasisAt& at) {
  Row* row = find_or_add(author);
  ERGOCAST_REQUIRE(row != nullptr);
  accumulate_basis(at, basis_, dt_s_, row->sums.data());
  for (Block& block : row->blocks) ++block.steps;
}

Merge CoverageTable::merge(const Contribution& theirs, std::int64_t max_steps) {
  if (theirs.mode_count != basis_.mode_count() || theirs.block < 0 ||
      theirs.block >= block_count_ || theirs.steps < 1 || theirs.steps > max_steps ||
      theirs.next_broadcast_tick < 0 || !in_range(theirs, dt_s_)) {
    return Merge::kRefusedRange;
  }
  Row* row = find_or_add(theirs.author());
  if (row == nullptr) return Merge::kRefusedLimit;
  Block& block = row->blocks[static_cast<std::size_t>(theirs.block)];
  if (theirs.steps <= block.steps) return Merge::kStale;
  const std::int64_t gained_steps = notes_gains_ ? take_gains(theirs, block, *row) : 0;
  block = {theirs.steps, theirs.next_broadcast_tick, theirs.header.sequence, theirs.header.tick,
           gained_steps};
  std::copy(theirs.sums.begin(), theirs.sums.end(), row->sums.begin() + theirs.block * kBlockSize);
  return Merge::kNewer;
}

/// Writes what `theirs` adds to the block held before; returns over how many steps, 0 if no agent
/// can have gained that in them.
std::int64_t CoverageTable::take_gains(const Contribution& theirs, const Block& before,
                                       Row& row) const {
  const bool comparable = before.tick >= joined_;
  const std::int64_t steps = theirs.steps - (comparable ? before.steps : 0);
  const double margin_s = static_cast<double>(theirs.steps) * dt_s_ * rounding_margin(theirs.steps);
  const double most_s = static_cast<double>(steps) * dt_s_ + 2 * margin_s;
  const std::ptrdiff_t first = std::ptrdiff_t{theirs.block} * kBlockSize;
  double* gains = row.gains.data() + first;
  if (comparable) {
    subtract(theirs.sums.data(), row.sums.data() + first, gains);
  } else {
    std::copy(theirs.sums.begin(), theirs.sums.end(), gains);
  }
  return all_within(gains, most_s) ? steps : 0;
}

CoverageTable::BlockView CoverageTable::view(std::size_t row, int block) const {
  const Row& one = rows_[row];
  const Block& held = one.blocks[static_cast<std::size_t>(block)];
  const std::ptrdiff_t first = std::ptrdiff_t{block} * kBlockSize;
  return {one.sums.data() + first,
          one.gains.data() + first,
          held.steps,
          held.gained_steps,
          held.tick,
          held.next_broadcast_tick - held.tick};
}

bool CoverageTable::Block::looks_like(const Block& other) const {
  return steps == other.steps && gained_steps == other.gained_steps && tick == other.tick &&
         next_broadcast_tick == other.next_broadcast_tick;
}

bool CoverageTable::blocks_alike(std::size_t row) const {
  const auto& blocks = rows_[row].blocks;
  return std::all_of(blocks.begin() + 1, blocks.end(),
                     [&](const Block& block) { return block.looks_like(blocks.front()); });
}

Contribution CoverageTable::block(const Author& author, int block) const {
  Contribution out;
  out.header.sender = author.agent;
  out.header.incarnation = author.incarnation;
  out.block = block;
  out.mode_count = basis_.mode_count();
  if (const Row* row = find(author)) {
    const Block& held = row->blocks[static_cast<std::size_t>(block)];
    out.header.sequence = held.sequence;
    out.header.tick = held.tick;
    out.steps = held.steps;
    out.next_broadcast_tick = held.next_broadcast_tick;
    out.elapsed_s = static_cast<double>(held.steps) * dt_s_;
    std::copy_n(row->sums.begin() + block * kBlockSize, kBlockSize, out.sums.begin());
  }
  return out;
}

void CoverageTable::forget(const Author& author) {
  if (Row* row = find_or_add(author)) row->counts = false;
}

void CoverageTable::remember(const Author& author) {
  // An unknown author counts when its first block arrives.
  if (find(author) != nullptr) find_or_add(author)->counts = true;
}

ERGOCAST_VECTORIZED
void CoverageTable::average(Coefficients& coverage) const {
  for (int b = 0; b < block_count_; ++b) {
    std::int64_t steps = 0;
    for (const Row& row : rows_) {
      if (row.counts) steps += row.blocks[static_cast<std::size_t>(b)].steps;
    }
    const double per_second = steps > 0 ? 1 / (static_cast<double>(steps) * dt_s_) : 0;
    const int end = std::min((b + 1) * kBlockSize, basis_.mode_count());
    for (int first = b * kBlockSize; first < end; first += kModesPerStride) {
      std::array<double, kModesPerStride> team{};
      for (const Row& row : rows_) {
        if (!row.counts) continue;
        const double* sums = row.sums.data() + first;
        for (int k = 0; k < kModesPerStride; ++k) team[k] += sums[k];
      }
      double* out = coverage.data() + first;
      const int count = std::min(kModesPerStride, end - first);
      for (int k = 0; k < count; ++k) out[k] = team[k] * per_second;
    }
  }
}

std::int64_t CoverageTable::Row::min_steps() const {
  std::int64_t fewest = blocks.front().steps;
  for (const Block& block : blocks) fewest = std::min(fewest, block.steps);
  return fewest;
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
  return row == nullptr ? std::nullopt : std::optional(row->min_steps());
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

CoverageTable::RowSummary CoverageTable::Row::holding() const {
  return {author, min_steps(), max_steps(), announced_period(), state_hash()};
}

CoverageTable::RowSummary CoverageTable::holding(std::size_t i) const { return rows_[i].holding(); }

CoverageTable::RowSummary CoverageTable::holding(const Author& author) const {
  const Row* row = find(author);
  return row == nullptr ? RowSummary{author, 0, 0, 0, 0} : row->holding();
}

const double* CoverageTable::sums_of(const Author& author) const {
  const Row* row = find(author);
  return row == nullptr ? nullptr : row->sums.data();
}

double CoverageTable::covered_s() const {
  std::int64_t steps = 0;
  for (const Row& row : rows_) {
    if (row.counts) steps += row.blocks.front().steps;
  }
  return static_cast<double>(steps) * dt_s_;
}

bool CoverageTable::holds_due(const Author& author, Tick tick) const {
  const Row* row = find(author);
  return row != nullptr && std::all_of(row->blocks.begin(), row->blocks.end(), [&](const Block& b) {
           return b.steps > 0 && b.next_broadcast_tick > tick;
         });
}

}  // namespace ergocast
