// SPDX-License-Identifier: BSD-3-Clause
// Where the vehicles of the present agents are, by the newest whole state of the world.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "coordinator/members.h"
#include "core/base/ids.h"
#include "core/motion/end_rules.h"
#include "team/messages.h"
#include "team/state_assembler.h"

namespace ergocast {

class TeamPlaces {
 public:
  /// A large team's state has several parts. Until all of them have arrived, the state before them
  /// counts.
  void note_world(const WorldState& part) {
    if (part.header.tick < parts_.tick()) return;
    if (parts_.same(part)) {
      parts_.add(part);
    } else {
      parts_.begin(part);
      arriving_m_.clear();
    }
    for (const Vehicle& vehicle : part.vehicles_in_part())
      arriving_m_[vehicle.id] = vehicle.position_m;
    if (!parts_.complete()) return;
    tick_ = part.header.tick;
    places_m_ = arriving_m_;
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
  ArrivedParts parts_;  // of the state that arrives
  std::map<AgentId, Eigen::Vector3d> arriving_m_;
};

}  // namespace ergocast
