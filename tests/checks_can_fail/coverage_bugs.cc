// SPDX-License-Identifier: BSD-3-Clause
// Bugs of the coverage table and of forecasts.
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "core/law/coverage_table.h"
#include "core/law/forecast.h"
#include "tests/checks_can_fail/bugs.h"

namespace ergocast {

// clang-format off
WRAPPED(void, make_table, "_ZN8ergocast13CoverageTableC1ERKNS_5BasisEdl", CoverageTable*, const Basis&, double, Tick)
WRAPPED(void, set_now, "_ZN8ergocast13CoverageTable7set_nowEl", CoverageTable*, Tick)
WRAPPED(void, add_sample, "_ZN8ergocast13CoverageTable10add_sampleERKNS_6AuthorERKNS_7BasisAtEPKd", CoverageTable*, const Author&, const BasisAt&, const double*)
WRAPPED(void, set_quality, "_ZN8ergocast13CoverageTable11set_qualityERKNS_6AuthorEd", CoverageTable*, const Author&, double)
WRAPPED(Merge, merge, "_ZN8ergocast13CoverageTable5mergeERKNS_12ContributionEl", CoverageTable*, const Contribution&, std::int64_t)
WRAPPED(Contribution, block, "_ZNK8ergocast13CoverageTable5blockERKNS_6AuthorEi", const CoverageTable*, const Author&, int)
WRAPPED(void, average, "_ZNK8ergocast13CoverageTable7averageERN5Eigen6MatrixIdLin1ELi1ELi0ELin1ELi1EEE", const CoverageTable*, Coefficients&)
WRAPPED(void, make_forecast, "_ZN8ergocast8ForecastC1ERKNS_7MissionERKNS_6AuthorE", Forecast*, const Mission&, const Author&)
WRAPPED(void, see, "_ZN8ergocast8Forecast3seeEilRKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEEb", Forecast*, AgentId, Tick, const Eigen::Vector3d&, bool)
WRAPPED(void, look_ahead, "_ZN8ergocast8Forecast10look_aheadERKNS_13CoverageTableERKSt6vectorINS_11RosterEntryESaIS5_EElRN5Eigen6MatrixIdLin1ELi1ELi0ELin1ELi1EEE", Forecast*, const CoverageTable&, const std::vector<RosterEntry>&, Tick, Coefficients&)
WRAPPED(void, note_notes, "_ZN8ergocast7Efforts4noteESt4spanIKNS_10SearchNoteELm18446744073709551615EES1_IKNS_4HoldELm18446744073709551615EE", Efforts*, std::span<const SearchNote>, std::span<const Hold>)
WRAPPED(bool, merge_looks, "_ZN8ergocast7Efforts5mergeERKNS_6AuthorEmNS_10EffortTileEl", Efforts*, const Author&, std::size_t, EffortTile, Tick)
// clang-format on

// ---- coverage ----

void bug_set_now(CoverageTable* self, Tick counted) {
  if (bug("a half-life passes unnoticed")) counted = 0;
  if (bug("a half-life passes a tick early")) ++counted;
  real_set_now(self, counted);
}

void bug_set_quality(CoverageTable* self, const Author& author, double quality) {
  real_set_quality(self, author, bug("a quality does not count") ? 1 : quality);
}

void bug_add_sample(CoverageTable* self, const Author& author, const BasisAt& at,
                    const double* footprint) {
  if (bug("a backup is put back")) {
    static std::map<CoverageTable*, CoverageTable> backup;
    const auto steps = self->steps_held(author).value_or(0);
    if (steps == kUnderWay) backup.insert_or_assign(self, *self);
    if (steps == 2 * kUnderWay) *self = backup.at(self);
  }
  real_add_sample(self, author, at, footprint);
  if (bug("a sample counts twice")) real_add_sample(self, author, at, footprint);
}

namespace {

/// The content of a table, for a forecast that misreads it.
struct Sent {
  Basis basis;
  double dt_s;
  Tick joined;
  struct Blocks {
    Contribution before, held;
  };
  std::map<std::pair<Author, int>, Blocks> blocks;
};
std::map<const CoverageTable*, Sent> sent_to;

/// Whether another incarnation of this agent has sent a block after `tick`.
bool is_replaced(const CoverageTable& table, const Author& author, Tick tick) {
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Author& other = table.author(row);
    if (other.agent == author.agent && other != author && table.view(row, 0).tick > tick)
      return true;
  }
  return false;
}

void note(const CoverageTable* table, const Contribution& theirs, Merge merged) {
  Sent::Blocks& blocks = sent_to.at(table).blocks[{theirs.author(), theirs.block}];
  if (merged == Merge::kNewer) blocks = {blocks.held, theirs};
  const bool is_old = merged == Merge::kStale && theirs.steps < blocks.held.steps;
  if (is_old && bug("a late block becomes the one before")) blocks.before = theirs;
  if (is_old && is_relayed && bug("a relayed block becomes the one before")) blocks.before = theirs;
}

}  // namespace

