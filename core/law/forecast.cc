// SPDX-License-Identifier: BSD-3-Clause
// Weighs what each teammate's row will have covered, from its last rate or its reported places.
#include "core/law/forecast.h"

#include <algorithm>
#include <limits>

#include "core/mission/station.h"

namespace ergocast {
namespace {

/// Whether `entry` is active at `tick` and no newer entry has its number; the roster ascends by
/// number.
bool is_newest(const std::vector<RosterEntry>& roster, std::size_t entry, Tick tick) {
  const RosterEntry& one = roster[entry];
  if (!one.active_at(tick)) return false;
  const auto supersedes = [&](const RosterEntry& other) {
    return other.active_from <= tick && other.active_from > one.active_from;
  };
  for (std::size_t i = entry; i-- > 0 && roster[i].author.agent == one.author.agent;) {
    if (supersedes(roster[i])) return false;
  }
  for (std::size_t i = entry + 1; i < roster.size() && roster[i].author.agent == one.author.agent;
       ++i) {
    if (supersedes(roster[i])) return false;
  }
  return true;
}

}  // namespace

Forecast::Forecast(const Mission& mission, const Author& self)
    : self_(self),
      sampling_(mission),
      look_ahead_(mission),
      half_life_(mission),
      dead_reckons_(mission.dead_reckoning),
      most_places_(static_cast<std::size_t>(look_ahead_.longest_period() + kPlacesBeyondPeriod)),
      team_sum_(sampling_.layout()) {
  const BlockLayout& layout = sampling_.layout();
  if (!layout.in_basis_order()) by_slot_.resize(static_cast<std::size_t>(layout.slot_count()));
  if (any_battery(mission)) charges_.resize(mission.starts_m.size());
  if (!any_station(mission)) return;
  for (AgentId id = 0; id < std::ssize(mission.starts_m); ++id)
    rest_from_.push_back(ergocast::rest_from(mission, id));
}

Tick Forecast::rest_from(AgentId id) const {
  const auto at = static_cast<std::size_t>(id);
  return at < rest_from_.size() ? rest_from_[at] : std::numeric_limits<Tick>::max();
}

void Forecast::note_ends(const Mission& mission, const EndSchedule& ends, Tick counted) {
  look_ahead_.set_end(ends.tick_count_at(counted));
  for (std::size_t at = 0; at < rest_from_.size(); ++at)
    rest_from_[at] = ends.rest_from(mission, static_cast<AgentId>(at), counted);
}

bool Forecast::charges(AgentId id) const {
  const auto at = static_cast<std::size_t>(id);
  return at < charges_.size() && charges_[at].goes_on;
}

void Forecast::see(AgentId agent, Tick tick, const Eigen::Vector3d& x_m, bool charges) {
  if (agent == self_.agent || agent < 0 || agent >= kMaxAgents) return;
  if (const auto at = static_cast<std::size_t>(agent); at < charges_.size()) {
    if (tick <= charges_[at].tick) return;
    charges_[at] = {tick, charges};
  }
  if (!dead_reckons_ || charges) return;
  if (!sampling_.domain().contains(x_m)) return;
  tracks_.try_emplace(agent, most_places_).first->second.see(tick, x_m);
}

/// The track of a row's vehicle up to its newest known place; null if no place is known.
RowTrack* Forecast::extended_track(const CoverageTable& table, std::size_t row,
                                   const RosterEntry& entry) {
  const auto found = tracks_.find(entry.author.agent);
  if (found == tracks_.end()) return nullptr;
  found->second.extend(table, row, entry, looks_, sampling_);
  return &found->second;
}

void Forecast::gather(const CoverageTable& table, const std::vector<RosterEntry>& roster,
                      Tick tick) {
  outlooks_.assign(table.row_count(), Outlook());
  std::size_t entry = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Author& author = table.author(row);
    while (entry < roster.size() && roster[entry].author < author) ++entry;
    if (entry == roster.size() || roster[entry].author != author || author == self_) continue;
    if (!table.counts(row) || !is_newest(roster, entry, tick)) continue;
    if (tick >= rest_from(author.agent) || roster[entry].recalled_at(revision_)) continue;
    if (charges(author.agent)) continue;
    outlooks_[row].any = true;
    if (dead_reckons_) outlooks_[row].track = extended_track(table, row, roster[entry]);
  }
}

