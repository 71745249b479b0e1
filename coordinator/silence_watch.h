// SPDX-License-Identifier: BSD-3-Clause
// Draws conclusions from the silence of members: a new revision of MISSION, and coverage that stops
// counting.
#pragma once

#include "coordinator/announcement.h"
#include "coordinator/members.h"
#include "coordinator/tick_watch.h"
#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Makes a new revision for each member that has fallen silent since the last call. The number of
/// such a member may go to a newcomer that has received this revision.
void note_silences(Members& members, const SignsOfLife& signs, Announcement& announcement);

class CoverageReview {
 public:
  /// Coverage under a number stops counting after the plan's time without a message under that
  /// number. It counts again after the next message. Each switch is a change of MISSION.
  void review(const Mission& mission, const TickWatch& ticks, Members& members,
              const SignsOfLife& signs, Announcement& announcement);

 private:
  Instant deaf_until_{};  // until then all members were silent
};

}  // namespace ergocast
