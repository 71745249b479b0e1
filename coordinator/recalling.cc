// SPDX-License-Identifier: BSD-3-Clause
// Changes roster entries; each change is a new revision of MISSION.
#include "coordinator/recalling.h"

#include <algorithm>

namespace ergocast {
namespace {

/// Whether no other present member stays in the mission.
bool is_last(const Members& members, const RosterEntry& entry) {
  return std::ranges::none_of(members.roster(), [&](const RosterEntry& other) {
    return other.author != entry.author && other.active_until < 0 && !other.leaves;
  });
}

}  // namespace

void obey(const Recall& recall, Members& members, Announcement& announcement) {
  RosterEntry* const entry = members.active_entry(recall.agent);
  if (entry == nullptr || entry->leaves || (entry->recalled() && !recall.leaves)) return;
  if (recall.leaves && is_last(members, *entry)) return;
  announcement.change();
  if (!entry->recalled()) entry->recall_revision = announcement.revision();
  entry->leaves = recall.leaves;
}

void adopt_recalls(const std::vector<RosterEntry>& known, Members& members) {
  for (const RosterEntry& theirs : known) {
    RosterEntry* const ours =
        theirs.recalled() ? members.active_entry(theirs.author.agent) : nullptr;
    if (ours == nullptr) continue;
    if (!ours->recalled()) ours->recall_revision = theirs.recall_revision;
    ours->leaves = ours->leaves || theirs.leaves;
  }
}

void end_departed(Tick newest, const SignsOfLife& signs, Members& members,
                  Announcement& announcement) {
  for (RosterEntry& entry : members.roster()) {
    if (!entry.leaves || entry.active_until >= 0 || !signs.silent(entry.author)) continue;
    entry.active_until = newest;
    announcement.change();
  }
}

}  // namespace ergocast
