// SPDX-License-Identifier: BSD-3-Clause
// Adds one place after the other to each block that does not contain it.
#include "core/law/row_track.h"

#include <algorithm>
#include <iterator>

#include "core/mission/half_life.h"

namespace ergocast {

void RowTrack::see(Tick tick, const Eigen::Vector3d& x_m) {
  if (!places_.empty() && places_.back().tick >= tick) return;
  // Many are erased at a time: moving all others for each new place would cost more than using it.
  if (places_.size() == most_places_ + kErasedAtOnce)
    places_.erase(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(kErasedAtOnce));
  places_.reserve(most_places_ + kErasedAtOnce);
  places_.push_back({tick, x_m});
}

void RowTrack::extend(const CoverageTable& table, std::size_t row, const RosterEntry& entry,
                      std::uint64_t look, Sampling& sampling) {
  // Additions from before a pause, or from before a successor of the coordinator admitted the
  // author again, are dropped. With them the forecast would depend on when it was computed.
  const bool goes_on = author_ == entry.author && active_from_ == entry.active_from &&
                       look_ + 1 == look && !blocks_.empty();
  look_ = look;
  if (!goes_on) restart(entry, sampling.layout());
  fade(table, sampling);
  take_newer_blocks(table, row);
  for (auto place = first_to_add(); place != places_.end(); ++place) {
    if (!entry.active_at(place->tick)) continue;
    add_lost(place, table, row, sampling);
    add_at(*place, table, row, sampling);
  }
}

/// Adds the steps between a place and the one before it, where positions were lost.
void RowTrack::add_lost(std::vector<PlaceAtTick>::const_iterator place, const CoverageTable& table,
                        std::size_t row, Sampling& sampling) {
  if (place == places_.begin() || std::prev(place)->tick < active_from_) return;
  const Tick oldest = oldest_block();
  for_each_lost_place(*std::prev(place), *place, [&](const PlaceAtTick& lost) {
    if (lost.tick > oldest) add_at(lost, table, row, sampling);
  });
}

void RowTrack::add_at(const PlaceAtTick& place, const CoverageTable& table, std::size_t row,
                      Sampling& sampling) {
  if (place.tick != newest_tick_) move_to(place, sampling);
  add_step(place.tick, table, row, sampling);
  const double weight = table.weight_at(place.tick);
  if (weight != 1) add_due_steps(sampling, weight);
}

/// Halves all that was added before the present tick as often as the row.
void RowTrack::fade(const CoverageTable& table, const Sampling& sampling) {
  if (halvings_ == table.halvings()) return;
  add_due_steps(sampling);
  const double factor = HalfLife::factor(halvings_, table.halvings());
  halvings_ = table.halvings();
  for (double& sum : sums_) sum *= factor;
  for (Block& block : blocks_) {
    block.elapsed_s *= factor;
    block.remembered_steps *= factor;
  }
}

void RowTrack::restart(const RosterEntry& entry, const BlockLayout& layout) {
  author_ = entry.author;
  active_from_ = entry.active_from;
  kind_ = entry.kind;
  const auto blocks = static_cast<std::size_t>(layout.block_count());
  blocks_.assign(blocks, Block());
  sums_.assign(blocks * static_cast<std::size_t>(layout.block_size()), 0);
  newest_.reset();
  newest_tick_ = -1;
}

void RowTrack::take_newer_blocks(const CoverageTable& table, std::size_t row) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const CoverageTable::BlockView sent = table.view(row, static_cast<int>(b));
    if (blocks_[b].sent_steps == sent.steps) continue;
    blocks_[b] = {.sent_steps = sent.steps,
                  .steps = sent.steps,
                  .elapsed_s = sent.remembered_s,
                  .remembered_steps = sent.remembered_steps,
                  .until = sent.tick};
  }
}

/// Up to which tick all blocks contain all steps.
Tick RowTrack::oldest_block() const {
  return std::ranges::min_element(blocks_, {}, &Block::until)->until;
}

/// The first known place that some block does not contain, but at latest the newest place: the
/// vehicle goes on from there, also if its author has already sent it.
std::vector<PlaceAtTick>::const_iterator RowTrack::first_to_add() const {
  const Tick oldest = oldest_block();
  const auto first =
      places_.end() - std::min(std::ssize(places_), static_cast<std::ptrdiff_t>(most_places_));
  auto place = places_.end();
  while (place != first && std::prev(place)->tick > oldest) --place;
  if (place == places_.end() && place != first) --place;
  return place;
}

/// Adds what is due at the place before.
void RowTrack::move_to(const PlaceAtTick& place, Sampling& sampling) {
  add_due_steps(sampling);
  newest_.emplace(place.x_m, sampling.domain(), sampling.basis());
  newest_tick_ = place.tick;
  if (sampling.layout().in_basis_order()) return;
  in_slots_.resize(static_cast<std::size_t>(sampling.layout().slot_count()));
  sampling.set_in_slots(*newest_, kind_, in_slots_.data());
}

/// @param weight  of these steps, where they have been halved since: a power of two
void RowTrack::add_due_steps(const Sampling& sampling, double weight) {
  for (int b = 0; b < std::ssize(blocks_); ++b) {
    if (!take_due_step(b)) continue;
    const sums::Modes modes = sampling.layout().slots_of(b);
    if (sampling.layout().in_basis_order()) {
      sums::PlaceGain gain = newest_gain(sampling);
      gain.dt_s *= weight;
      sums::add_gain(gain, modes, sums());
    } else if (weight == 1) {
      sums::add_sums(in_slots_.data(), {modes, sums(), sums()});
    } else {
      for (int slot = modes.first; slot < modes.first + modes.count; ++slot)
        sums()[slot] += weight * in_slots_[static_cast<std::size_t>(slot)];
    }
  }
}

/// Counts a step at the newest place in every block that does not contain it.
void RowTrack::add_step(Tick tick, const CoverageTable& table, std::size_t row,
                        const Sampling& sampling) {
  const double weight = table.weight_at(tick);
  for (int b = 0; b < std::ssize(blocks_); ++b) {
    Block& block = blocks_[static_cast<std::size_t>(b)];
    if (block.sent_steps == 0 || tick <= block.until) continue;
    if (!extends(b)) {
      const sums::Modes modes = sampling.layout().slots_of(b);
      std::copy_n(table.view(row, b).sums, modes.count, sums() + modes.first);
    }
    block.due = true;
    block.until = tick;
    ++block.steps;
    block.elapsed_s += sampling.dt_s() * weight;
    block.remembered_steps = table.half_life().any() ? block.elapsed_s / sampling.dt_s()
                                                     : static_cast<double>(block.steps);
  }
}

bool RowTrack::uniform() const {
  return std::all_of(blocks_.begin() + 1, blocks_.end(), [&](const Block& block) {
    const Block& first = blocks_.front();
    return block.steps == first.steps && block.remembered_steps == first.remembered_steps &&
           block.due == first.due;
  });
}

bool RowTrack::take_due_step(int block) {
  const bool due = of(block).due;
  blocks_[static_cast<std::size_t>(block)].due = false;
  return due;
}

}  // namespace ergocast
