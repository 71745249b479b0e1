// SPDX-License-Identifier: BSD-3-Clause
// The way out of zones (core/motion/zones.h) for an agent that must leave them.
//
// The domain is a grid. A cell is outside if its centre keeps its distance from walls and zones.
// The agent moves straight to the nearest such cell that it can see: no wall is in the way, and no
// zone that it is not in. If it sees none, it follows the shortest way along cells. In a box it
// also may leave upwards or downwards, if that is nearer. It does not slow down at the end, so it
// is outside one step later at most.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "core/mission/zones.h"
#include "core/motion/free_region.h"
#include "core/motion/vehicle.h"
#include "core/motion/zones.h"

namespace ergocast {

class WayOut {
 public:
  /// @param zones  all that are closed, or will be
  WayOut(const Mission& mission, AgentId id, std::span<const Zone> zones);
  /// The ways out of one zone, beside others that bind already.
  WayOut(const Mission& mission, AgentId id, const Zone& zone, std::span<const Zone> others);

  /// Whether any place of the domain is outside of all zones.
  bool any_outside() const { return !outside_.empty(); }
  /// The longest way out from any free place of the zone, as seen from above [m]; infinite if there
  /// is none.
  double longest_m() const;
  /// How long a way takes without others in the way [s].
  static double needed_s(const Mission& mission, AgentId id, double way_m);
  /// The first agent of this one's kind that has a station to which no way outside leads from the
  /// largest part.
  std::optional<AgentId> station_cut_off(const Mission& mission) const;

  /// The velocity that leads a body out of the zones that do not bind it; 0 if no way leads out.
  Eigen::Vector3d velocity_mps(Tick tick, const Eigen::Vector3d& x_m, const Eigen::Vector3d& v_mps);

 private:
  bool beside_all(const Eigen::Vector3d& x_m) const;
  void find_ways(unsigned left);
  bool clear(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const;
  std::optional<Eigen::Vector2d> nearest_seen_m(const Eigen::Vector2d& x_m) const;
  std::optional<Eigen::Vector2d> along_cells_m(const Eigen::Vector2d& x_m) const;
  std::optional<double> height_outside_m(const Eigen::Vector3d& x_m) const;

  AgentId id_;
  Motion motion_;
  Box room_;  // where the anchor may be
  IndexedRings walls_;
  std::vector<Zone> zones_;
  double speed_mps_, kept_m_, bound_m_,
      seen_m_;  // seen_m_: how far a straight way keeps from walls
  FreeRegion region_;
  std::vector<int> outside_;    // cells
  unsigned left_ = 0;           // the zones of ways_m_, a bit each: those that do not bind
  std::vector<double> ways_m_;  // from each cell
};

}  // namespace ergocast