void bug_make_table(CoverageTable* self, const Basis& basis, double dt_s, Tick joined) {
  real_make_table(self, basis, dt_s, joined);
  sent_to[self] = {basis, dt_s, joined, {}};
}

Merge bug_merge(CoverageTable* self, const Contribution& theirs, std::int64_t max_steps) {
  if (bug("an honest block is refused") && theirs.steps > kUnderWay) return Merge::kRefusedRange;
  if (bug("a shifted block is refused") && theirs.sums.largest() > 1.0001 * theirs.elapsed_s)
    return Merge::kRefusedRange;
  if (bug("one agent's rows are dropped") && theirs.author().agent == 0) return Merge::kStale;
  if (bug("a replaced incarnation is ignored") &&
      is_replaced(*self, theirs.author(), theirs.header.tick))
    return Merge::kStale;
  Contribution changed = theirs;
  // Still within the rounding that a receiver allows.
  if (bug("a receiver rounds") && theirs.block == 0) changed.sums.edit()[0] *= 1 + 5e-10;
  if (bug("a receiver mixes up modes")) {
    for (std::size_t k = 1; k < changed.sums.size(); ++k) changed.sums.edit()[k] *= -1;
  }
  if (bug("a block's age counts from its arrival")) {
    changed.header.tick = std::max(changed.header.tick, listener->tick());
  }
  const Merge merged = real_merge(self, changed, max_steps);
  note(self, theirs, merged);
  return merged;
}

Contribution bug_block(const CoverageTable* self, const Author& author, int block) {
  Contribution out = real_block(self, author, block);
  if (bug("a sum runs away")) out.sums.edit()[5] += 2 * out.elapsed_s;
  if (bug("time is not halved with its sums") && self->halvings() > 0) out.elapsed_s *= 2;
  return out;
}

namespace {

/// c_k of the blocks as they were sent. Slots are modes, and no row is weighted.
void average_unhalved(const CoverageTable& table, Coefficients& coverage) {
  for (int b = 0; b < table.block_count(); ++b) {
    const Eigen::Index first = b * table.block_size();
    Coefficients sums_s = Coefficients::Zero(coverage.size());
    double elapsed_s = 0;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      const Contribution sent = real_block(&table, table.author(row), b);
      elapsed_s += sent.elapsed_s;
      for (std::size_t k = 0; k < sent.sums.size(); ++k)
        sums_s[first + static_cast<Eigen::Index>(k)] += sent.sums[k];
    }
    const Eigen::Index last = std::min(coverage.size(), first + table.block_size());
    for (Eigen::Index k = first; k < last && elapsed_s > 0; ++k)
      coverage[k] = sums_s[k] / elapsed_s;
  }
}

}  // namespace

void bug_average(const CoverageTable* self, Coefficients& coverage) {
  if (bug("a receiver halves nothing")) return average_unhalved(*self, coverage);
  if (bug("a replaced incarnation counts twice")) {
    CoverageTable other = *self;
    for (std::size_t row = 0; row < other.row_count(); ++row) {
      if (is_replaced(other, other.author(row), other.view(row, 0).tick))
        real_set_quality(&other, other.author(row), 2 * other.quality(row));
    }
    return real_average(&other, coverage);
  }
  real_average(self, coverage);
  if (bug("the average is off")) coverage[2] += 1e-6;
}

