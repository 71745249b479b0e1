// SPDX-License-Identifier: BSD-3-Clause
// What an agent has announced, continued to the present by the agents that received it.
#pragma once

#include <vector>

#include "lab/studies/plans/plan_cost.h"

namespace ergocast::studies {

/// The author's sums, place and nodes at one tick. From there on it is thought to fly its nodes:
/// its place moves along them, its sums gain f there, a node that is over is dropped and a zero
/// appended.
class Announcement {
 public:
  Announcement(const Mission& mission, const PlanSetting& setting, Tick tick,
               std::vector<double> sums_s, const Eigen::Vector3d& x_m, Nodes nodes);

  /// Continues to `tick`, not before the present one.
  void advance(Tick tick);

  const std::vector<double>& sums_s() const { return sums_s_; }
  const Eigen::Vector3d& x_m() const { return x_m_; }
  const Nodes& nodes() const { return nodes_; }
  /// What it will gain, node by node: nodes × modes [s].
  const std::vector<double>& gains_s() const { return gains_s_; }

 private:
  void foresee(int from, int to);

  const Mission& mission_;
  PlanClock clock_;
  int points_;
  Tick tick_;
  std::vector<double> sums_s_;
  Eigen::Vector3d x_m_;
  Nodes nodes_;
  std::vector<double> durations_s_, gains_s_;
};

/// Drops the first node and appends a zero.
void turn(Nodes& nodes);

}  // namespace ergocast::studies
