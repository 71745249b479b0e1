// SPDX-License-Identifier: BSD-3-Clause
// Recalls agents for the operator: sends them home, or out of the mission. A recall is a change of
// the agent's roster entry. The agent rests from the first tick for which the world uses that
// revision of the roster. All agents see this at the same tick, so no process waits for another.
#pragma once

#include <vector>

#include "coordinator/announcement.h"
#include "coordinator/members.h"
#include "core/base/ids.h"
#include "core/mission/roster.h"
#include "team/messages.h"

namespace ergocast {

/// Obeys a RECALL of the operator. It has no effect if the number has no present member, or the
/// member is recalled already. An agent at home may still be sent out. The last member that stays
/// in the mission cannot be sent out.
/// @pre the mission runs
void obey(const Recall& recall, Members& members, Announcement& announcement);

/// Adopts the recalls of another coordinator, because agents may have obeyed them.
/// @param known  that coordinator's roster
void adopt_recalls(const std::vector<RosterEntry>& known, Members& members);

/// Ends the roster entries of agents that were sent out and are silent. Their last messages were
/// lost, or their processes had stopped before.
/// @param newest  the newest tick
void end_departed(Tick newest, const SignsOfLife& signs, Members& members,
                  Announcement& announcement);

}  // namespace ergocast
