// SPDX-License-Identifier: BSD-3-Clause
// Rows of blocks in one array: a block with more steps replaces one with fewer, and c_k adds the
// rows in ascending order.
#include "core/law/coverage_table.h"

#include <algorithm>
#include <array>
#include <span>

#include "core/base/require.h"
#include "core/base/vectorized.h"

namespace ergocast {
namespace {

static_assert(kBlockSize % kModesPerStride == 0 && kMostBlockSize % kModesPerStride == 0,
              "reading so many never leaves a row");
static_assert(kLowModes % kModesPerStride == 0);

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

}  // namespace

CoverageTable::CoverageTable(const Basis& basis, double dt_s, Tick joined)
    : basis_(basis),
      layout_(basis, ContributionEncoding::kDouble),
      gain_rule_{.dt_s = dt_s, .joined = joined} {}

void CoverageTable::set_half_life(const HalfLife& half_life) {
  ERGOCAST_REQUIRE(rows_.empty());
  gain_rule_.half_life = half_life;
}

void CoverageTable::set_now(Tick counted) {
  // An agent that learns late of a pause counts a tick again. Samples that were halved stay so.
  const std::int64_t halvings = gain_rule_.half_life.halvings(counted);
  if (halvings <= gain_rule_.halvings) return;
  gain_rule_.halvings = halvings;
  for (CoverageRow& row : rows_) row.fade(gain_rule_);
}

void CoverageTable::set_layout(const BlockLayout& layout) {
  ERGOCAST_REQUIRE(rows_.empty());
  layout_ = layout;
  if (layout.in_basis_order()) return;
  scratch_.by_mode.resize(static_cast<std::size_t>(basis_.mode_count()));
  scratch_.by_slot.resize(static_cast<std::size_t>(layout.slot_count()));
}

/// Where the row of `author` is, or would be.
std::size_t CoverageTable::place_of(const Author& author) const {
  // Each message needs it. With a projection to author() it takes almost twice as long.
  const auto at = std::lower_bound(
      rows_.begin(), rows_.end(), author,
      [](const CoverageRow& row, const Author& wanted) { return row.author() < wanted; });
  return static_cast<std::size_t>(at - rows_.begin());
}

const CoverageRow* CoverageTable::find(const Author& author) const {
  const std::size_t at = place_of(author);
  return at < rows_.size() && rows_[at].author() == author ? &rows_[at] : nullptr;
}

CoverageRow* CoverageTable::find(const Author& author) {
  const std::size_t at = place_of(author);
  return at < rows_.size() && rows_[at].author() == author ? &rows_[at] : nullptr;
}

/// Null if the table has no room for another row.
CoverageRow* CoverageTable::find_or_add(const Author& author) {
  const std::size_t at = place_of(author);
  if (at < rows_.size() && rows_[at].author() == author) return &rows_[at];
  const auto incarnations = std::ranges::count_if(
      rows_, [&](const CoverageRow& row) { return row.author().agent == author.agent; });
  if (incarnations >= kMaxIncarnationsPerAgent) return nullptr;
  if (author.agent < 0 || author.agent >= kMostAgentsOfSites) return nullptr;
  scratch_.counted.resize(rows_.size() + 1);
  scratch_.qualities.resize(rows_.size() + 1);
  return &*rows_.insert(rows_.begin() + static_cast<std::ptrdiff_t>(at),
                        CoverageRow(author, layout_));
}

void CoverageTable::add_row(const Author& author) {
  ERGOCAST_REQUIRE(find_or_add(author) != nullptr);
}

void CoverageTable::set_quality(const Author& author, double quality) {
  CoverageRow* const row = find(author);
  if (row == nullptr) return;
  row->set_quality(quality);
  weighted_ = weighted_ || quality != 1;
}

void CoverageTable::add_sample(const Author& author, const BasisAt& at, const double* footprint) {
  CoverageRow* const row = find_or_add(author);
  ERGOCAST_REQUIRE(row != nullptr);
  double* const samples = row->sampled(gain_rule_);
  if (!layout_.in_basis_order()) {
    add_in_slots(at, footprint, samples);
  } else if (footprint == nullptr) {
    accumulate_basis(at, basis_, gain_rule_.dt_s, samples);
  } else {
    accumulate_basis(at, basis_, gain_rule_.dt_s, footprint, samples);
  }
  row->add_step(gain_rule_);
}

void CoverageTable::shift_sample(const Author& author, const double* shift) {
  CoverageRow* const row = find(author);
  ERGOCAST_REQUIRE(row != nullptr && allows_shifts());
  double* const samples = row->sampled(gain_rule_);
  for (int slot = 0; slot < layout_.slot_count(); ++slot)
    samples[slot] -= shift[slot] * gain_rule_.dt_s;
}

/// The same additions, each in its slot.
void CoverageTable::add_in_slots(const BasisAt& at, const double* footprint, double* samples) {
  auto& by_mode = scratch_.by_mode;
  set_basis(at, basis_, gain_rule_.dt_s, by_mode.data());
  for (std::size_t k = 0; footprint != nullptr && k < by_mode.size(); ++k)
    by_mode[k] *= footprint[k];
  layout_.to_slots(by_mode.data(), scratch_.by_slot.data());
  for (int b = 0; b < block_count(); ++b) {
    const auto [first, count] = layout_.slots_of(b);
    for (int slot = first; slot < first + count; ++slot)
      samples[slot] += scratch_.by_slot[static_cast<std::size_t>(slot)];
  }
}

/// Whether a block of the table's encoding has one of its places and that block's length.
bool CoverageTable::fits(const Contribution& theirs) const {
  return theirs.mode_count == basis_.mode_count() && theirs.block >= 0 &&
         theirs.block < block_count() &&
         theirs.sums.size() == static_cast<std::size_t>(layout_.size_of(theirs.block));
}

Merge CoverageTable::merge(const Contribution& theirs, std::int64_t max_steps) {
  if (theirs.encoding != layout_.encoding()) return Merge::kRefusedEncoding;
  if (theirs.steps < 1 || theirs.steps > max_steps || theirs.next_broadcast_tick < 0 ||
      !fits(theirs) || !is_possible(theirs, gain_rule_.dt_s, kShiftedRange, gain_rule_.half_life)) {
    return Merge::kRefusedRange;
  }
  if (!is_possible(theirs, gain_rule_.dt_s, gain_rule_.range, gain_rule_.half_life))
    return Merge::kRefusedShift;
  // Only a simulation has more agents, and it merges nothing.
  if (theirs.author().agent >= kMaxAgents) return Merge::kRefusedLimit;
  CoverageRow* const row = find_or_add(theirs.author());
  if (row == nullptr) return Merge::kRefusedLimit;
  const CoverageBlock& held = row->block(theirs.block);
  if (theirs.steps == held.steps()) row->postpone(theirs);
  if (theirs.steps <= held.steps()) return Merge::kStale;
  row->replace(theirs, gain_rule_);
  return Merge::kNewer;
}

CoverageTable::Gains CoverageTable::gains(std::size_t row, int block) const {
  const CoverageBlock& held = rows_[row].block(block);
  const std::int64_t steps = gain_rule_.noted ? held.gained_steps() : 0;
  if (layout_.encoding() == ContributionEncoding::kFixed16)
    return {nullptr, held.announced_gains().data(), steps, held.gained_time_steps(true)};
  return {held.sums_before().data(), nullptr, steps, held.gained_time_steps(false)};
}

Contribution CoverageTable::block(const Author& author, int block) const {
  Contribution out;
  out.header.sender = author.agent;
  out.header.incarnation = author.incarnation;
  out.block = block;
  out.mode_count = basis_.mode_count();
  out.encoding = layout_.encoding();
  if (const CoverageRow* row = find(author)) {
    row->write(out, static_cast<std::size_t>(layout_.size_of(block)));
    if (!row->samples().empty() && allows_shifts()) out.range = kShiftedRange;
    out.elapsed_s = gain_rule_.half_life.any() ? row->block(block).elapsed_s()
                                               : static_cast<double>(out.steps) * gain_rule_.dt_s;
  }
  return out;
}

void CoverageTable::forget(const Author& author) {
  if (CoverageRow* row = find_or_add(author)) row->set_counts(false);
}

void CoverageTable::remember_all() {
  for (CoverageRow& row : rows_) row.set_counts(true);
}

void CoverageTable::average(Coefficients& coverage) const {
  if (layout_.in_basis_order()) return average_slots(coverage.data());
  average_slots(scratch_.by_slot.data());
  layout_.from_slots(scratch_.by_slot.data(), coverage.data());
}

void CoverageTable::average_slots(double* coverage) const {
  for (int b = 0; b < block_count(); ++b) {
    double steps = 0;  // each with its quality
    std::size_t count = 0;
    for (const CoverageRow& row : rows_) {
      if (!row.counts()) continue;
      steps += row.quality() * row.block(b).remembered_steps();
      scratch_.qualities[count] = row.quality();
      scratch_.counted[count++] = row.sums(b);
    }
    const double per_second = steps > 0 ? 1 / (steps * gain_rule_.dt_s) : 0;
    const auto [first, modes] = layout_.slots_of(b);
    const std::span<const double* const> rows(scratch_.counted.data(), count);
    if (weighted_) {
      average_weighted(rows, scratch_.qualities.data(), modes, per_second, coverage + first);
    } else {
      average_rows(rows, modes, per_second, coverage + first);
    }
  }
}

Tick CoverageTable::announced_period(const Author& author) const {
  const CoverageRow* row = find(author);
  return row == nullptr ? 0 : row->announced_period();
}

std::optional<std::int64_t> CoverageTable::steps_held(const Author& author) const {
  const CoverageRow* row = find(author);
  return row == nullptr ? std::nullopt : std::optional(row->fewest_steps());
}

CoverageTable::RowSummary CoverageTable::summary_of(const Author& author) const {
  const CoverageRow* row = find(author);
  return row == nullptr ? RowSummary{author, 0, 0, 0, 0} : row->summary();
}

const double* CoverageTable::sums_of(const Author& author) const {
  const CoverageRow* row = find(author);
  ERGOCAST_REQUIRE(row != nullptr && !row->samples().empty());
  return row->samples().data();
}

double CoverageTable::covered_s() const {
  double steps = 0;
  for (const CoverageRow& row : rows_) {
    if (row.counts()) steps += row.quality() * row.block(0).remembered_steps();
  }
  return steps * gain_rule_.dt_s;
}

bool CoverageTable::holds_due(const Author& author, Tick tick) const {
  const CoverageRow* row = find(author);
  return row != nullptr && row->due_tick() > tick;
}

}  // namespace ergocast
