// SPDX-License-Identifier: BSD-3-Clause
// From a field to a velocity: input, contraction and perturbation of all laws that descend.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/law/perturbation.h"
#include "core/mission/law_change.h"
#include "core/mission/mission.h"

namespace ergocast {

/// u = −u_max B / √(‖B‖² + ε²), (8); for ε = 0 the classical law (5), whose limit we set to u = 0
/// where B = 0.  ‖u‖ ≤ u_max up to rounding.
Eigen::Vector3d smooth_input(const Eigen::Vector3d& spectral_gradient, double epsilon,
                             double u_max_mps);

class Steering {
 public:
  /// @param kind  of the agents that it steers, core/mission/kinds.h
  explicit Steering(const Mission& mission, int kind = 0);

  const ControlLaw& law() const { return law_; }
  /// From now on the law has these numbers.
  void set_law(const LawNumbers& numbers);

  /// ε for a field whose RMS is `rms_gradient`.
  double epsilon(double rms_gradient) const {
    return law_.regularization == Regularization::kRelative ? law_.epsilon * rms_gradient
                                                            : law_.epsilon;
  }
  /// Whether the velocity depends on the field's Jacobian.
  bool needs_curvature() const { return law_.perturbation == Perturbation::kAdaptive; }

  /// The velocity command of (10) at position `x_m`:
  ///   v = u − k (x − centre) + perturbation,  a function of (seed, agent, tick) and the field.
  /// In a plane v_z is 0. Allocates only at the first step of a further agent.
  Eigen::Vector3d velocity_mps(AgentId agent, Tick tick, const Eigen::Vector3d& x_m,
                               const FieldAt& field, double epsilon);

 private:
  /// An η, and where it was drawn.
  struct Push {
    AgentId drawn = kUnassigned;
    Tick stretch = -1;
    Eigen::Vector3d eta{0, 0, 0};
  };

  Push& slot_of(AgentId drawn);
  Eigen::Vector3d push(AgentId agent, Tick stretch);

  Box domain_;
  ControlLaw law_;
  std::uint64_t seed_;
  double dt_s_;
  PerturbationScale scale_;
  Tick push_ticks_;
  std::vector<Push> pushes_;  // the last of each agent so far: one is held for many ticks
};

}  // namespace ergocast
