// SPDX-License-Identifier: BSD-3-Clause
// Collects the parts of each tick's state, up to a bounded number of ticks.
#include "logger/waiting_states.h"

#include <algorithm>
#include <iterator>

#include "core/law/lost_places.h"

namespace ergocast {

void WaitingStates::take(const WorldState& part, bool several_drivers) {
  const Tick tick = part.header.tick;
  if (states_.size() >= kMaxWaitingStates && !has(tick)) return;
  TickState& state = states_[tick];
  if (state.parts.complete()) return;
  if (state.parts.begun() && (several_drivers || state.parts.same(part))) {
    state.parts.add(part);
  } else {
    state.parts.begin(part);
    state.uncounted_ticks = part.uncounted_ticks;
    state.roster_revision = part.roster_revision;
    state.vehicles.clear();
  }
  for (const Vehicle& vehicle : part.vehicles_in_part()) state.vehicles[vehicle.id] = vehicle;
}

bool WaitingStates::complete(Tick tick) const {
  const auto state = states_.find(tick);
  return state != states_.end() && state->second.parts.complete();
}

int WaitingStates::add_lost(Tick tick, double dt_s) {
  const auto state = states_.find(tick), before = states_.find(tick - 1);
  if (before == states_.end()) return 0;
  int lost = 0;
  for (const auto& [id, vehicle] : before->second.vehicles) {
    if (state->second.vehicles.contains(id)) continue;
    const auto later = std::find_if(std::next(state), states_.end(), [id = id](const auto& one) {
      return one.second.vehicles.contains(id);
    });
    if (later == states_.end() || later->first > tick + kMostLostPlaces) continue;
    Vehicle between = vehicle;
    const double gap_s = static_cast<double>(later->first - tick + 1) * dt_s;
    between.velocity_mps = (later->second.vehicles.at(id).position_m - vehicle.position_m) / gap_s;
    between.position_m += between.velocity_mps * dt_s;
    between.detected = 0;
    between.reported_cell = kNoCell;
    state->second.vehicles.emplace(id, between);
    state->second.lost.insert(id);
    ++lost;
  }
  return lost;
}

std::optional<Tick> WaitingStates::first_pair() const {
  const auto pair =
      std::adjacent_find(states_.begin(), states_.end(), [](const auto& a, const auto& b) {
        return b.first == a.first + 1 && a.second.parts.complete() && b.second.parts.complete();
      });
  return pair == states_.end() ? std::nullopt : std::optional(pair->first);
}

}  // namespace ergocast