/// Whether all blocks of each row that counts have the same age, the usual case.
bool Forecast::uniform_blocks(const CoverageTable& table) const {
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (!table.counts(row)) continue;
    if (!table.uniform_blocks(row)) return false;
    const Outlook& outlook = outlooks_[row];
    const bool by_blocks = outlook.any && !outlook.by_places(table.view(row, 0).tick);
    if (by_blocks && !table.uniform_gains(row)) return false;
    if (outlook.track != nullptr && !outlook.track->uniform()) return false;
  }
  return true;
}

/// One row's part in one block, without its share and the places of its numbers.
Term Forecast::term_of(const CoverageTable& table, std::size_t row, int block) const {
  const CoverageTable::BlockView sent = table.view(row, block);
  Term term{.remembered_steps = sent.remembered_steps,
            .tick = sent.tick,
            .period = sent.period,
            .rest_from = rest_from(table.author(row).agent),
            .quality = table.quality(row)};
  const Outlook& outlook = outlooks_[row];
  if (!outlook.any || sent.steps == 0) return term;
  if (!outlook.by_places(sent.tick)) {
    const CoverageTable::Gains gains = table.gains(row, block);
    term.gained_steps = gains.steps;
    term.gained_time_steps = gains.time_steps;
    return term;
  }
  term.track = outlook.track;
  term.added_steps = outlook.track->added_steps(block);
  term.remembered_steps = outlook.track->remembered_steps(block);
  term.gained_steps = 1;
  term.gained_time_steps = 1;
  term.tick = outlook.track->newest_tick();
  return term;
}

/// Weighs what counts in a block; returns what its sum is to be multiplied by.
double Forecast::weigh_terms(const CoverageTable& table, int block, Tick tick) {
  terms_.clear();
  double steps = 0;  // each with its quality
  int n = 1;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (!table.counts(row)) continue;
    const Term term = term_of(table, row, block);
    steps += term.quality * term.remembered_steps;
    n += term.gained_steps > 0;
    if (const Author& author = table.author(row); author == self_) {
      terms_.own = term;
    } else {
      (author < self_ ? terms_.earlier : terms_.later).push_back(term);
    }
  }
  const double horizon_s = look_ahead_.horizon_s(n, tick);
  double covered_s = steps * sampling_.dt_s();
  for (Term& term : terms_.earlier) covered_s += weigh(term, horizon_s, tick);
  for (Term& term : terms_.later) covered_s += weigh(term, horizon_s, tick);
  return steps > 0 ? 1 / covered_s : 0;
}

/// Sets the share of a row's gains; returns the time for which they are assumed to go on, with the
/// row's quality.
double Forecast::weigh(Term& term, double horizon_s, Tick tick) const {
  if (term.gained_steps == 0) return 0;
  const double dt_s = sampling_.dt_s();
  const Tick age = std::max<Tick>(0, tick - term.tick);
  const double till_rest_s = static_cast<double>(term.rest_from - tick) * dt_s;
  const double weight_s =
      look_ahead_.weight_s(std::min(horizon_s, till_rest_s), term.gained_steps, age, term.period);
  term.share = weight_s / (term.gained_time_steps * dt_s);
  return term.quality * weight_s;
}

/// Sets where the terms' numbers of this block are.
void Forecast::point_terms(const CoverageTable& table, int block) {
  auto earlier = terms_.earlier.begin(), later = terms_.later.begin();
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (!table.counts(row)) continue;
    const Author& author = table.author(row);
    Term& term = author == self_ ? terms_.own : author < self_ ? *earlier++ : *later++;
    point(term, table, row, block);
  }
}

