// SPDX-License-Identifier: BSD-3-Clause
// Collects the parts of each tick's state, up to a bounded number of ticks.
#include "logger/waiting_states.h"

#include <algorithm>

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

std::optional<Tick> WaitingStates::first_pair() const {
  const auto pair =
      std::adjacent_find(states_.begin(), states_.end(), [](const auto& a, const auto& b) {
        return b.first == a.first + 1 && a.second.parts.complete() && b.second.parts.complete();
      });
  return pair == states_.end() ? std::nullopt : std::optional(pair->first);
}

}  // namespace ergocast
