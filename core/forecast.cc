// SPDX-License-Identifier: BSD-3-Clause
// Extrapolates each teammate's row by its last rate or by its reported places, and adds the rows
// from both ends of the team.
#include "core/forecast.h"

#include <algorithm>
#include <array>

#include "core/vectorized.h"

namespace ergocast {
namespace {

ERGOCAST_VECTORIZED
void add_block(const double* a, const double* b, double* sum) {
  for (std::size_t k = 0; k < kBlockSize; ++k) sum[k] = a[k] + b[k];
}

/// Whether `entry` is active at `tick` and nobody newer is under its number; the roster ascends by
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
      domain_(mission.domain),
      basis_(mission.basis),
      dt_s_(mission.timing.dt_s),
      look_ahead_(mission),
      reckons_(mission.dead_reckoning),
      most_places_(static_cast<std::size_t>(look_ahead_.longest_period() + kPlacesBeyondPeriod)) {}

void Forecast::see(AgentId agent, Tick tick, const Eigen::Vector2d& x_m) {
  if (!reckons_ || agent == self_.agent || agent < 0 || agent >= kMaxAgents) return;
  if (!domain_.contains(x_m)) return;
  auto& places = tracks_[agent].places;
  if (!places.empty() && places.back().tick >= tick) return;
  // Many at a time: to move all the others for each that comes would cost more than to use it.
  if (places.size() == 2 * most_places_) {
    places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(most_places_));
  }
  places.reserve(2 * most_places_);
  places.push_back({tick, x_m});
}

// ---- dead reckoning -----------------------------------------------------------------------------

/// Brings the track of a row's vehicle up to what is known; null if that is no more than the row.
Forecast::Track* Forecast::reckon(const CoverageTable& table, std::size_t row,
                                  const RosterEntry& entry) {
  const auto found = tracks_.find(entry.author.agent);
  if (found == tracks_.end()) return nullptr;
  Track& track = found->second;
  const auto blocks = static_cast<std::size_t>(table.block_count());
  if (track.author != entry.author || track.said_steps.size() != blocks) {
    track.author = entry.author;
    track.said_steps.assign(blocks, -1);
    track.steps.assign(blocks, 0);
    track.until.assign(blocks, 0);
    track.sums.assign(blocks * kBlockSize, 0);
    track.gain.assign(blocks * kBlockSize, 0);
    track.gain_tick = -1;
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    const CoverageTable::BlockView said = table.view(row, static_cast<int>(b));
    if (track.said_steps[b] == said.steps) continue;
    track.said_steps[b] = track.steps[b] = said.steps;
    track.until[b] = said.tick;
  }
  const Tick oldest = *std::min_element(track.until.begin(), track.until.end());
  const auto first =
      track.places.end() - static_cast<std::ptrdiff_t>(std::min(track.places.size(), most_places_));
  auto place = track.places.end();
  while (place != first && std::prev(place)->tick > oldest) --place;
  for (; place != track.places.end(); ++place) {
    if (entry.active_at(place->tick)) add_place(*place, table, row, track);
  }
  if (!track.places.empty() && entry.active_at(track.places.back().tick)) {
    gain_at(track.places.back(), track);
  }
  return &track;
}

/// f(x) dt.
void Forecast::gain_at(const Place& place, Track& track) const {
  if (track.gain_tick == place.tick) return;
  track.gain_tick = place.tick;
  set_basis(BasisAt(place.x_m, domain_, basis_), basis_, dt_s_, track.gain.data());
}

/// S += f(x) dt in every block that does not hold it, as its author does.
void Forecast::add_place(const Place& place, const CoverageTable& table, std::size_t row,
                         Track& track) const {
  gain_at(place, track);
  for (std::size_t b = 0; b < track.until.size(); ++b) {
    if (track.said_steps[b] == 0 || place.tick <= track.until[b]) continue;
    double* sums = track.sums.data() + b * kBlockSize;
    const bool is_first = track.steps[b] == track.said_steps[b];
    const double* before = is_first ? table.view(row, static_cast<int>(b)).sums : sums;
    add_block(before, track.gain.data() + b * kBlockSize, sums);
    track.until[b] = place.tick;
    ++track.steps[b];
  }
}

// ---- the forecast -------------------------------------------------------------------------------

void Forecast::gather(const CoverageTable& table, const std::vector<RosterEntry>& roster,
                      Tick tick) {
  flies_.assign(table.row_count(), 0);
  reckoned_.assign(table.row_count(), nullptr);
  std::size_t entry = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Author& author = table.author(row);
    while (entry < roster.size() && roster[entry].author < author) ++entry;
    if (entry == roster.size() || roster[entry].author != author || author == self_) continue;
    if (!table.counts(row) || !is_newest(roster, entry, tick)) continue;
    flies_[row] = 1;
    if (reckons_) reckoned_[row] = reckon(table, row, roster[entry]);
  }
}

