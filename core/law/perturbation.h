// SPDX-License-Identifier: BSD-3-Clause
// The perturbation σ dW of (9) and (10): how strong, in which direction, and for how long.
//
// Where agents must choose between two sides, the field does not decide: on a corner B vanishes, on
// a midline or diagonal its part across vanishes. There the potential U = Σ λ (c − μ) f, which
// agents descend, bends down across the set. A deviation δ along such a direction v grows by
// itself, δ' = −u_max (vᵀHv) / √(‖B‖² + ε²) · δ, where H = ∇B is the curvature of U. Noise has to
// start this growth. Everywhere else noise only blurs.
#pragma once

#include <Eigen/Core>

#include "core/basis/basis.h"
#include "core/mission/mission.h"

namespace ergocast {

/// For how many steps an adaptive law holds its push: (σ_max / u_max)², at least one step, so that
/// the push is no faster than u_max along each direction (one standard deviation).
Tick push_ticks(const ControlLaw& law, double dt_s);

/// The push along a direction with s = 1, √((σ_max² − σ²) / T): one standard deviation.
double greatest_push_mps(const ControlLaw& law, double dt_s);

/// The greatest standard deviation along any direction of the velocity below [m/s]: constant σ/√dt,
/// adaptive √(σ²/dt + greatest_push²).
double greatest_deviation_mps(const ControlLaw& law, double dt_s);

/// The part of a perturbation that is the same at every step.
struct PerturbationScale {
  PerturbationScale(const ControlLaw& law, double dt_s);

  bool is_adaptive;
  double noise_mps;  ///< σ/√dt
  double push_mps;   ///< adaptive: greatest_push_mps(), else 0
};

/// The velocity that stands for σ dW over one step [m/s].
///
/// Constant: σ ξ / √dt, the paper's. Adaptive: besides, along each of the principal directions v
/// of H, which are orthogonal, a push of
///   √(s (σ_max² − σ²) / T) · v·η,   s = ε² / (ε² + (v·B)²) where U bends down, vᵀHv < 0, else 0
/// with σ = noise_intensity, σ_max = noise_ceiling and T the time for which η is held. It is strong
/// where B along v is small against ε; there (8) becomes weak, too. For ε = v·B = 0, s is 1.
/// Over times longer than T the sum along v spreads like σ_v dW with
/// σ_v² = σ² + s (σ_max² − σ²), which lies between σ² and σ_max².
/// @param field  B, in the unit of ε, and H; H is not read by the constant law
/// @param xi     independent standard normal numbers of this step, along z 0 in a plane
/// @param eta    those of the push_ticks() steps that it belongs to
Eigen::Vector3d perturbation(const PerturbationScale& scale, double epsilon, const FieldAt& field,
                             const Eigen::Vector3d& xi, const Eigen::Vector3d& eta);

}  // namespace ergocast
