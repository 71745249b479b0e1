// SPDX-License-Identifier: BSD-3-Clause
// Names the ticks from which the mission is paused, and from which it goes on.
#include <algorithm>

#include "coordinator/coordinator.h"

namespace ergocast {

static_assert(kMaxHoldsPerMessage == 1, "mission_parts() puts one hold into a part");

/// All agents must change at the same tick. In lockstep the world first stands by: it stays at a
/// tick until it knows which one is named. In real time the team gets notice.
void Coordinator::on(const Pause& pause, const Arrival& arrival) {
  if (looking() || !may_change_holds() || pause.changes != named_changes(holds_)) return;
  if (timing().pace == Pace::kRealtime) return name_tick_with_notice(arrival.now);
  change();
  stand_by_revision_ = revisions_.current;
}

/// Whether the mission runs, and no other change waits for its tick.
bool Coordinator::may_change_holds() const {
  const bool full = holds_.size() == kMaxHolds && !is_open(holds_);
  return state_ == MissionState::kRunning && !ending_.since && stand_by_revision_ < 0 && !full;
}

/// Counts the notice from the newest tick that the world can be at. While the world is silent, that
/// tick is unknown and no tick is named; the operator asks again.
void Coordinator::name_tick_with_notice(Instant now) {
  if (!world_.heard || me_.silent(kWorld, now)) return;
  const double since_s = std::chrono::duration<double>(now - world_.tick_since).count();
  const auto since = static_cast<Tick>(since_s * timing().realtime_factor / timing().dt_s);
  name_tick(std::max(world_.tick, team_tick_) + 1 + since + notice_ticks(timing()));
}

/// The next hold begins, or the last one ends, with `tick`.
void Coordinator::name_tick(Tick tick) {
  stand_by_revision_ = -1;
  if (is_open(holds_)) {
    // Real time: the operator may resume before the hold has begun.
    holds_.back().until = std::max(tick, holds_.back().from + 1);
  } else {
    holds_.push_back({holds_.empty() ? tick : std::max(tick, holds_.back().until)});
  }
  change();
}

}  // namespace ergocast