// ---- forecasts ----

namespace {

/// Longer than any mission of the test.
constexpr Tick kForEver = 10000;

bool the_dead_are_foreseen() { return bug("the dead are foreseen for ever"); }
bool foresees_itself() { return bug("an agent foresees itself"); }

/// The table as it would be with other messages.
CoverageTable mistaken(const CoverageTable& table, Tick tick) {
  const Sent& sent = sent_to.at(&table);
  CoverageTable other(sent.basis, sent.dt_s, sent.joined);
  other.set_half_life(table.half_life());
  const auto merge = [&](Contribution block) {
    if (the_dead_are_foreseen()) block.next_broadcast_tick += kForEver;
    real_merge(&other, block, kForEver);
  };
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Author& author = table.author(row);
    other.add_row(author);
    for (int b = 0; b < table.block_count(); ++b) {
      const auto heard = sent.blocks.find({author, b});
      Contribution own = real_block(&table, author, b);
      own.header.tick = tick;
      if (heard == sent.blocks.end()) {
        merge(own);
      } else {
        merge(heard->second.before);
        merge(heard->second.held);
      }
    }
    if (!table.counts(row)) other.forget(author);
  }
  return other;
}

}  // namespace

void bug_make_forecast(Forecast* self, const Mission& mission, const Author& author) {
  Mission changed = mission;
  if (the_dead_are_foreseen()) changed.timing.broadcast_period_ticks = kForEver;
  if (bug("former targets are not halved")) changed.law.memory_half_life_s = 0;
  if (bug("a footprint is not foreseen")) {
    for (AgentKind& kind : changed.kinds) kind.footprint_sigma_m = 0;
  }
  if (bug("the resting are foreseen")) {
    for (AgentKind& kind : changed.kinds) kind.stations_m.clear();
  }
  real_make_forecast(self, changed, foresees_itself() ? Author{} : author);
}

void bug_see(Forecast* self, AgentId agent, Tick tick, const Eigen::Vector3d& x_m, bool charges) {
  real_see(self, agent, tick, x_m, charges && !bug("charging agents are foreseen"));
}

void bug_look_ahead(Forecast* self, const CoverageTable& table,
                    const std::vector<RosterEntry>& roster, Tick tick, Coefficients& coverage) {
  const bool mistakes_it = bug("a forecast halves nothing") || the_dead_are_foreseen() ||
                           foresees_itself() || bug("a late block becomes the one before") ||
                           bug("a relayed block becomes the one before");
  static const TargetShift kNoShift((Mission()));
  if (bug("teammates go on with the former target")) self->note_shift(kNoShift);
  if (bug("the recalled are foreseen"))
    return real_look_ahead(self, table, without_recalls(roster), tick, coverage);
  if (!mistakes_it) return real_look_ahead(self, table, roster, tick, coverage);
  real_look_ahead(self, mistaken(table, tick), roster, tick, coverage);
}

// ---- looks ----

bool bug_merge_looks(Efforts* self, const Author& author, std::size_t tile, EffortTile theirs,
                     Tick sent) {
  const std::vector<EffortTile>* const row = self->row_of(author);
  const EffortTile held = row != nullptr ? (*row)[tile] : EffortTile();
  if (bug("a tile is added to the one before") && theirs.newest_look > held.newest_look) {
    for (std::size_t slot = 0; slot < kTileCells; ++slot)
      theirs.looks[slot] = std::max(
          theirs.looks[slot],
          std::min<std::uint16_t>(theirs.looks[slot] + held.looks[slot], self->cells().most_looks));
  }
  if (bug("an old tile replaces a newer one") && theirs.newest_look < held.newest_look)
    sent = std::max(sent, theirs.newest_look = held.newest_look + 1);
  if (bug("a relayed row is the relayer's") && is_relayed)
    return real_merge_looks(self, {author.agent, author.incarnation + 1}, tile, theirs, sent);
  return real_merge_looks(self, author, tile, theirs, sent);
}

void bug_note_notes(Efforts* self, std::span<const SearchNote> notes, std::span<const Hold> holds) {
  if (!bug("agents forget nothing by a note")) real_note_notes(self, notes, holds);
}

}  // namespace ergocast
