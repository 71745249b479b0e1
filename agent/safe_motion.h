// SPDX-License-Identifier: BSD-3-Clause
// From the velocity that the law wants to the command of the vehicle, in five steps:
//
// 0. a vehicle in a zone (core/motion/zones.h) leaves it, whatever else holds, even in a pause;
// 1. the way home takes the law's place, once it has begun (core/motion/way_home.h), also for an
//    agent that was recalled or whose battery needs it; one that has no home stays where it is. The
//    way leads round bodies that no agent drives, as those of agents that were sent out;
// 2. an agent that walls hold up goes along the wall, but not on its way home
//    (core/motion/wall_following.h);
// 3. the filter keeps the vehicle apart from walls, edges and the bodies of TeamBodies
//    (core/motion/separation.h);
// 4. ticks at which it leaves almost nothing are counted for the status.
//
// A mission without a station, walls or bodies leaves the velocity as it is, bit for bit.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "agent/agent_step.h"
#include "agent/team_bodies.h"
#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "core/mission/roster.h"
#include "core/mission/zones.h"
#include "core/motion/charge.h"
#include "core/motion/separation.h"
#include "core/motion/wall_following.h"
#include "core/motion/way_home.h"
#include "core/motion/way_out.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

/// The ticks at which something was in the way, as AgentStatus has them.
struct BlockedTicks {
  AgentId by = kUnassigned;
  std::int64_t now = 0, all = 0, longest = 0;

  void note(const SafeVelocity& safe);
};

class SafeMotion {
 public:
  /// @param self  the agent whose vehicle it is
  /// @param revision  of the roster in which it found itself
  SafeMotion(const Mission& mission, const Author& self, std::int64_t revision);

  void on(const WorldState& world);
  /// Takes in which bodies an agent drives. No other call allocates memory for it.
  void note_roster(const std::vector<RosterEntry>& roster);
  /// Takes in the zones of the newest list.
  void note_zones(const std::vector<Zone>& zones, const Mission& mission);
  TeamBodies& bodies() { return bodies_; }
  const TeamBodies& bodies() const { return bodies_; }

  /// Whether commands are filtered. The vehicle may then be outside of the domain.
  bool filters() const { return filters_; }
  /// Whether a tick can be answered: only once the position of every body is known.
  bool knows_bodies(Tick tick) const { return !filters_ || bodies_.complete(tick); }

  /// Takes in from which counted tick on an agent with a station rests.
  void set_rest(Tick counted) {
    if (has_station_) way_home_->set_rest(counted);
  }
  bool has_station() const { return has_station_; }
  /// Whether it has begun the way to its station.
  bool returns() const {
    return (way_home_ && way_home_->begun()) || (charge_ && charge_->must_go());
  }
  /// Prepares the way home of an agent that is recalled.
  void prepare_recall(const Mission& mission);
  /// Whether the vehicle is at home, or has none. @pre prepare_recall() was called
  bool is_home(const Mission& mission, const Eigen::Vector3d& x_m) const;

  /// The velocity to command where the law wants `wanted_mps`. In a pause the way home does not
  /// begin or go on.
  Eigen::Vector3d command_mps(const Eigen::Vector3d& wanted_mps, const AgentStep& step,
                              const Participant& me);
  const BlockedTicks& blocked() const { return blocked_; }

 private:
  std::optional<Eigen::Vector3d> way_out_mps(const AgentStep& step, const Participant& me);
  void use_zones(Tick tick, const Mission& mission);
  bool goes_home(const AgentStep& step);
  Eigen::Vector3d aim_mps(const Eigen::Vector3d& wanted_mps, const AgentStep& step,
                          const Participant& me);
  void note_standing_bodies(const Mover& self, const AgentStep& step, const Participant& me);
  Mover mover(const AgentStep& step, const Participant& me) const;
  SafeVelocity safe(const Eigen::Vector3d& aim_mps, const AgentStep& step, const Participant& me);

  AgentId id_;
  TeamBodies bodies_;
  bool filters_;                                // always, not only while there are zones
  std::optional<SeparationFilter> separation_;  // if it filters, or zones were announced
  std::vector<Zone> zones_;                     // of the list
  std::vector<Zone> zones_in_use_;              // those that are closed
  std::optional<WayOut> way_out_;               // of these; made when it is first needed
  std::optional<WallFollower> wall_follower_;   // where there are walls
  bool has_station_;
  std::optional<ChargeWatch> charge_;  // if its vehicle has a battery
  std::optional<WayHome> way_home_;    // if it has a station, or was recalled and has a home
  std::vector<AgentId> undriven_;      // bodies without an agent, ascending
  BlockedTicks blocked_;
};

}  // namespace ergocast
