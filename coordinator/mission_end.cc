// SPDX-License-Identifier: BSD-3-Clause
// Remembers the first end, and the reports of the processes that leave.
#include "coordinator/mission_end.h"

#include <utility>

namespace ergocast {

bool MissionEnd::begin(std::string reason, Instant now) {
  if (since_) return false;
  since_ = now;
  reason_ = std::move(reason);
  return true;
}

void MissionEnd::take_over(const MissionFollower& known, Instant now) {
  reason_ = known.reason();
  if (known.over()) since_ = now;
}

bool MissionEnd::all_have_left(const Members& members, const SignsOfLife& signs) const {
  if (!world_left_ || !logger_left_) return false;
  const auto finished = [&members](const Author& author) {
    const auto& status = members.at(author).status;
    return status && status->phase == AgentPhase::kFinished;
  };
  return signs.me.team_has_left(members.roster(), finished, signs.now);
}

}  // namespace ergocast
