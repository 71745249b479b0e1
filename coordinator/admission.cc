// SPDX-License-Identifier: BSD-3-Clause
// Decides which agents may join the team, and assigns their numbers.
#include <algorithm>
#include <utility>

#include "coordinator/coordinator.h"
#include "core/mission/kinds.h"
#include "core/motion/vehicle.h"

namespace ergocast {
namespace {

/// Limit (Team): computers with another version that a coordinator names. Beyond it: others are not
/// named.
constexpr std::size_t kMaxVersionMismatches = 64;
constexpr std::size_t kMaxUnknownKinds = 64;

}  // namespace

RosterEntry* Coordinator::active_entry(AgentId id) {
  const auto at = std::find_if(roster_.begin(), roster_.end(), [id](const RosterEntry& entry) {
    return entry.author.agent == id && entry.active_until < 0;
  });
  return at == roster_.end() ? nullptr : &*at;
}

/// Whether a member that counts as alive has sent nothing since `since`. It may have stopped, and
/// its number may soon be free.
bool Coordinator::may_have_stopped(Instant since, Instant now) const {
  return std::any_of(roster_.begin(), roster_.end(), [&](const RosterEntry& entry) {
    return alive(entry, now) && last_sign(entry.author) < since;
  });
}

std::optional<AgentId> Coordinator::free_id(Incarnation newcomer, const std::string& kind,
                                            Instant now) {
  // A restarted process may succeed a member that still counts as alive. So it waits while
  // may_have_stopped() is true.
  if (newcomers_.asked.size() >= kMaxRosterEntries) {
    auto& asked = newcomers_.asked;
    asked.erase(std::min_element(asked.begin(), asked.end(),
                                 [](const auto& a, const auto& b) { return a.second < b.second; }));
  }
  const Instant since = newcomers_.asked.try_emplace(newcomer, now).first->second;
  if (may_have_stopped(since, now)) return std::nullopt;
  const Mission& mission = *led_.mission;
  const auto planned = static_cast<AgentId>(mission.starts_m.size());
  const std::optional<int> brought = kind_named(mission, kind);
  // A place that is planned for another kind stays free for that. Beyond the plan all bodies are
  // vehicles of the first kind.
  const auto suits = [&](AgentId id) {
    if (!brought) return true;
    return id < planned ? planned_kind(mission, id) == *brought : can_drive(mission, *brought, id);
  };
  for (AgentId id = 0; id < kMaxAgents; ++id) {
    const RosterEntry* holder = active_entry(id);
    if ((holder == nullptr || !alive(*holder, now)) && suits(id)) return id;
  }
  return std::nullopt;
}

/// Notes a process that is no member: it must receive the end of the mission, too.
void Coordinator::note_stranger(Incarnation incarnation, Instant now) {
  const bool known = std::any_of(roster_.begin(), roster_.end(), [&](const RosterEntry& entry) {
    return entry.author.incarnation == incarnation;
  });
  if (known) return;
  auto& heard = newcomers_.heard;
  if (heard.size() >= kMaxRosterEntries) {
    std::erase_if(heard, [now](const auto& old) { return now - old.second >= silence_of(0); });
  }
  if (heard.size() < kMaxRosterEntries) heard[incarnation] = now;
}

void Coordinator::on(const Hello& hello, const Arrival& arrival) {
  const Instant now = arrival.now;
  if (looking()) return;
  if (hello.header.sender >= kUnassigned) note_stranger(hello.header.incarnation, now);
  if (state_ == MissionState::kEnded || state_ == MissionState::kFailed) return;
  const Incarnation nonce = hello.header.incarnation;
  if (hello.header.sender == kWorld) return on_question(hello, arrival);
  if (nonce == 0 || hello.header.sender < kUnassigned) return;  // no incarnation, or no agent
  if (hello.requested_id < kUnassigned || hello.requested_id >= kMaxAgents) return;
  if (hello.version != name_.version) {
    auto& version_mismatches = newcomers_.version_mismatches;
    if (version_mismatches.size() < kMaxVersionMismatches)
      version_mismatches.emplace(hello.host, hello.version);
    return;
  }
  if (const auto why = why_not_of_kind(*led_.mission, hello.kind, hello.requested_id)) {
    auto& unknown_kinds = newcomers_.unknown_kinds;
    if (unknown_kinds.size() < kMaxUnknownKinds) unknown_kinds.emplace(hello.host, *why);
    return;
  }
  const bool known = std::any_of(roster_.begin(), roster_.end(), [nonce](const RosterEntry& entry) {
    return entry.author.incarnation == nonce;
  });
  if (known) return repeat_mission_soon();
  note_silences(now);
  // This HELLO is older than the newest revision: its sender has not received that yet, or it is a
  // recording.
  if (hello.revision < revisions_.admits_from) return repeat_mission_soon();
  std::optional<AgentId> id = hello.requested_id;
  if (*id == kUnassigned) id = free_id(nonce, hello.kind, now);
  if (!id) return;  // no number is free yet, or the team is full
  if (const RosterEntry* holder = active_entry(*id)) {
    if (alive(*holder, now)) return;  // the holder of the number keeps it
    // The silence of a member matters only for its own number. On a network with long delays
    // members fall silent often, and no other agent's HELLO would ever be new enough.
    if (hello.revision < members_[holder->author].silence_revision) return repeat_mission_soon();
  }
  const auto brought = kind_named(*led_.mission, hello.kind);
  admit({*id, nonce}, brought.value_or(planned_kind(*led_.mission, *id)), now);
}

void Coordinator::admit(const Author& author, int kind, Instant now) {
  const auto incarnations =
      std::count_if(roster_.begin(), roster_.end(),
                    [&](const RosterEntry& entry) { return entry.author.agent == author.agent; });
  if (roster_.size() >= kMaxRosterEntries || incarnations >= kMaxIncarnationsPerAgent) return;
  // The world may have stopped since its last state. The agents may then be ahead of that state.
  const Tick newest = std::max(world_.tick, team_tick_);
  if (RosterEntry* former = active_entry(author.agent)) former->active_until = newest;
  const Tick from = state_ == MissionState::kRunning ? newest : 0;
  roster_.push_back({author, from, -1});
  roster_.back().kind = kind;
  std::sort(roster_.begin(), roster_.end(),
            [](const RosterEntry& a, const RosterEntry& b) { return a.author < b.author; });
  members_[author];
  admissions_.emplace(author, admissions_.size());
  me_.presume_alive(author, now);
  newcomers_.asked.erase(author.incarnation);
  newcomers_.heard.erase(author.incarnation);
  world_.tick_since = now;  // the tick also waits for the newcomer, which gets the full time
  announce();
}

}  // namespace ergocast
