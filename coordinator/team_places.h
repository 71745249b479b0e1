// SPDX-License-Identifier: BSD-3-Clause
// Where the vehicles of the present agents are, by the newest states of the world.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "coordinator/members.h"
#include "core/base/ids.h"
#include "core/motion/end_rules.h"
#include "team/messages.h"

namespace ergocast {

class TeamPlaces {
 public:
  void note_world(const WorldState& world) {
    if (world.header.tick < tick_) return;
    if (world.header.tick > tick_) places_m_.clear();
    tick_ = world.header.tick;
    for (const Vehicle& vehicle : world.vehicles_in_part())
      places_m_[vehicle.id] = vehicle.position_m;
  }

  /// The tick of all places.
  Tick tick() const { return tick_; }
  /// The present agents.
  std::vector<AgentPlace> of(const std::vector<RosterEntry>& roster) const {
    std::vector<AgentPlace> agents;
    for (const RosterEntry& entry : roster) {
      if (entry.active_until >= 0) continue;
      const auto found = places_m_.find(entry.author.agent);
      agents.push_back({entry.author.agent, found == places_m_.end()
                                                ? std::optional<Eigen::Vector3d>()
                                                : found->second});
    }
    return agents;
  }

 private:
  Tick tick_ = -1;
  std::map<AgentId, Eigen::Vector3d> places_m_;
};

}  // namespace ergocast
