// SPDX-License-Identifier: BSD-3-Clause
// Adds the rows from both ends of the team, and the own row last. In this order lab/ideal_team.cc
// computes the sums of all agents with few more additions than those of one agent.
#include "core/law/team_sum.h"

namespace ergocast {
namespace {

/// Whether a row's part is S + share · gains, and f has the order of the slots.
bool is_plain(const Term& term, const Sampling& sampling) {
  if (!sampling.layout().in_basis_order()) return false;
  if (sampling.uniform()) return true;
  return term.quality == 1 &&
         (term.track == nullptr || sampling.footprint(term.track->kind()) == nullptr);
}

/// Adds a plain row. f is computed in the loop that adds it.
void add_plain(const Term& term, const Sampling& sampling, int block,
               const sums::RunningSum& running) {
  RowTrack* const track = term.track;
  if (track != nullptr && track->take_due_step(block)) {
    sums::add_arriving(track->newest_gain(sampling), track->sums(), term.share, running);
  } else if (term.share == 0) {
    sums::add_sums(term.sums, running);
  } else if (track != nullptr) {
    sums::add_staying(track->newest_gain(sampling), term.sums, term.share, running);
  } else if (term.announced_gains != nullptr) {
    sums::add_announced(term.sums, term.announced_gains, term.share, running);
  } else {
    sums::add_gaining(term.sums, term.sums_before, term.share, running);
  }
}

}  // namespace

TeamSum::TeamSum(const BlockLayout& layout)
    : nothing_(static_cast<std::size_t>(layout.slot_count())),
      row_gains_(nothing_),
      earlier_(nothing_),
      later_(nothing_) {}

/// The gains of a row in a block, as a table that begins with the first slot.
const double* TeamSum::gains_of(const Term& term, const Sampling& sampling, sums::Modes modes) {
  if (term.track != nullptr) {
    if (!sampling.layout().in_basis_order()) return term.track->newest_gains_in_slots();
    sums::set_gains(term.track->newest_gain(sampling), modes, row_gains_.data());
    return row_gains_.data();
  }
  if (term.announced_gains != nullptr) return term.announced_gains;
  if (term.sums_before == nullptr) return nothing_.data();
  for (int k = modes.first; k < modes.first + modes.count; ++k)
    row_gains_[static_cast<std::size_t>(k)] = term.sums[k] - term.sums_before[k];
  return row_gains_.data();
}

/// Adds a row of any quality, footprint and layout: first its gains are computed, then added.
void TeamSum::add_by_gains(const Term& term, const Sampling& sampling, int block,
                           const sums::RunningSum& running) {
  const double* const gains = gains_of(term, sampling, running.modes);
  if (term.track != nullptr && term.track->take_due_step(block)) {
    double* const sums = term.track->sums();
    sums::add_sums(gains, {running.modes, sums, sums});
  }
  sums::add_weighted(term.sums, gains, term.share, term.quality, running);
}

/// Adds what a row will have covered.
void TeamSum::add(const Term& term, const Sampling& sampling, int block,
                  const sums::RunningSum& running) {
  if (is_plain(term, sampling)) return add_plain(term, sampling, block, running);
  add_by_gains(term, sampling, block, running);
}

void TeamSum::average(const TeamTerms& terms, const Sampling& sampling, int block,
                      double per_second, double* coverage) {
  const sums::Modes modes = sampling.layout().slots_of(block);
  const double* const own = terms.own.sums != nullptr ? terms.own.sums : nothing_.data();
  sums::TeamParts parts{nothing_.data(), nothing_.data(), own};
  for (const Term& term : terms.earlier) {
    add(term, sampling, block, {modes, parts.earlier, earlier_.data()});
    parts.earlier = earlier_.data();
  }
  for (auto term = terms.later.rbegin(); term != terms.later.rend(); ++term) {
    add(*term, sampling, block, {modes, parts.later, later_.data()});
    parts.later = later_.data();
  }
  if (terms.own.quality == 1) return sums::average(parts, per_second, modes, coverage);
  sums::average_weighted(parts, terms.own.quality, per_second, modes, coverage);
}

}  // namespace ergocast
