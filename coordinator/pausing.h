// SPDX-License-Identifier: BSD-3-Clause
// Names the ticks from which the mission is paused, and from which it goes on.
//
// All agents must change at the same tick. In lockstep the world first stands by: it stays at a
// tick until it knows which one is named. In real time the team gets notice.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "coordinator/announcement.h"
#include "coordinator/members.h"
#include "coordinator/tick_watch.h"
#include "core/mission/hold.h"
#include "core/mission/mission.h"
#include "team/messages.h"

namespace ergocast {

class Pausing {
 public:
  const std::vector<Hold>& holds() const { return holds_; }
  /// See MissionPart.
  std::int64_t stand_by_revision() const { return stand_by_revision_; }

  /// The holds that are known from the beginning. @pre are_holds(holds)
  void plan(std::vector<Hold> holds) { holds_ = std::move(holds); }
  /// Takes in the holds of another coordinator, if it has named more changes than we know. What it
  /// paused stays paused, because agents may have gone by it. @pre are_holds(known)
  void adopt(std::span<const Hold> known);
  /// The world stands by from `revision` on.
  void stand_by(std::int64_t revision) { stand_by_revision_ = revision; }

  /// Obeys a wish of the operator. It has no effect if it does not follow the newest change, or
  /// another change waits for its tick, or the tick of the world is unknown in real time.
  /// @pre the mission runs
  void obey(const Pause& pause, const Timing& timing, const TickWatch& ticks,
            const SignsOfLife& signs, Announcement& announcement);

  /// Lockstep: names a tick if the world stands by.
  void note_world(const TickWatch& ticks, Announcement& announcement);

 private:
  bool may_change() const;
  void name_tick(Tick tick, Announcement& announcement);

  std::vector<Hold> holds_;
  std::int64_t stand_by_revision_ = -1;  // lockstep: the next tick of holds_ is to be named
};

}  // namespace ergocast
