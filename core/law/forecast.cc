// SPDX-License-Identifier: BSD-3-Clause
// Forecasts what each teammate's row will have covered, from its last rate or its reported places,
// and adds the rows from both ends of the team.
#include "core/law/forecast.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "core/law/forecast_sums.h"
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
      domain_(mission.domain),
      basis_(mission.basis),
      dt_s_(mission.timing.dt_s),
      layout_(mission),
      block_size_(layout_.block_size()),
      look_ahead_(mission),
      dead_reckons_(mission.dead_reckoning),
      sensors_(mission),
      uniform_(sensors_.uniform()),
      by_tables_(!layout_.in_basis_order()),
      most_places_(static_cast<std::size_t>(look_ahead_.longest_period() + kPlacesBeyondPeriod)),
      nothing_(static_cast<std::size_t>(layout_.slot_count())),
      gains_(nothing_),
      by_slot_(by_tables_ ? nothing_.size() : 0),
      earlier_(nothing_),
      later_(nothing_) {
  if (!any_station(mission)) return;
  for (AgentId id = 0; id < std::ssize(mission.starts_m); ++id)
    rest_from_.push_back(ergocast::rest_from(mission, id));
}

Tick Forecast::rest_from(AgentId id) const {
  const auto at = static_cast<std::size_t>(id);
  return at < rest_from_.size() ? rest_from_[at] : std::numeric_limits<Tick>::max();
}

void Forecast::see(AgentId agent, Tick tick, const Eigen::Vector3d& x_m) {
  if (!dead_reckons_ || agent == self_.agent || agent < 0 || agent >= kMaxAgents) return;
  if (!domain_.contains(x_m)) return;
  auto& places = tracks_[agent].places;
  if (!places.empty() && places.back().tick >= tick) return;
  // Many are erased at a time: moving all others for each new place would cost more than using it.
  if (places.size() == 2 * most_places_) {
    places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(most_places_));
  }
  places.reserve(2 * most_places_);
  places.push_back({tick, x_m});
}

// ---- dead reckoning ----

/// Extends the track of a row's vehicle to its newest known place; null if nothing is newer than
/// the row.
Forecast::Track* Forecast::dead_reckon(const CoverageTable& table, std::size_t row,
                                       const RosterEntry& entry) {
  const auto found = tracks_.find(entry.author.agent);
  if (found == tracks_.end()) return nullptr;
  Track& track = found->second;
  const auto blocks = static_cast<std::size_t>(table.block_count());
  // Additions from before a pause, or from before a successor of the coordinator admitted the
  // author again, are dropped. With them the forecast would depend on when it was computed.
  const bool goes_on = track.author == entry.author && track.active_from == entry.active_from &&
                       track.look + 1 == looks_ && track.sent_steps.size() == blocks;
  track.look = looks_;
  if (!goes_on) {
    track.author = entry.author;
    track.active_from = entry.active_from;
    track.kind = entry.kind;
    track.sent_steps.assign(blocks, -1);
    track.steps.assign(blocks, 0);
    track.until.assign(blocks, 0);
    track.due.assign(blocks, 0);
    track.sums.assign(blocks * static_cast<std::size_t>(block_size_), 0);
    track.newest.reset();
    track.newest_tick = -1;
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    const CoverageTable::BlockView sent = table.view(row, static_cast<int>(b));
    if (track.sent_steps[b] == sent.steps) continue;
    track.sent_steps[b] = track.steps[b] = sent.steps;
    track.until[b] = sent.tick;
    track.due[b] = 0;
  }
  const Tick oldest = *std::min_element(track.until.begin(), track.until.end());
  const auto first =
      track.places.end() - static_cast<std::ptrdiff_t>(std::min(track.places.size(), most_places_));
  auto place = track.places.end();
  while (place != first && std::prev(place)->tick > oldest) --place;
  // The newest place is where the vehicle goes on from, also if its author has already sent it.
  if (place == track.places.end() && place != first) --place;
  for (; place != track.places.end(); ++place) {
    if (entry.active_at(place->tick)) add_place(*place, table, row, track);
  }
  return &track;
}

/// S += f(x) dt in every block that does not contain it, as its author does. The addition is done
/// at the next use.
void Forecast::add_place(const Place& place, const CoverageTable& table, std::size_t row,
                         Track& track) {
  if (place.tick != track.newest_tick) {
    add_due_step(track);
    track.newest.emplace(place.x_m, domain_, basis_);
    track.newest_tick = place.tick;
    if (by_tables_) set_gains_in_slots(track);
  }
  for (std::size_t b = 0; b < track.until.size(); ++b) {
    if (track.sent_steps[b] == 0 || place.tick <= track.until[b]) continue;
    if (track.steps[b] == track.sent_steps[b]) {
      std::copy_n(table.view(row, static_cast<int>(b)).sums,
                  layout_.slots_of(static_cast<int>(b)).count,
                  track.sums.data() + b * static_cast<std::size_t>(block_size_));
    }
    track.due[b] = 1;
    track.until[b] = place.tick;
    ++track.steps[b];
  }
}

