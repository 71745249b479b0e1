// SPDX-License-Identifier: BSD-3-Clause
// The control step: the one place that computes an agent's input.
#pragma once

#include <Eigen/Core>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/law/law.h"
#include "core/law/steering.h"
#include "core/mission/law_change.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Computes one agent's command from the team's coverage. Holds the mission's constant tables and a
/// K-vector of scratch space. Only the first step of a further agent allocates.
class Controller final : public Law {
 public:
  /// @param kind  of the agents that it steers, core/mission/kinds.h
  explicit Controller(const Mission& mission, int kind = 0);

  static constexpr LawNeeds kNeeds{.serves_all = true};
  LawNeeds needs() const override { return kNeeds; }
  /// Takes in the known or forecast c_k of the team, mode_count() entries. All later commands use
  /// it.
  void set_coverage(const Coefficients& coverage) override;

  /// From now on the law has these numbers.
  void set_law(const LawNumbers& numbers) override { steering_.set_law(numbers); }

  /// The velocity command of (10) at position `x_m`:
  ///   v = u − k (x − centre) + perturbation,  a function of (seed, agent, tick) and the field.
  /// In a plane v_z is 0.
  /// @param at  the basis at `x_m`
  Eigen::Vector3d command(AgentId agent, Tick tick, const Eigen::Vector3d& x_m, const BasisAt& at);

  Eigen::Vector3d wanted_mps(const LawInput& input) override {
    return command(input.agent, input.tick, input.x_m, input.at);
  }
  /// B of (6) for the last command() [1/m].
  Eigen::Vector3d spectral_gradient() const override { return spectral_gradient_; }
  /// The ε that belongs to the last coverage seen.
  double epsilon() const { return epsilon_; }

  /// φ² of `coverage` against the mission's target, over all modes.
  double metric(const Coefficients& coverage) const;

 private:
  /// Sets the residual λ g (c − μ) in the kind's band; returns the RMS of ‖Σ λ g (c − μ) ∇f‖ over a
  /// domain with all sides as long as the longest [1/m].
  double set_residual(const Coefficients& coverage);

  Box domain_;
  Basis basis_;
  Steering steering_;
  Coefficients target_, weights_, energies_, residual_;
  Coefficients metric_weights_;  // if the weights that it steers by are not those of φ²
  Eigen::Vector3d spectral_gradient_{0, 0, 0};
  double epsilon_ = 0;
};

}  // namespace ergocast
