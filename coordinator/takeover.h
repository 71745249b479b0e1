// SPDX-License-Identifier: BSD-3-Clause
// The search of a coordinator for a mission that is under way. It listens, and asks the agents,
// which repeat what they know of MISSION.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/members.h"
#include "coordinator/other_coordinator.h"
#include "core/base/ids.h"
#include "team/mission_follower.h"

namespace ergocast {

/// The reaction of a coordinator to a mission that is already under way on its buses.
enum class Takeover {
  kNever,      ///< starts a mission of its own at once
  kIfRunning,  ///< listens for a moment; leaves if a coordinator leads the mission, else takes the
               ///< mission over, or starts its own if there is none
  kMust,       ///< takes over, also from a running coordinator, or fails
};

/// The first revision of a coordinator that takes a mission over at `tick`. It exceeds those of
/// former successors, also those that only unreachable agents know: a later takeover gets higher
/// revisions.
std::int64_t first_revision(const MissionFollower& known, Tick tick);

/// SignsOfLife::me follows the parts of MISSION that agents repeat.
class MissionSearch {
 public:
  enum class Outcome {
    kNone,        ///< the search goes on
    kFound,       ///< a mission is known
    kNoMission,   ///< there is none
    kLedByOther,  ///< another coordinator leads it
    kNoAnswer,    ///< no agent has repeated a mission in time
  };

  explicit MissionSearch(Takeover takeover) : takeover_(takeover) {}

  /// Whether the search goes on.
  bool looking() const { return takeover_ != Takeover::kNever; }
  void end() { takeover_ = Takeover::kNever; }
  /// An agent has repeated a whole mission.
  void note_mission(Instant now);

  Outcome look(const OtherCoordinator& other, const SignsOfLife& signs);
  /// Whether a question to the agents is due now. The next one is due later.
  bool is_question_due(Instant now);
  /// The next time at which look() or a question is due.
  Instant next_look(const OtherCoordinator& other, const MissionFollower& known) const;

  /// Why the mission that was found cannot be taken over; nothing if it can.
  /// @param plan  of the mission that we would start; empty: any mission is accepted
  std::optional<std::string> why_not(const std::vector<std::byte>& plan,
                                     const OtherCoordinator& other, const SignsOfLife& signs) const;

 private:
  Instant end_of_search(const OtherCoordinator& other, const MissionFollower& known) const;

  Takeover takeover_;
  std::optional<Instant> since_, found_;
  Instant next_question_{};
};

}  // namespace ergocast