void Forecast::add_due_step(Track& track) const {
  for (std::size_t b = 0; b < track.due.size(); ++b) {
    if (!track.due[b]) continue;
    track.due[b] = 0;
    const Modes modes = layout_.slots_of(static_cast<int>(b));
    if (by_tables_) {
      sums::add_sums(track.gains.data(), modes, track.sums.data(), track.sums.data());
    } else if (const double* const g = footprint(track)) {
      sums::add_seen_gain(*track.newest, basis_, dt_s_, g, modes, track.sums.data());
    } else {
      sums::add_gain(*track.newest, basis_, dt_s_, modes, track.sums.data());
    }
  }
}

void Forecast::set_gains_in_slots(Track& track) {
  const Modes all{0, basis_.mode_count()};
  sums::set_gains(*track.newest, basis_, dt_s_, footprint(track), all, gains_.data());
  track.gains.resize(static_cast<std::size_t>(layout_.slot_count()));
  layout_.to_slots(gains_.data(), track.gains.data());
}

// ---- the forecast ----

void Forecast::gather(const CoverageTable& table, const std::vector<RosterEntry>& roster,
                      Tick tick) {
  has_forecast_.assign(table.row_count(), 0);
  dead_reckoned_.assign(table.row_count(), nullptr);
  std::size_t entry = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Author& author = table.author(row);
    while (entry < roster.size() && roster[entry].author < author) ++entry;
    if (entry == roster.size() || roster[entry].author != author || author == self_) continue;
    if (!table.counts(row) || !is_newest(roster, entry, tick)) continue;
    if (tick >= rest_from(author.agent)) continue;
    has_forecast_[row] = 1;
    if (dead_reckons_) dead_reckoned_[row] = dead_reckon(table, row, roster[entry]);
  }
}

/// Whether all blocks of each row that counts have the same age, the usual case.
bool Forecast::uniform_blocks(const CoverageTable& table) const {
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (!table.counts(row)) continue;
    if (!table.uniform_blocks(row)) return false;
    const Track* track = dead_reckoned_[row];
    const bool by_blocks = track == nullptr || track->newest_tick < table.view(row, 0).tick;
    if (by_blocks && has_forecast_[row] && !table.uniform_gains(row)) return false;
    if (track == nullptr) continue;
    const auto& [steps, due] = std::tie(track->steps, track->due);
    if (!std::equal(steps.begin() + 1, steps.end(), steps.begin())) return false;
    if (!std::equal(due.begin() + 1, due.end(), due.begin())) return false;
  }
  return true;
}

Forecast::Term Forecast::term_of(const CoverageTable& table, std::size_t row, int block) const {
  const CoverageTable::BlockView sent = table.view(row, block);
  Term term{nullptr,
            nullptr,
            nullptr,
            nullptr,
            sent.steps,
            0,
            sent.tick,
            sent.period,
            0,
            table.quality(row),
            rest_from(table.author(row).agent)};
  if (!has_forecast_[row] || sent.steps == 0) return term;
  Track* track = dead_reckoned_[row];
  if (track == nullptr || track->newest_tick < sent.tick) {
    term.gained_steps = table.gains(row, block).steps;
    return term;
  }
  term.track = track;
  term.steps = track->steps[static_cast<std::size_t>(block)];
  term.gained_steps = 1;
  term.tick = track->newest_tick;
  return term;
}

/// Where the terms' sums of this block are.
void Forecast::point_terms(const CoverageTable& table, int block) {
  const int first = layout_.slots_of(block).first;
  own_sums_ = nothing_.data();
  auto term = terms_.begin();
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (!table.counts(row)) continue;
    const CoverageTable::BlockView sent = table.view(row, block);
    if (table.author(row) == self_) {
      own_sums_ = sent.sums - first;
      continue;
    }
    const bool further =
        term->track != nullptr && term->track->steps[static_cast<std::size_t>(block)] > sent.steps;
    term->sums = further ? term->track->sums.data() : sent.sums - first;
    if (term->track == nullptr && term->gained_steps > 0) {
      const CoverageTable::Gains gains = table.gains(row, block);
      term->sums_before = gains.announced == nullptr ? gains.before - first : nullptr;
      term->announced_gains = gains.announced != nullptr ? gains.announced - first : nullptr;
    }
    ++term;
  }
}

