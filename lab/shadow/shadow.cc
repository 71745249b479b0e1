// SPDX-License-Identifier: BSD-3-Clause
// Computes ĉ a second time from received messages alone, and shares no code of the look-ahead
// with core/.
#include "lab/shadow/shadow.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/law/forecast.h"
#include "lab/shadow/shadow_equations.h"
#include "lab/shadow/target_covariance.h"

namespace ergocast::lab {
namespace {

/// Room for rounding where a gain is compared with its time.
constexpr double kRoom = 1e-6;

/// How much the coverage of an agent counts.
double quality_of(const Mission& mission, const RosterEntry* entry) {
  return mission.kinds.empty() || entry == nullptr
             ? 1
             : mission.kinds.at(static_cast<std::size_t>(entry->kind)).quality;
}

/// The time that sums of so many steps cover: what was sent with them only where it is forgotten.
double covered_s(const Mission& mission, std::int64_t steps, double elapsed_s) {
  if (mission.law.memory_half_life_s > 0) return elapsed_s;
  return static_cast<double>(steps) * mission.timing.dt_s;
}

int block_size(const Mission& mission) {
  return block_size_of(mission.timing.contribution_encoding);
}

/// The numbers of a block with these modes, and zeros beyond the last.
std::vector<double> block_of(const Coefficients& all, const std::vector<int>& modes, int size) {
  std::vector<double> sums(static_cast<std::size_t>(size));
  std::ranges::transform(modes, sums.begin(), [&](int mode) { return all[mode]; });
  return sums;
}

std::vector<double> vector_of(const BlockSums& sums, int size) {
  std::vector<double> all(sums.begin(), sums.end());
  all.resize(static_cast<std::size_t>(size));
  return all;
}

/// Whether an entry takes part in the tick and is the newest incarnation of its number.
bool is_newest(const std::vector<RosterEntry>& roster, const RosterEntry& one, Tick tick) {
  return one.active_at(tick) &&
         std::none_of(roster.begin(), roster.end(), [&](const RosterEntry& other) {
           return other.author.agent == one.author.agent && other.active_from > one.active_from &&
                  other.active_from <= tick;
         });
}

}  // namespace

// ---- what was received ----

void Shadow::receive(const Mission& mission, const TableView& agent, const Message& message) {
  if (const auto* block = std::get_if<Contribution>(&message)) take(mission, agent, *block);
  if (const auto* world = std::get_if<WorldState>(&message)) note_places(mission, agent, *world);
}

/// Takes a block's content from the message itself. Only whether the block is held now comes from
/// the table.
void Shadow::take(const Mission& mission, const TableView& agent, const Contribution& theirs) {
  if (theirs.author() == agent.self) return;
  Row& row = rows_[theirs.author()];
  row.blocks.resize(static_cast<std::size_t>(agent.table->block_count()));
  Block& block = row.blocks[static_cast<std::size_t>(theirs.block)];
  const Contribution taken = agent.table->block(theirs.author(), theirs.block);
  if (theirs.steps < block.held.steps || taken.steps != theirs.steps) return;
  if (theirs.steps == block.held.steps) {
    // An author that rests from now on announces a broadcast at the end.
    if (theirs.next_broadcast_tick <= taken.next_broadcast_tick)
      block.held.next_tick = std::max(block.held.next_tick, theirs.next_broadcast_tick);
    return;
  }
  block.before = block.held;
  block.held = {theirs.steps, theirs.header.tick, theirs.next_broadcast_tick, theirs.elapsed_s,
                theirs.sums,  theirs.gains,       theirs.gained_steps};
  block.gains_possible = gains_are_possible(mission, agent, block);
}

/// A teammate may know of a new target first. What its block gains may then seem impossible.
bool Shadow::gains_are_possible(const Mission& mission, const TableView& agent,
                                const Block& block) const {
  if (agent.table->allows_shifts()) return true;
  const Part part = part_of(mission, block, halvings_at(mission, block.held.tick));
  const double most_s = part.gained_s * (1 + kRoom);
  return std::ranges::all_of(part.gains,
                             [most_s](double gain_s) { return std::abs(gain_s) <= most_s; });
}

void Shadow::note_places(const Mission& mission, const TableView& agent, const WorldState& world) {
  const Tick state_tick = world.header.tick;
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    if (state_tick >= positions_tick_) positions_m_[vehicle.id] = vehicle.position_m;
  }
  positions_tick_ = std::max(positions_tick_, state_tick);
  const Tick tick = counted_ticks(agent.holds, state_tick);
  if (tick < active_from_ || is_held(agent.holds, state_tick)) return;
  const Timing& timing = mission.timing;
  const auto hold =
      static_cast<Tick>(std::max(1.0, std::ceil(timing.command_hold_s / timing.dt_s)));
  const auto most =
      static_cast<std::size_t>(timing.broadcast_period_ticks * timing.high_mode_period_factor +
                               Forecast::kPlacesBeyondPeriod);
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    const bool driven =
        timing.pace == Pace::kLockstep || vehicle.answered_tick >= state_tick - hold;
    if (!driven || vehicle.id == agent.self.agent) continue;
    if (!in_range(mission, agent.self.agent, vehicle.id)) continue;
    Charge& charge = charges_[vehicle.id];
    if (tick <= charge.tick) continue;
    charge = {tick, is_charged(mission, vehicle)};
    if (charge.goes_on) continue;
    std::deque<Place>& places = places_[vehicle.id];
    if (!places.empty() && tick <= places.back().tick) continue;
    places.push_back({tick, vehicle.position_m});
    if (places.size() > most) places.pop_front();
  }
}

