// SPDX-License-Identifier: BSD-3-Clause
// One agent's plan and how it is improved: a step down the slope of J a tick, no further from what
// was announced than others may count on.
#pragma once

#include "lab/studies/plans/announcement.h"

namespace ergocast::studies {

class Planner {
 public:
  Planner(const Mission& mission, const PlanSetting& setting);

  /// A first plan: every node `along_mps`, plus normal numbers of first_spread · u_max, clipped to
  /// u_max. A function of the mission's seed and the agent.
  void draw(AgentId agent, const Eigen::Vector3d& along_mps);

  /// The nodes as they are now are announced.
  void announce() { announced_ = nodes_; }

  /// One step: slope over its RMS over the nodes to be flown, momentum, clipped to u_max, and where
  /// `trusted` each node is kept within trust · u_max of its announced value; there its momentum is
  /// halved.
  void improve(const Outlook& outlook, const Eigen::Vector3d& x_m, bool trusted);

  /// The next node begins.
  void turn();
  /// The vehicle was reflected: its plan is from now on that of its mirror image.
  void mirror(int axis);

  const Nodes& nodes() const { return nodes_; }
  const Nodes& announced() const { return announced_; }

 private:
  PlanSetting setting_;
  double u_max_mps_;
  Box domain_;
  std::uint64_t seed_;
  PlanCost cost_;
  Nodes nodes_, announced_, momentum_, slope_;
};

}  // namespace ergocast::studies
