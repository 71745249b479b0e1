// SPDX-License-Identifier: BSD-3-Clause
// Sends agents home, or out of the mission, as the operator wishes. It writes the recall into the
// roster entry. All agents rest from the first tick for which the world uses that revision, so no
// process waits for another.
#pragma once

#include <vector>

#include "coordinator/announcement.h"
#include "coordinator/members.h"
#include "core/base/ids.h"
#include "core/mission/roster.h"
#include "team/messages.h"

namespace ergocast {

/// Obeys a wish of the operator. It has no effect if the number has no present member, the member
/// is recalled already, or it is the last one that is not sent out. An agent at home may still be
/// sent out.
/// @pre the mission runs
void obey(const Recall& recall, Members& members, Announcement& announcement);

/// Takes in the recalls that another coordinator has named: agents may have gone by them.
/// @param known  its roster
void adopt_recalls(const std::vector<RosterEntry>& known, Members& members);

/// Ends the entries of agents that were sent out and are silent: their last messages were lost, or
/// they had stopped before.
/// @param newest  the newest tick
void end_departed(Tick newest, const SignsOfLife& signs, Members& members,
                  Announcement& announcement);

}  // namespace ergocast
