// SPDX-License-Identifier: BSD-3-Clause
// Where the vehicles of the present agents are, by the newest state of each.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "coordinator/members.h"
#include "core/base/ids.h"
#include "core/motion/end_rules.h"
#include "team/messages.h"

namespace ergocast {

class TeamPlaces {
 public:
  /// A part of a large team's state, or the state of one vehicle by its own driver. Drivers go by
  /// their own clocks, so the ticks of places may differ. An older place has no effect.
  void note_world(const WorldState& part) {
    for (const Vehicle& vehicle : part.vehicles_in_part()) {
      Known& known = known_[vehicle.id];
      if (part.header.tick >= known.tick) known = {part.header.tick, vehicle.position_m};
    }
  }

  /// The present agents.
  std::vector<AgentPlace> of(const std::vector<RosterEntry>& roster) const {
    std::vector<AgentPlace> agents;
    for (const RosterEntry& entry : roster) {
      if (entry.active_until >= 0) continue;
      const auto found = known_.find(entry.author.agent);
      agents.push_back({entry.author.agent, found == known_.end() ? std::optional<Eigen::Vector3d>()
                                                                  : found->second.x_m});
    }
    return agents;
  }

  /// The oldest tick of a present agent's place; −1: no place is known.
  Tick tick(const std::vector<RosterEntry>& roster) const {
    Tick oldest = std::numeric_limits<Tick>::max();
    for (const RosterEntry& entry : roster) {
      const auto found = known_.find(entry.author.agent);
      if (entry.active_until < 0 && found != known_.end())
        oldest = std::min(oldest, found->second.tick);
    }
    return oldest == std::numeric_limits<Tick>::max() ? -1 : oldest;
  }

 private:
  struct Known {
    Tick tick = -1;
    Eigen::Vector3d x_m = Eigen::Vector3d::Zero();
  };
  std::map<AgentId, Known> known_;
};

}  // namespace ergocast
