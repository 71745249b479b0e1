// SPDX-License-Identifier: BSD-3-Clause
// The way home of an agent: when it begins for an agent that has a station
// (core/mission/station.h), and the velocity that the agent asks the filter for. An agent that the
// operator sends home goes at once.
//
// At a tick t that counts, from a place whose way home is w long, an agent goes home if
//
//   (R − t) dt ≤ w / v + slack,   v: home_speed_mps()
//
// and then it does not turn back. The way leads around walls, core/motion/way_around.h. The slack
// is 2 dt and what a vehicle loses: with inertia 3 v/A, to turn round and to brake; to turn on the
// spot π/ω, and for a fixed wing three circles, three times as much among walls; and what
// disturbances, old commands in real time and a late answer may cost. It does not contain detours
// around teammates: reserve_s is for those. On a plane the agent goes round bodies that stand for
// good, core/motion/detour.h.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "core/mission/zones.h"
#include "core/motion/detour.h"
#include "core/motion/vehicle.h"
#include "core/motion/way_around.h"

namespace ergocast {

/// What a vehicle of agent `id` may lose on a way, at its own speed [s]: the slack above.
double slack_on_way_s(const Mission& mission, AgentId id);
/// What disturbances may cost on a way that takes so long [s].
double drift_on_way_s(const Mission& mission, AgentId id, double travel_s);

class WayHome {
 public:
  /// @pre the agent has a home, home_of()
  WayHome(const Mission& mission, AgentId id);

  /// An upper bound of the time that the way home takes from `x_m` without others in the way [s];
  /// infinite where there is no way.
  double needed_s(const Eigen::Vector3d& x_m) const;

  /// From now on the agent has to be at its station from another tick on. If that is later, it may
  /// turn back.
  void set_rest(Tick counted);
  /// Whether the agent goes home at a tick, by its number among those that count. Once it does, it
  /// goes on. @pre the agent has a station
  bool begun(Tick counted, const Eigen::Vector3d& x_m);
  bool begun() const { return begun_; }

  /// From now on the way leads round these zones, too, which are closed. The agent may turn back.
  /// In a box the way stays straight.
  void note_zones(const Mission& mission, std::vector<Zone> zones);

  /// Takes the bodies that stand for good. velocity_mps() leads round them.
  Detour& detour() { return detour_; }

  /// The velocity to ask the filter for, on the way and to stay at the station; ‖v‖ ≤
  /// home_speed_mps(). Does not allocate.
  Eigen::Vector3d velocity_mps(const Eigen::Vector3d& x_m, const Eigen::Vector3d& v_mps);

 private:
  double speed_mps(double way_m) const;
  Eigen::Vector3d turning_mps(const Eigen::Vector3d& to_m, double way_m,
                              const Eigen::Vector3d& v_mps) const;

  Motion motion_;
  Eigen::Vector3d home_m_;
  Tick rest_from_;
  double speed_mps_, slack_s_;
  double ahead_;  // the cosine of the angle within which it goes on
  double drift_;  // 4 σ / v; times √ of the way's time it is what disturbances cost
  WayAround way_;
  Detour detour_;
  bool begun_ = false;
};

}  // namespace ergocast
