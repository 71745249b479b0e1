// SPDX-License-Identifier: BSD-3-Clause
// The picture of a team as events of Cursor on Target: robots, zones, contacts and found objects.
// No clock, no I/O.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/tak/cot_event.h"
#include "cli/team/team_view.h"
#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast::cli {

/// Each event has the same uid as long as its mission lasts, also if processes or this one are
/// restarted.
class TeamEvents {
 public:
  /// @param origin  the place of the scenario's (0, 0)
  explicit TeamEvents(const GeoPlace& origin) : plane_(origin) {}

  /// The events that are due: each robot once a second, all else every five seconds. None if the
  /// mission is over or the world is silent, so that nothing old is shown as new. Call it a few
  /// times a second.
  std::vector<CotEvent> due(const TeamPicture& picture, const Mission& mission, Instant now);

 private:
  bool is_due(const CotEvent& event, PacingClock::duration period, Instant now);
  CotEvent event(const TeamPicture& picture, const std::string& what,
                 const Eigen::Vector2d& x_m) const;
  CotEvent robot(const TeamPicture& picture, const Mission& mission, const AgentRow& row);
  CotEvent zone(const TeamPicture& picture, const Mission& mission, const Zone& zone) const;
  CotEvent find(const TeamPicture& picture, const Find& find) const;
  CotEvent contact(const TeamPicture& picture, const Contact& contact) const;

  LocalPlane plane_;
  std::map<std::string, Instant> sent_;    // by uid
  std::map<AgentId, double> courses_deg_;  // the last of each robot that moved
};

}  // namespace ergocast::cli