/// Weighs what counts in a block; returns what its sum is to be multiplied by.
double Forecast::weigh_terms(const CoverageTable& table, int block, Tick tick) {
  terms_.clear();
  before_own_ = 0;
  own_quality_ = 1;
  double steps = 0;  // each with its quality
  int n = 1;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (!table.counts(row)) continue;
    const Term term = term_of(table, row, block);
    steps += term.quality * static_cast<double>(term.steps);
    n += term.gained_steps > 0;
    if (table.author(row) == self_) {
      own_quality_ = term.quality;
      continue;
    }
    before_own_ += table.author(row) < self_;
    terms_.push_back(term);
  }
  const double horizon_s = look_ahead_.horizon_s(n, tick);
  double covered_s = steps * dt_s_;
  for (Term& term : terms_) {
    if (term.gained_steps == 0) continue;
    const Tick age = std::max<Tick>(0, tick - term.tick);
    const double till_rest_s = static_cast<double>(term.rest_from - tick) * dt_s_;
    const double weight_s =
        look_ahead_.weight_s(std::min(horizon_s, till_rest_s), term.gained_steps, age, term.period);
    covered_s += term.quality * weight_s;
    term.share = weight_s / (static_cast<double>(term.gained_steps) * dt_s_);
  }
  return steps > 0 ? 1 / covered_s : 0;
}

/// g f dt at the newest place.
const double* Forecast::gains_of(const Track& track, Modes modes) {
  if (by_tables_) return track.gains.data();
  sums::set_gains(*track.newest, basis_, dt_s_, footprint(track), modes, gains_.data());
  return gains_.data();
}

/// Does what add() does for any row: one whose quality or footprint differs from others, or every
/// row where slots are not modes.
void Forecast::add_weighted(const Term& term, Modes modes, const double* before, double* sum) {
  Track* const track = term.track;
  const auto block = static_cast<std::size_t>(modes.first / block_size_);
  const double* gains = gains_.data();
  if (track != nullptr) {
    gains = gains_of(*track, modes);
    if (track->due[block]) sums::add_sums(gains, modes, track->sums.data(), track->sums.data());
    track->due[block] = 0;
  } else if (term.announced_gains != nullptr) {
    gains = term.announced_gains;
  } else if (term.sums_before != nullptr) {
    for (int k = modes.first; k < modes.first + modes.count; ++k)
      gains_[static_cast<std::size_t>(k)] = term.sums[k] - term.sums_before[k];
  } else {
    gains = nothing_.data();
  }
  sums::add_weighted(term.sums, gains, term.share, term.quality, modes, before, sum);
}

/// Adds what a row will have covered to `before`.
void Forecast::add(const Term& term, Modes modes, const double* before, double* sum) {
  Track* track = term.track;
  const bool weighted =
      !uniform_ && (term.quality != 1 || (track != nullptr && footprint(*track) != nullptr));
  if (weighted || by_tables_) return add_weighted(term, modes, before, sum);
  const auto block = modes.first / block_size_;
  if (track != nullptr && track->due[static_cast<std::size_t>(block)]) {
    sums::add_arriving(*track->newest, basis_, dt_s_, track->sums.data(), term.share, modes, before,
                       sum);
    track->due[static_cast<std::size_t>(block)] = 0;
  } else if (term.share == 0) {
    sums::add_sums(term.sums, modes, before, sum);
  } else if (track != nullptr) {
    sums::add_staying(*track->newest, basis_, dt_s_, term.sums, term.share, modes, before, sum);
  } else if (term.announced_gains != nullptr) {
    sums::add_announced(term.sums, term.announced_gains, term.share, modes, before, sum);
  } else {
    sums::add_gaining(term.sums, term.sums_before, term.share, modes, before, sum);
  }
}

/// Adds the rows from both ends of the team, and the own row last. In this order lab/ideal_team.cc
/// computes the sums of all agents with few more additions than those of one agent.
void Forecast::add_up(Modes modes, double per_second, double* coverage) {
  const double *earlier = nothing_.data(), *later = nothing_.data();
  const auto own = terms_.begin() + before_own_;
  for (auto term = terms_.begin(); term != own; ++term) {
    add(*term, modes, earlier, earlier_.data());
    earlier = earlier_.data();
  }
  for (auto term = terms_.rbegin(); term.base() != own; ++term) {
    add(*term, modes, later, later_.data());
    later = later_.data();
  }
  if (own_quality_ == 1)
    return sums::average(earlier, later, own_sums_, per_second, modes, coverage);
  sums::average_weighted(earlier, later, own_sums_, own_quality_, per_second, modes, coverage);
}

void Forecast::look_ahead(const CoverageTable& table, const std::vector<RosterEntry>& roster,
                          Tick tick, Coefficients& coverage) {
  ++looks_;
  gather(table, roster, tick);
  const bool uniform = uniform_blocks(table);
  double* const out = by_tables_ ? by_slot_.data() : coverage.data();
  double per_second = 0;
  for (int b = 0; b < table.block_count(); ++b) {
    if (b == 0 || !uniform) per_second = weigh_terms(table, b, tick);
    point_terms(table, b);
    add_up(layout_.slots_of(b), per_second, out);
  }
  if (by_tables_) layout_.from_slots(out, coverage.data());
}

}  // namespace ergocast
