// SPDX-License-Identifier: BSD-3-Clause
// What a plan is worth to the team, and how that changes with each of its nodes.
//
//   J = Σ_h ω_h ‖W_h‖²_λ / t_h²  +  ‖W_H‖²_λ / t_H²,      ω_h = run_weight τ_h / Σ τ
//   W_h = Σ_j S_j + Σ_{g ≤ h} [own gain in node g + the others' gain in g − μ n τ_g] − μ t_now
//
// τ_h is how long node h is flown, n the number of known agents, t_now the time that they have
// covered together, t_h = t_now + n Σ_{g ≤ h} τ_g. So ‖W_h‖²_λ / t_h² is φ² at the end of node h if
// all agents fly as announced, and H is the last node with τ > 0. The gain of a node is
// τ / points · Σ f at places spread evenly over its way: one place is the middle. Paths run
// straight on where they leave the domain: f is even about each edge, so their reflection covers
// the same.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/basis.h"
#include "core/mission.h"
#include "lab/studies/plans/plan_setting.h"

namespace ergocast::studies {

using Nodes = Eigen::Matrix3Xd;  ///< velocities [m/s], one a column, or derivatives by them

/// What an agent knows and expects while it plans.
struct Outlook {
  std::vector<double> durations_s;  ///< τ_h
  std::vector<double> known_s;      ///< Σ_j S_j, mode by mode
  double covered_s = 0;             ///< t_now
  int known_agents = 1;             ///< n
  std::vector<double> others_s;     ///< what the others will gain, node by node: nodes × modes
};

/// Holds scratch space; no evaluation allocates.
class PlanCost {
 public:
  PlanCost(const Mission& mission, const PlanSetting& setting);

  /// J of flying `nodes` from `x_m`.
  /// @param slope  takes ∂J/∂node [s/m]; nodes with τ = 0 get 0
  /// @pre Outlook::durations_s[0] > 0
  double operator()(const Outlook& outlook, const Eigen::Vector3d& x_m, const Nodes& nodes,
                    Nodes& slope);

 private:
  int fly(const Outlook& outlook, const Eigen::Vector3d& x_m, const Nodes& nodes);
  double weigh(const Outlook& outlook, int flown);
  void trace_back(const Outlook& outlook, int flown, Nodes& slope);
  double* residual_of(int node) {
    return &residuals_[static_cast<std::size_t>(node) * static_cast<std::size_t>(modes_)];
  }

  Mission mission_;
  int points_, modes_;
  double run_weight_;
  Coefficients weights_;
  std::vector<BasisAt> places_;    // points a node
  std::vector<double> residuals_;  // W_h
  std::vector<double> factors_;    // of λ W_h in ∂J/∂W_h
  std::vector<double> adjoint_;    // Σ_{g ≥ h} ∂J/∂W_g
};

/// gain += duration_s / points · Σ f at `points` places along a straight way from `x_m`.
void add_gain(const Mission& mission, int points, const Eigen::Vector3d& x_m,
              const Eigen::Vector3d& v_mps, double duration_s, double* gain);

}  // namespace ergocast::studies