bool Shadow::has_forecast(const Mission& mission, const TableView& agent,
                          const RosterEntry& entry) const {
  const auto charge = charges_.find(entry.author.agent);
  if (charge != charges_.end() && charge->second.goes_on) return false;
  return entry.author != agent.self && !is_forgotten(entry, agent) &&
         is_newest(*agent.roster, entry, agent.counted) && !is_recalled(entry, agent) &&
         agent.counted < covers_until(mission, entry.author.agent, agent.amendments, agent.counted);
}

bool Shadow::in_range(const Mission& mission, AgentId one, AgentId other) const {
  if (mission.radio_range_m <= 0) return true;
  const auto here = positions_m_.find(one), there = positions_m_.find(other);
  if (here == positions_m_.end() || there == positions_m_.end()) return true;
  return (here->second - there->second).norm() <= mission.radio_range_m;
}

// ---- where teammates have been ----

void Shadow::answer(const Mission& mission, const TableView& agent) {
  newest_counted_ = std::max(newest_counted_, agent.counted);
  if (!mission.dead_reckoning) return;
  for (auto& [author, row] : rows_) {
    const RosterEntry* entry = entry_of(*agent.roster, author);
    const bool dead_reckoned = entry != nullptr && has_forecast(mission, agent, *entry);
    // Uses the roster as it is now: an admission may be lost with its coordinator, and be sent
    // again.
    if (!dead_reckoned || row.active_from != entry->active_from) {
      for (Block& block : row.blocks) block.since.clear();
      row.newest.reset();
      row.active_from.reset();
    }
    if (!dead_reckoned) continue;
    row.active_from = entry->active_from;
    dead_reckon(*entry, row);
  }
}

/// The places, and between two of them that miss at most 8 ticks those on the straight line. A
/// place from before the author was active begins no line.
std::vector<Shadow::Place> Shadow::without_gaps(const std::deque<Place>& places, Tick active_from) {
  std::vector<Place> all;
  for (const Place& place : places) {
    const std::optional<Place> before = all.empty() ? std::nullopt : std::optional(all.back());
    if (before && before->tick >= active_from && place.tick - before->tick <= 9) {
      const Eigen::Vector3d step_m =
          (place.x_m - before->x_m) / static_cast<double>(place.tick - before->tick);
      for (Tick tick = before->tick + 1; tick < place.tick; ++tick)
        all.push_back({tick, before->x_m + static_cast<double>(tick - before->tick) * step_m});
    }
    all.push_back(place);
  }
  return all;
}

/// Each block gets the later places of the same incarnation; the next block replaces them.
void Shadow::dead_reckon(const RosterEntry& entry, Row& row) const {
  const auto found = places_.find(entry.author.agent);
  if (found == places_.end()) return;
  const std::vector<Place> places = without_gaps(found->second, entry.active_from);
  for (Block& block : row.blocks) {
    if (block.dead_reckoned_steps != block.held.steps) block.since.clear();
    block.dead_reckoned_steps = block.held.steps;
    if (block.held.steps == 0) continue;
    const Tick until = block.since.empty() ? block.held.tick : block.since.back().tick;
    const auto later =
        std::upper_bound(places.begin(), places.end(), until,
                         [](Tick tick, const Place& place) { return tick < place.tick; });
    std::copy_if(later, places.end(), std::back_inserter(block.since),
                 [&](const Place& place) { return entry.active_at(place.tick); });
  }
  if (entry.active_at(places.back().tick)) row.newest = places.back();
}

// ---- targets that have changed ----

void Shadow::add_shift(const Mission& mission, int block, Tick tick, double factor,
                       std::vector<double>& numbers) const {
  if (targets_.empty()) return;
  const auto shift = block_of(targets_.shift_s(mission, tick),
                              modes(mission)[static_cast<std::size_t>(block)], block_size(mission));
  for (std::size_t k = 0; k < shift.size(); ++k) numbers[k] += factor * shift[k];
}