void Forecast::point(Term& term, const CoverageTable& table, std::size_t row, int block) const {
  const int first = block * sampling_.layout().block_size();
  const bool extended = term.track != nullptr && term.track->extends(block);
  term.sums = extended ? term.track->sums() : table.view(row, block).sums - first;
  if (term.track != nullptr || term.gained_steps == 0) return;
  const CoverageTable::Gains gains = table.gains(row, block);
  term.sums_before = gains.announced == nullptr ? gains.before - first : nullptr;
  term.announced_gains = gains.announced != nullptr ? gains.announced - first : nullptr;
}

/// Adds `each_s` to a change for each of the last `steps` ticks up to `newest` in which it held,
/// times what that tick weighs once all has been halved so many times.
void Forecast::add_steps(Tick newest, std::int64_t steps, std::int64_t halvings, double each_s,
                         Correction& sum) const {
  const std::span<const TargetShift::Change> changes = shift_->changes();
  Tick until = newest + 1;
  for (std::size_t i = changes.size(); i-- > 0;) {
    const Tick from = std::max(changes[i].from, newest + 1 - steps);
    if (from < until) sum[i] += half_life_.remembered_ticks(from, until, halvings) * each_s;
    until = std::min(until, changes[i].from);
  }
}

/// Adds what a term lacks of the shifts.
void Forecast::add_correction(const Term& term, Tick sent, Tick tick, std::int64_t halvings,
                              Correction& sum) const {
  if (term.gained_steps == 0) return;
  const std::int64_t now = half_life_.halvings(tick), then = half_life_.halvings(sent);
  const double step_s = term.quality * sampling_.dt_s();
  if (term.track != nullptr) {
    // Places are f without a shift: those that extend the row, and the newest, where it goes on.
    add_steps(term.tick, term.added_steps, halvings, step_s, sum);
    add_steps(tick, 1, now, term.share * step_s, sum);
    return;
  }
  // Its gains have the shifts of their ticks, and it will gain with the present one.
  const Tick first = sent + 1 - term.gained_steps;
  const double gained = term.gained_time_steps;
  const double each = gained / half_life_.remembered_ticks(first, sent + 1, then);
  add_steps(sent, term.gained_steps, then, each * (-term.share * step_s), sum);
  add_steps(tick, 1, now, gained * (term.share * step_s), sum);
}

Forecast::Correction Forecast::correction(const CoverageTable& table, int block, Tick tick) const {
  Correction sum{};
  if (shift_ == nullptr) return sum;
  auto earlier = terms_.earlier.begin(), later = terms_.later.begin();
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (!table.counts(row) || table.author(row) == self_) continue;
    const Term& term = table.author(row) < self_ ? *earlier++ : *later++;
    add_correction(term, table.view(row, block).tick, tick, table.halvings(), sum);
  }
  return sum;
}

/// Subtracts what a block lacks of the shifts.
void Forecast::correct(const Correction& correction, int block, double per_second,
                       double* coverage) const {
  if (shift_ == nullptr) return;
  const auto [first, count] = sampling_.layout().slots_of(block);
  for (std::size_t i = 0; i < shift_->changes().size(); ++i) {
    const double share = correction[i] * per_second;
    if (share == 0) continue;
    const double* const shift = shift_->changes()[i].by_slot.data();
    for (int slot = first; slot < first + count; ++slot) coverage[slot] -= shift[slot] * share;
  }
}

void Forecast::look_ahead(const CoverageTable& table, const std::vector<RosterEntry>& roster,
                          Tick tick, Coefficients& coverage) {
  ++looks_;
  gather(table, roster, tick);
  const bool uniform = uniform_blocks(table);
  const bool in_basis_order = sampling_.layout().in_basis_order();
  double* const out = in_basis_order ? coverage.data() : by_slot_.data();
  double per_second = 0;
  Correction lacks{};
  for (int b = 0; b < table.block_count(); ++b) {
    if (b == 0 || !uniform) {
      per_second = weigh_terms(table, b, tick);
      lacks = correction(table, b, tick);
    }
    point_terms(table, b);
    team_sum_.average(terms_, sampling_, b, per_second, out);
    correct(lacks, b, per_second, out);
  }
  if (!in_basis_order) sampling_.layout().from_slots(out, coverage.data());
}

}  // namespace ergocast
