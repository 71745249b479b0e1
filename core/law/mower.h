// SPDX-License-Identifier: BSD-3-Clause
// The law that mows: each agent goes to and fro over an equal mass of the target, in lanes.
//
// The domain is divided into as many rectangles, in a box into as many boxes, as there are agents
// whose coverage counts and that were not recalled: of equal mass (core/law/equal_shares.h). Agents
// that rest by plan keep their share. A share has lanes along its longest side. In a plane they are
// at most two radii of the sensor (core/measure/detection.h) apart; in a box lie layers of lanes,
// and both are at most √2 radii apart. A lane goes from its first to its last cell with at least a
// twentieth of the uniform density.
//
// Walls break lanes, and the way to the next one leads around them. A place of the share that no
// lane sees, for example behind a wall, is a lane of its own. Parts of the domain to which no way
// leads are left out.
//
// The next lane is the nearest one whose end is in sight. If none is, it is the one to which the
// way is shortest. After the last one the agent goes back through all of them. If an agent joins,
// leaves or is forgotten, the rest divides the domain anew. It has no noise, and no feedback from
// what has been covered.
//
// A corner that an agent does not reach in three times the time that it should take and 100 ticks
// more, for example in a closed zone, is left out. One to which no way leads is left out after 100.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/rings.h"
#include "core/basis/basis.h"
#include "core/law/equal_shares.h"
#include "core/law/law.h"
#include "core/motion/vehicle.h"
#include "core/motion/way_around.h"

namespace ergocast {

class Mower final : public Law {
 public:
  explicit Mower(const Mission& mission, int kind = 0);

  static constexpr LawNeeds kNeeds{.coverage = false, .team = true};
  LawNeeds needs() const override { return kNeeds; }
  void set_target(const Coefficients& target) override;
  void set_law(const LawNumbers& numbers) override;
  Eigen::Vector3d wanted_mps(const LawInput& input) override;

  /// The ends of the agent's lanes in their order, there and back.
  const std::vector<Eigen::Vector3d>& corners_m() const { return corners_m_; }

 private:
  struct Lane {
    Eigen::Vector3d from_m, to_m;
  };

  void set_speed(double u_max_mps);
  void share_out(const LawInput& input);
  void lay_lanes(const CellRange& share);
  void lay_lane(const CellRange& lane, int axis);
  void add_part(CellRange part, const CellRange& lane, int axis);
  void add_unseen(const CellRange& share);
  bool is_seen(const Eigen::Vector3d& x_m) const;
  bool is_worth(const CellRange& cells) const;
  void put_in_order(const Eigen::Vector3d& x_m);
  std::optional<std::pair<std::size_t, bool>> nearest_lane(const Eigen::Vector3d& x_m);
  void aim(std::size_t corner, const LawInput& input);
  /// Whether the next corner is in sight. If it is not, the way around walls is known then.
  bool sees_corner(const Eigen::Vector3d& x_m);

  Basis basis_;  // (2)
  Rings walls_;
  Motion motion_;
  double push_m_;  // what a tick's disturbance may add
  Cells cells_;
  RangeSums mass_;
  double radius_m_, speed_mps_ = 0, reach_m_ = 0;
  WayAround way_;
  std::vector<AgentId> team_;  // for which the corners hold
  std::vector<Lane> lanes_;
  std::vector<Eigen::Vector3d> corners_m_;
  std::size_t next_ = 0;
  bool knows_way_ = false;  // way_ leads to the next corner
  bool is_aimed_ = false;   // give_up_ goes by the present speed
  Tick give_up_ = 0;        // the tick at which the next corner is left out
};

}  // namespace ergocast