/// A teammate will gain with the shift of `tick`, and has gained with those of its steps, each as
/// far as it was remembered at the last of them.
void Shadow::correct_gains(const Mission& mission, int block, Tick tick, Part& part) const {
  if (targets_.empty()) return;
  const Tick first = part.tick - part.gained_steps + 1, halvings = halvings_at(mission, part.tick);
  const auto left = [&](Tick step) { return left_after(halvings - halvings_at(mission, step)); };
  double steps = 0;
  for (Tick step = first; step <= part.tick; ++step) steps += left(step);
  const double gained = part.gained_s / mission.timing.dt_s;
  for (Tick step = first; step <= part.tick; ++step)
    add_shift(mission, block, step, left(step) / steps * gained, part.gains);
  add_shift(mission, block, tick, -gained, part.gains);
}

// ---- the own row ----

double Shadow::sample_error_s(const Mission& mission, const TableView& agent,
                              const Eigen::Vector3d& x_m) {
  const Contribution own = agent.table->block(agent.self, 0);
  const RosterEntry* const entry = entry_of(*agent.roster, agent.self);
  std::vector<double> sums_s = vector_of(own.sums, block_size(mission));
  double error_s = 0;
  // The row's tick is that of its last halving.
  const Tick halvings = halvings_at(mission, own.header.tick);
  const double left = left_after(halvings - std::exchange(own_halvings_, halvings));
  if (own.steps == own_steps_ + 1 && own_steps_ > 0 && entry != nullptr) {
    auto expected_s =
        block_of(seen_at(mission, entry->kind, x_m), modes(mission)[0], block_size(mission));
    add_shift(mission, 0, agent.counted, -1, expected_s);
    for (std::size_t k = 0; k < sums_s.size(); ++k) {
      const double sample_s = sums_s[k] - left * own_sums_s_[k];
      error_s = std::max(error_s, std::abs(sample_s - expected_s[k]));
    }
  }
  own_steps_ = own.steps;
  own_sums_s_ = std::move(sums_s);
  return error_s;
}

// ---- the equation ----

/// The part of a block without dead reckoning, as remembered after so many halvings.
Shadow::Part Shadow::part_of(const Mission& mission, const Block& block, Tick halvings) const {
  const Snapshot& held = block.held;
  // A block from before the agent's first tick may differ with the way on which it arrived, so it
  // is not used.
  const Snapshot before = block.before.tick >= active_from_ ? block.before : Snapshot{};
  const int size = block_size(mission);
  const double left = left_after(halvings - halvings_at(mission, held.tick));
  const double left_before = left_after(halvings - halvings_at(mission, before.tick));
  Part part{vector_of(held.sums, size),
            vector_of(held.gains, size),
            covered_s(mission, held.steps, held.elapsed_s),
            0,
            held.gained_steps,
            held.tick,
            held.next_tick - held.tick};
  // Announced gains are averages over their steps at the row's mean time a step.
  if (held.steps > 0)
    part.gained_s =
        part.time_s * static_cast<double>(held.gained_steps) / static_cast<double>(held.steps);
  part.time_s *= left;
  for (double& sum : part.sums) sum *= left;
  if (mission.timing.contribution_encoding == ContributionEncoding::kFixed16) return part;
  part.gained_steps = held.steps - before.steps;
  part.gained_s = part.time_s - left_before * covered_s(mission, before.steps, before.elapsed_s);
  const std::vector<double> sums_before = vector_of(before.sums, size);
  for (std::size_t k = 0; k < part.gains.size(); ++k) {
    part.gains[k] = part.sums[k] - left_before * sums_before[k];
  }
  return part;
}

