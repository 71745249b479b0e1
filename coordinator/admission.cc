// SPDX-License-Identifier: BSD-3-Clause
// Refuses recordings, other versions and unknown kinds, and finds the lowest free number.
#include "coordinator/admission.h"

#include <algorithm>

#include "core/mission/kinds.h"
#include "core/motion/vehicle.h"

namespace ergocast {
namespace {

/// Limit (Team): computers with another version that a coordinator names. Beyond it: others are not
/// named.
constexpr std::size_t kMaxVersionMismatches = 64;
constexpr std::size_t kMaxUnknownKinds = 64;

/// Whether a member that counts as alive has sent nothing since `since`. It may have stopped, and
/// its number may soon be free.
bool may_have_stopped(const Members& members, Instant since, const SignsOfLife& signs) {
  const auto& roster = members.roster();
  return std::any_of(roster.begin(), roster.end(), [&](const RosterEntry& entry) {
    return signs.alive(entry) && signs.last(entry.author) < since;
  });
}

/// Whether an agent of kind `brought` may have a number. A place that is planned for another kind
/// stays free for that. Beyond the plan all bodies are vehicles of the first kind.
bool suits_number(const Mission& mission, const std::optional<int>& brought, AgentId id) {
  if (!brought) return true;
  const auto planned = static_cast<AgentId>(mission.starts_m.size());
  return id < planned ? planned_kind(mission, id) == *brought : can_drive(mission, *brought, id);
}

}  // namespace

void Admission::note_stranger(Incarnation incarnation, const Members& members, Instant now) {
  if (members.contains(incarnation)) return;
  if (heard_.size() >= kMaxRosterEntries) {
    std::erase_if(heard_, [now](const auto& old) { return now - old.second >= silence_of(0); });
  }
  if (heard_.size() < kMaxRosterEntries) heard_[incarnation] = now;
}

bool Admission::is_asked(PacingClock::duration span, Instant now) const {
  if (heard_.size() >= kMaxRosterEntries) return true;
  return std::any_of(heard_.begin(), heard_.end(),
                     [span, now](const auto& stranger) { return now - stranger.second < span; });
}

bool Admission::suits(const Hello& hello, const Mission& mission) {
  // It names no incarnation, or is of no agent.
  if (hello.header.incarnation == 0 || hello.header.sender < kUnassigned) return false;
  if (hello.requested_id < kUnassigned || hello.requested_id >= kMaxAgents) return false;
  if (hello.version != version_) {
    if (version_mismatches_.size() < kMaxVersionMismatches)
      version_mismatches_.emplace(hello.host, hello.version);
    return false;
  }
  if (const auto why = why_not_of_kind(mission, hello.kind, hello.requested_id)) {
    if (unknown_kinds_.size() < kMaxUnknownKinds) unknown_kinds_.emplace(hello.host, *why);
    return false;
  }
  return true;
}

std::optional<Newcomer> Admission::admitted(const Hello& hello, const Mission& mission,
                                            const Members& members, const SignsOfLife& signs,
                                            Announcement& announcement) {
  // This HELLO is older than the newest revision: its sender has not received that yet, or it is a
  // recording.
  if (hello.revision < announcement.admits_from()) {
    announcement.repeat_soon();
    return std::nullopt;
  }
  std::optional<AgentId> id = hello.requested_id;
  if (*id == kUnassigned) id = free_id(hello, mission, members, signs);
  if (!id || members.is_closed(*id))
    return std::nullopt;  // no number is free yet, or the team is full
  if (const RosterEntry* holder = members.active_entry(*id)) {
    if (signs.alive(*holder)) return std::nullopt;  // the holder of the number keeps it
    // The silence of a member matters only for its own number. On a network with long delays
    // members fall silent often, and no other agent's HELLO would ever be new enough.
    if (hello.revision < members.at(holder->author).silence_revision) {
      announcement.repeat_soon();
      return std::nullopt;
    }
  }
  const auto brought = kind_named(mission, hello.kind);
  return Newcomer{{*id, hello.header.incarnation}, brought.value_or(planned_kind(mission, *id))};
}

void Admission::forget(Incarnation newcomer) {
  asked_.erase(newcomer);
  heard_.erase(newcomer);
}

/// The time of the first request for any number.
Instant Admission::first_asked(Incarnation newcomer, Instant now) {
  if (asked_.size() >= kMaxRosterEntries) {
    asked_.erase(std::min_element(asked_.begin(), asked_.end(), [](const auto& a, const auto& b) {
      return a.second < b.second;
    }));
  }
  return asked_.try_emplace(newcomer, now).first->second;
}

std::optional<AgentId> Admission::free_id(const Hello& hello, const Mission& mission,
                                          const Members& members, const SignsOfLife& signs) {
  // A restarted process may succeed a member that still counts as alive. So it waits while
  // may_have_stopped() is true.
  const Instant since = first_asked(hello.header.incarnation, signs.now);
  if (may_have_stopped(members, since, signs)) return std::nullopt;
  const std::optional<int> brought = kind_named(mission, hello.kind);
  for (AgentId id = 0; id < kMaxAgents; ++id) {
    const RosterEntry* holder = members.active_entry(id);
    const bool is_free = holder == nullptr || !signs.alive(*holder);
    if (is_free && !members.is_closed(id) && suits_number(mission, brought, id)) return id;
  }
  return std::nullopt;
}

}  // namespace ergocast
