// SPDX-License-Identifier: BSD-3-Clause
// Another display of a team, beside the page and in the same process.
#pragma once

#include <string>
#include <vector>

#include "cli/team/team_view.h"
#include "team/messages.h"
#include "team/mission_follower.h"

namespace ergocast {

class TeamDisplay {
 public:
  virtual ~TeamDisplay() = default;
  /// A part of the world's state, as it arrives; it may be repeated or old.
  virtual void show(const WorldState& /*world*/, const MissionFollower& /*team*/) {}
  /// New lines of the processes' logs, if this host has them.
  virtual void show(const std::vector<std::string>& /*lines*/) {}
  /// The team's picture, a few times a second. @pre team.mission() is known
  virtual void show(const TeamPicture& picture, const MissionFollower& team) = 0;

 protected:
  TeamDisplay() = default;
  TeamDisplay(const TeamDisplay&) = default;
  TeamDisplay(TeamDisplay&&) = default;
  TeamDisplay& operator=(const TeamDisplay&) = default;
  TeamDisplay& operator=(TeamDisplay&&) = default;
};

}  // namespace ergocast