/// What each block of a row adds to ĉ.
/// @param forecast_tick  of the forecast, if the row has one
std::vector<Shadow::Part> Shadow::parts_of(const Mission& mission, const Row& row,
                                           const RosterEntry* entry,
                                           std::optional<Tick> forecast_tick, Tick halvings) const {
  std::map<Tick, Coefficients> gains;
  const auto gain = [&](const Place& place, int b) {
    auto found = gains.find(place.tick);
    if (found == gains.end())
      found = gains.emplace(place.tick, seen_at(mission, entry->kind, place.x_m)).first;
    return block_of(found->second, modes(mission)[static_cast<std::size_t>(b)],
                    block_size(mission));
  };
  std::vector<Part> parts;
  for (int b = 0; b < static_cast<int>(row.blocks.size()); ++b) {
    const Block& block = row.blocks[static_cast<std::size_t>(b)];
    Part& part = parts.emplace_back(part_of(mission, block, halvings));
    part.quality = quality_of(mission, entry);
    if (!forecast_tick) part.gained_steps = 0;
    if (part.gained_steps == 0) continue;
    if (!row.newest || row.newest->tick < block.held.tick) {
      correct_gains(mission, b, *forecast_tick, part);
      if (!block.gains_possible) part.gained_steps = 0;
      continue;
    }
    // Places may be missing; the steps at them count as the last ones up to the newest.
    Tick step = row.newest->tick - std::ssize(block.since);
    for (const Place& place : block.since) {
      const auto more = gain(place, b);
      const double left = left_after(halvings - halvings_at(mission, place.tick));
      for (std::size_t k = 0; k < more.size(); ++k) part.sums[k] += left * more[k];
      part.time_s += left * mission.timing.dt_s;
      ++step;
      add_shift(mission, b, step, -left_after(halvings - halvings_at(mission, step)), part.sums);
    }
    part.gains = gain(*row.newest, b);
    add_shift(mission, b, *forecast_tick, -1, part.gains);
    part.gained_steps = 1;
    part.gained_s = mission.timing.dt_s;
    part.tick = row.newest->tick;
  }
  return parts;
}

std::vector<std::vector<Shadow::Part>> Shadow::team(const Mission& mission,
                                                    const TableView& agent) const {
  std::vector<std::vector<Part>> team(1);
  // An agent that has learned late of a pause has halved its sums too early, and they stay so. That
  // also holds for one that rests and samples nothing.
  const Tick halvings = halvings_at(mission, std::max(agent.counted, newest_counted_));
  for (int b = 0; b < agent.table->block_count(); ++b) {
    const Contribution own = agent.table->block(agent.self, b);
    const int size = block_size(mission);
    const std::vector<double> nothing(static_cast<std::size_t>(size));
    team[0].push_back(
        {vector_of(own.sums, size), nothing, covered_s(mission, own.steps, own.elapsed_s)});
    team[0].back().quality = quality_of(mission, entry_of(*agent.roster, agent.self));
  }
  for (const auto& [author, row] : rows_) {
    const RosterEntry* entry = entry_of(*agent.roster, author);
    if (entry == nullptr || is_forgotten(*entry, agent)) continue;
    const bool forecast = has_forecast(mission, agent, *entry);
    team.push_back(parts_of(mission, row, entry,
                            forecast ? std::optional(agent.counted) : std::nullopt, halvings));
    for (Part& part : team.back())
      part.until = covers_until(mission, entry->author.agent, agent.amendments, agent.counted);
  }
  return team;
}

Coefficients Shadow::foreseen(const Mission& mission, const TableView& agent) const {
  const double dt_s = mission.timing.dt_s;
  Coefficients c = Coefficients::Zero(mission.basis.mode_count());
  if (!covariance_m2_) covariance_m2_ = target_covariance_m2(mission);
  const auto team = this->team(mission, agent);
  const int size = block_size(mission);
  for (int b = 0; b < agent.table->block_count(); ++b) {
    const auto at = static_cast<std::size_t>(b);
    const auto forecasts = std::count_if(
        team.begin(), team.end(), [at](const auto& parts) { return parts[at].gained_steps > 0; });
    const double h_s = horizon_s(mission, *covariance_m2_, 1 + static_cast<int>(forecasts),
                                 agent.counted, ticks_at(mission, agent.amendments, agent.counted));
    double time_s = 0;
    std::vector<double> sums(static_cast<std::size_t>(size));
    for (const auto& parts : team) {
      const Part& part = parts[at];
      const double gained_s = part.gained_steps > 0 ? part.gained_s : 0;
      const Tick age = std::max<Tick>(0, agent.counted - part.tick);
      const double till_rest_s = static_cast<double>(part.until - agent.counted) * dt_s;
      const double w_s = gained_s > 0 ? weight_s(mission, std::min(h_s, till_rest_s),
                                                 part.gained_steps, age, part.period)
                                      : 0;
      const double share = w_s > 0 ? w_s / gained_s : 0;
      time_s += part.quality * (part.time_s + w_s);
      for (std::size_t k = 0; k < sums.size(); ++k) {
        sums[k] += part.quality * (part.sums[k] + share * part.gains[k]);
      }
    }
    const std::vector<int>& modes = this->modes(mission)[at];
    for (std::size_t i = 0; i < modes.size() && time_s > 0; ++i) c[modes[i]] = sums[i] / time_s;
  }
  if (!targets_.empty()) c -= targets_.coverage_shift(mission, agent.counted);
  return c;
}

const WireModes& Shadow::modes(const Mission& mission) const {
  if (modes_.empty()) modes_ = modes_on_wire(mission);
  return modes_;
}

}  // namespace ergocast::lab