/// Whether all blocks of each row that counts are as old, as most often they are.
bool Forecast::blocks_alike(const CoverageTable& table) const {
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (!table.counts(row)) continue;
    if (!table.blocks_alike(row)) return false;
    const Track* track = reckoned_[row];
    if (track == nullptr) continue;
    const auto& steps = track->steps;
    if (!std::equal(steps.begin() + 1, steps.end(), steps.begin())) return false;
  }
  return true;
}

Forecast::Term Forecast::term_of(const CoverageTable& table, std::size_t row, int block) const {
  const CoverageTable::BlockView said = table.view(row, block);
  Term term{said.sums, said.gains, said.steps, 0, said.tick, said.period, 0};
  if (!flies_[row] || said.steps == 0) return term;
  term.gained_steps = said.gained_steps;
  const Track* track = reckoned_[row];
  if (track == nullptr || track->gain_tick < said.tick) return term;
  const auto b = static_cast<std::size_t>(block);
  if (track->steps[b] > said.steps) term.sums = track->sums.data() + b * kBlockSize;
  term.gains = track->gain.data() + b * kBlockSize;
  term.steps = track->steps[b];
  term.gained_steps = 1;
  term.tick = track->gain_tick;
  return term;
}

/// Gathers what counts in a block; returns what its sum is to be multiplied by.
double Forecast::weigh_terms(const CoverageTable& table, int block, Tick tick) {
  terms_.clear();
  before_own_ = 0;
  std::int64_t steps = 0;
  int n = 1;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (!table.counts(row)) continue;
    before_own_ += table.author(row) < self_;
    const Term& term = terms_.emplace_back(term_of(table, row, block));
    steps += term.steps;
    n += term.gained_steps > 0;
  }
  const double horizon_s = look_ahead_.horizon_s(n, tick);
  double covered_s = static_cast<double>(steps) * dt_s_;
  for (Term& term : terms_) {
    if (term.gained_steps == 0) continue;
    const Tick age = std::max<Tick>(0, tick - term.tick);
    const double weight_s = look_ahead_.weight_s(horizon_s, term.gained_steps, age, term.period);
    covered_s += weight_s;
    term.share = weight_s / (static_cast<double>(term.gained_steps) * dt_s_);
  }
  std::reverse(terms_.begin() + before_own_, terms_.end());
  return steps > 0 ? 1 / covered_s : 0;
}

/// sum += what so many rows will have covered, for one block's modes.
template <int kTerms>
inline void Forecast::add_terms(const Term* terms, int first, double* __restrict sum) {
  for (int k = 0; k < kBlockSize; ++k) {
    double all = sum[k];
    for (int i = 0; i < kTerms; ++i) {
      all += terms[i].sums[first + k] + terms[i].share * terms[i].gains[first + k];
    }
    sum[k] = all;
  }
}

/// The terms of `count` modes, from both ends of the team up to the own row: core/ideal_team.cc
/// makes all its agents' sums in this order, with few more additions than one agent's take.
ERGOCAST_VECTORIZED
void Forecast::add_up(double per_second, int count, double* coverage) const {
  const Term* const own = terms_.data() + before_own_;
  const Term* const end = terms_.data() + terms_.size();
  for (int first = 0; first < count; first += kBlockSize) {
    std::array<double, kBlockSize> before{}, after{};
    // Several at a time, and their sum stays in a register.
    const Term* term = terms_.data();
    for (; own - term >= 3; term += 3) add_terms<3>(term, first, before.data());
    for (; term < own; ++term) add_terms<1>(term, first, before.data());
    for (; end - term >= 4; term += 4) add_terms<4>(term, first, after.data());
    for (; term < end; ++term) add_terms<1>(term, first, after.data());
    const int here = std::min(kBlockSize, count - first);
    for (int k = 0; k < here; ++k) coverage[first + k] = (before[k] + after[k]) * per_second;
  }
}

void Forecast::look_ahead(const CoverageTable& table, const std::vector<RosterEntry>& roster,
                          Tick tick, Coefficients& coverage) {
  gather(table, roster, tick);
  const int at_once = blocks_alike(table) ? table.block_count() : 1;
  for (int b = 0; b < table.block_count(); b += at_once) {
    const int first = b * kBlockSize;
    const int count = std::min(at_once * kBlockSize, basis_.mode_count() - first);
    add_up(weigh_terms(table, b, tick), count, coverage.data() + first);
  }
}

}  // namespace ergocast
