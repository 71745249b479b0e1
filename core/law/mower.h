// SPDX-License-Identifier: BSD-3-Clause
// The law that mows: each agent goes to and fro over an equal mass of the target, in lanes.
//
// The domain is divided into as many rectangles as there are agents, of equal mass
// (core/law/equal_shares.h). An agent's rectangle has lanes along its longer side, at most two
// radii of the sensor (core/measure/detection.h) apart. A lane goes from its first to its last
// cell with at least a twentieth of the uniform density. At the end of the last lane the agent goes
// back through all lanes. If an agent joins, leaves or is forgotten, the rest divides the domain
// anew. It has no noise, and no feedback from what has been covered.
//
// A corner that an agent does not reach in three times the time that it should take and 100 ticks
// more, for example behind a wall, is left out.
#pragma once

#include <vector>

#include "core/law/equal_shares.h"
#include "core/law/law.h"

namespace ergocast {

class Mower final : public Law {
 public:
  /// @pre a plane
  explicit Mower(const Mission& mission, int kind = 0);

  LawNeeds needs() const override { return {.coverage = false, .team = true}; }
  void set_target(const Coefficients& target) override;
  void set_law(const LawNumbers& numbers) override { u_max_mps_ = numbers.u_max_mps; }
  Eigen::Vector3d wanted_mps(const LawInput& input) override;

  /// The corners of the agent's lanes in their order, there and back.
  const std::vector<Eigen::Vector3d>& corners_m() const { return corners_m_; }

 private:
  void share_out(const LawInput& input);
  void add_lane(const CellRange& lane, bool along_x);
  void aim(std::size_t corner, const LawInput& input);

  Mission mission_;  // in the basis (2)
  Cells cells_;
  RangeSums mass_;
  double u_max_mps_, radius_m_, reach_m_;
  std::vector<AgentId> team_;  // for which the corners hold
  std::vector<Eigen::Vector3d> corners_m_;
  std::size_t next_ = 0;
  Tick give_up_ = 0;  // the tick at which the next corner is left out
};

}  // namespace ergocast
