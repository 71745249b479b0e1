// SPDX-License-Identifier: BSD-3-Clause
// A way out of dead ends: an agent that walls hold up keeps a hand on the wall for a while.
//
// The law pulls along straight lines, which walls can end. Modes of the free domain lead around
// walls. They do not lead around posts that are smaller than a cell of their grid.
//
// Every kWindow_s an agent looks back. It is in a dead end if it has moved less than a fifth as far
// as it wanted, and a wall was in its way for half of the time. Then it goes along the wall for 4
// s, on a random side; the next time for 8 s, and so on up to 120 s. After 30 s and twice as long a
// time without a dead end it begins at 4 s again. At an edge of the domain it turns round.
//
// This changes the velocity that the filter (core/motion/separation.h) is asked for, not what the
// filter allows.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mission/mission.h"

namespace ergocast {

/// Whether agents of a mission do so: there are walls.
inline bool follows_walls(const Mission& mission) { return !mission.walls.empty(); }

class WallFollower {
 public:
  static constexpr double kWindow_s = 2, kShortest_s = 4, kLongest_s = 120;

  WallFollower(const Mission& mission, AgentId id);

  /// The velocity to ask the filter for at a tick: `wanted_mps` bit for bit, or the same speed
  /// along the wall, at most the speed limit. It depends on the seed and on earlier calls. Does not
  /// allocate.
  Eigen::Vector3d aim(Tick tick, const Eigen::Vector3d& x_m, const Eigen::Vector3d& wanted_mps);
  /// Notes whether a wall was in the way of the last aim().
  void note(bool wall) { wall_ticks_ += wall ? 1 : 0; }

  bool follows() const { return follows_; }

 private:
  void look_back(Tick tick, const Eigen::Vector3d& x_m);
  void begin_window(Tick tick, const Eigen::Vector3d& x_m);
  double seconds_since(Tick tick, Tick before) const;
  Eigen::Vector2d along_wall(const Eigen::Vector2d& x_m);
  std::span<const std::uint32_t> nearest_edges(const Eigen::Vector2d& x_m, double within_m);
  double in_the_way(const Eigen::Vector2d& x_m, const Eigen::Vector2d& way, double at_hand_m) const;
  bool at_edge(const Eigen::Vector3d& x_m, const Eigen::Vector2d& way) const;

  std::uint64_t seed_;
  double dt_s_;
  Box domain_;
  IndexedRings walls_;
  std::vector<std::uint32_t> near_;  // scratch
  AgentId id_;
  double limit_mps_, kept_m_, reach_m_;
  bool follows_ = false;
  double side_ = 1;      // 1: the wall is to the left
  double length_s_ = 0;  // of the last time along a wall
  Tick since_ = 0;       // tick since which it follows, or has ceased to
  Tick window_ = -1;     // its first tick; −1: none yet
  Eigen::Vector3d from_m_{0, 0, 0};
  double wanted_m_ = 0;  // the way asked for in the window
  std::int64_t wall_ticks_ = 0, ticks_ = 0;
};

}  // namespace ergocast
