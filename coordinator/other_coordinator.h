// SPDX-License-Identifier: BSD-3-Clause
// What a coordinator knows of another one on its buses: a predecessor, a successor or a stranger.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "coordinator/members.h"
#include "core/base/ids.h"
#include "team/messages.h"

namespace ergocast {

class OtherCoordinator {
 public:
  /// Takes in its TEAM_STATUS. @pre the message is fresh
  void receive(const TeamStatus& status) { status_ = status; }
  bool alive(const SignsOfLife& signs) const;
  /// Whether it is this incarnation, and alive.
  bool alive_as(Incarnation incarnation, const SignsOfLife& signs) const;
  /// Whether it is alive and leads the mission that we would take over. While we know of no
  /// mission, any live coordinator counts.
  bool leads(const SignsOfLife& signs) const;
  /// A sentence to the operator that this coordinator leads the mission. @pre leads()
  std::string why_not_ours() const;

  /// The world uses `revision` of MISSION, and our newest one is `own`.
  void note_world(std::int64_t revision, std::int64_t own, Instant now);
  /// The newest revision that the world has used and we had not.
  std::int64_t newest_of_world() const { return newest_of_world_; }
  /// The revision that ours must exceed, if any. The world may name a revision of a predecessor
  /// that no agent received. The team then waits for that roster or a newer one, so we send a
  /// higher revision. But the world may also be the first to name a revision of a running
  /// coordinator that took over from us. So we first wait for messages of that coordinator.
  std::optional<std::int64_t> revision_to_exceed(std::int64_t own, const SignsOfLife& signs);

 private:
  std::optional<TeamStatus> status_;    // the newest
  std::int64_t newest_of_world_ = 0;    // a revision, …
  std::optional<Instant> newer_since_;  // … and since when it is newer than ours
};

}  // namespace ergocast
