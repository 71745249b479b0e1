// SPDX-License-Identifier: BSD-3-Clause
// Adds a hold, or ends the last one, at a tick that all agents learn in time.
#include "coordinator/pausing.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace ergocast {
namespace {

/// Real time: the tick after the notice. It counts from the newest tick that the world can be at.
/// Nothing while the world is silent, because that tick is then unknown; the operator asks again.
std::optional<Tick> tick_with_notice(const Timing& timing, const TickWatch& ticks,
                                     const SignsOfLife& signs) {
  if (!ticks.world_heard() || signs.me.silent(kWorld, signs.now)) return std::nullopt;
  const double since_s = std::chrono::duration<double>(signs.now - ticks.since()).count();
  const auto since = static_cast<Tick>(since_s * timing.realtime_factor / timing.dt_s);
  return ticks.newest() + 1 + since + notice_ticks(timing);
}

}  // namespace

void Pausing::adopt(std::span<const Hold> known) {
  if (named_changes(known) > named_changes(holds_)) holds_.assign(known.begin(), known.end());
}

bool Pausing::may_change() const {
  const bool full = holds_.size() == kMaxHolds && !is_open(holds_);
  return stand_by_revision_ < 0 && !full;
}

void Pausing::obey(const Pause& pause, const Timing& timing, const TickWatch& ticks,
                   const SignsOfLife& signs, Announcement& announcement) {
  if (!may_change() || pause.changes != named_changes(holds_)) return;
  if (timing.pace == Pace::kRealtime) {
    if (const auto tick = tick_with_notice(timing, ticks, signs)) name_tick(*tick, announcement);
    return;
  }
  announcement.change();
  stand_by(announcement.revision());
}

void Pausing::note_world(const TickWatch& ticks, Announcement& announcement) {
  if (stand_by_revision_ < 0 || ticks.world_revision() < stand_by_revision_) return;
  // The world goes on once it knows the named tick. No agent answers the next tick before that.
  name_tick(ticks.tick() + 2, announcement);
}

/// The next hold begins, or the last one ends, with `tick`.
void Pausing::name_tick(Tick tick, Announcement& announcement) {
  stand_by_revision_ = -1;
  if (is_open(holds_)) {
    // Real time: the operator may resume before the hold has begun.
    holds_.back().until = std::max(tick, holds_.back().from + 1);
  } else {
    holds_.push_back({holds_.empty() ? tick : std::max(tick, holds_.back().until)});
  }
  announcement.change();
}

}  // namespace ergocast
