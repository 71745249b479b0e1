// SPDX-License-Identifier: BSD-3-Clause
// Keeps the roster in order, and remembers in which order its entries were added.
#include "coordinator/members.h"

#include <algorithm>
#include <utility>

namespace ergocast {

const RosterEntry* Members::active_entry(AgentId id) const {
  const auto at = std::find_if(roster_.begin(), roster_.end(), [id](const RosterEntry& entry) {
    return entry.author.agent == id && entry.active_until < 0;
  });
  return at == roster_.end() ? nullptr : &*at;
}

RosterEntry* Members::active_entry(AgentId id) {
  return const_cast<RosterEntry*>(std::as_const(*this).active_entry(id));
}

const RosterEntry* Members::recalled_entry(AgentId id) const {
  const auto at = std::ranges::find_if(roster_, [id](const RosterEntry& entry) {
    return entry.author.agent == id && entry.recalled();
  });
  return at == roster_.end() ? nullptr : &*at;
}

bool Members::is_closed(AgentId id) const {
  return std::ranges::any_of(
      roster_, [id](const RosterEntry& entry) { return entry.author.agent == id && entry.leaves; });
}

bool Members::contains(Incarnation incarnation) const {
  return std::any_of(roster_.begin(), roster_.end(), [incarnation](const RosterEntry& entry) {
    return entry.author.incarnation == incarnation;
  });
}

int Members::alive_count(const SignsOfLife& signs) const {
  return static_cast<int>(
      std::count_if(roster_.begin(), roster_.end(),
                    [&signs](const RosterEntry& entry) { return signs.alive(entry); }));
}

bool Members::have_room(AgentId id) const {
  const auto incarnations =
      std::count_if(roster_.begin(), roster_.end(),
                    [id](const RosterEntry& entry) { return entry.author.agent == id; });
  return roster_.size() < kMaxRosterEntries && incarnations < kMaxIncarnationsPerAgent;
}

void Members::add(const RosterEntry& entry) {
  const auto after = std::upper_bound(
      roster_.begin(), roster_.end(), entry,
      [](const RosterEntry& a, const RosterEntry& b) { return a.author < b.author; });
  roster_.insert(after, entry);
  members_.try_emplace(entry.author, Member{members_.size()});
}

Member* Members::find(const Author& author) {
  const auto at = members_.find(author);
  return at == members_.end() ? nullptr : &at->second;
}

AgentId Members::waits_for(const RosterEntry& entry) const {
  const auto& status = at(entry.author).status;
  return status ? status->waiting_for : kUnassigned;
}

}  // namespace ergocast
