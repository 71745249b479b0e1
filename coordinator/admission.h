// SPDX-License-Identifier: BSD-3-Clause
// Decides which agents may join the team, and assigns their numbers.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "coordinator/announcement.h"
#include "coordinator/members.h"
#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "team/messages.h"

namespace ergocast {

/// An agent that may join.
struct Newcomer {
  Author author;
  int kind;  ///< of core/mission/kinds.h
};

class Admission {
 public:
  /// @param version  the only one that agents may have
  explicit Admission(std::string version) : version_(std::move(version)) {}

  /// Notes a process that asks. If it is no member, it must receive the end of the mission, too.
  void note_stranger(Incarnation incarnation, const Members& members, Instant now);
  /// Whether a process that is no member may have asked within `span`.
  bool is_asked(PacingClock::duration span, Instant now) const;

  /// Whether `hello` is the request of an agent that the mission has a place for. It notes agents
  /// of another version or kind.
  bool suits(const Hello& hello, const Mission& mission);
  /// The agent that `hello` admits now, if any. If its sender must know a newer revision first,
  /// MISSION is repeated soon.
  /// @pre suits(hello, mission), its sender is no member, and note_silences() was called
  std::optional<Newcomer> admitted(const Hello& hello, const Mission& mission,
                                   const Members& members, const SignsOfLife& signs,
                                   Announcement& announcement);
  /// The process is a member now.
  void forget(Incarnation newcomer);

  /// Hosts and versions of agents that were refused because their version differs from ours.
  const std::set<std::pair<std::string, std::string>>& version_mismatches() const {
    return version_mismatches_;
  }
  /// Hosts of agents that were refused because the mission does not have their kind, and the
  /// sentence that says so.
  const std::set<std::pair<std::string, std::string>>& unknown_kinds() const {
    return unknown_kinds_;
  }

 private:
  Instant first_asked(Incarnation newcomer, Instant now);
  std::optional<AgentId> free_id(const Hello& hello, const Mission& mission, const Members& members,
                                 const SignsOfLife& signs);

  std::string version_;
  std::map<Incarnation, Instant> asked_;  // without a number: time of the first request
  std::map<Incarnation, Instant> heard_;  // last HELLO of each process that is no member
  std::set<std::pair<std::string, std::string>> version_mismatches_, unknown_kinds_;
};

}  // namespace ergocast
