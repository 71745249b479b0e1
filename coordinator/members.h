// SPDX-License-Identifier: BSD-3-Clause
// The present and former members of the team: their roster entries, and the last status of each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/roster.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

/// The signs of life that have arrived until `now`.
struct SignsOfLife {
  const Participant& me;
  Instant now;

  bool silent(const Author& author) const { return me.silent(author, now); }
  /// Whether the entry is of a present member that is not silent.
  bool alive(const RosterEntry& entry) const {
    return entry.active_until < 0 && !silent(entry.author);
  }
  /// The last sign of an incarnation; the beginning of the clock if there was none.
  Instant last(const Author& author) const {
    return me.liveness().last_sign(author).value_or(Instant{});
  }
};

/// What the coordinator knows of a member besides its roster entry.
struct Member {
  std::size_t place = 0;                ///< of its entry in MISSION, in the order of admission
  std::optional<AgentStatus> status{};  ///< the newest; nothing: none was received
  bool silence_reported = false;
  std::int64_t silence_revision = -1;  ///< the revision of MISSION after its last silence began
};

class Members {
 public:
  /// In ascending order of authors.
  const std::vector<RosterEntry>& roster() const { return roster_; }
  /// The caller may change all of an entry but its author.
  std::vector<RosterEntry>& roster() { return roster_; }
  /// The present member under a number; null if there is none.
  const RosterEntry* active_entry(AgentId id) const;
  RosterEntry* active_entry(AgentId id);
  /// A present or former member under a number that was recalled; null if there is none. All that
  /// follow it are recalled, too.
  const RosterEntry* recalled_entry(AgentId id) const;
  /// Whether the number's last member was sent out of the mission. It then stays empty.
  bool is_closed(AgentId id) const;
  /// Whether a process is a present or former member.
  bool contains(Incarnation incarnation) const;
  int alive_count(const SignsOfLife& signs) const;

  /// Whether roster and number have room for another incarnation.
  bool have_room(AgentId id) const;
  /// @pre have_room(entry.author.agent), and its author is no present or former member
  void add(const RosterEntry& entry);

  /// What is known of all of them.
  const std::map<Author, Member>& all() const { return members_; }
  /// Null if `author` is no present or former member.
  Member* find(const Author& author);
  /// @pre `author` is a present or former member
  const Member& at(const Author& author) const { return members_.at(author); }
  Member& at(const Author& author) { return members_.at(author); }
  /// The process that a member waits for, as its last status reports; kUnassigned: none.
  AgentId waits_for(const RosterEntry& entry) const;

 private:
  std::vector<RosterEntry> roster_;
  std::map<Author, Member> members_;
};

}  // namespace ergocast
