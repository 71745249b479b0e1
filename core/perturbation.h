// The perturbation σ dW of (9) and (10): how strong, and in which direction.
//
// Where the agents must choose between two sides, the field does not tell them which: on a corner B
// vanishes, on a midline or diagonal only its part across does. There the potential
// U = Σ λ (c − μ) f, which agents descend, bends down across the set, and a deviation δ along such a
// direction v grows by itself, δ' = −u_max (vᵀHv) / √(‖B‖² + ε²) · δ, where H = ∇B is the curvature
// of U. What the noise has to do is to begin it. Everywhere else it only blurs.
#pragma once

#include <Eigen/Core>

#include "core/basis.h"
#include "core/mission.h"

namespace ergocast {

/// The velocity that stands for σ dW over one step, σ ξ / √dt [m/s]. Constant: with one σ, as in the
/// paper. Adaptive: along each of the two principal directions v
/// of H, which are orthogonal,
///   σ_v² = σ² + (σ_max² − σ²) · ε² / (ε² + (v·B)²)   where U bends down: vᵀHv < 0
///   σ_v² = σ²                                         elsewhere
/// with σ = noise_intensity and σ_max = noise_ceiling: strong where B along v is small against ε, at
/// which (8) too becomes weak; σ ≤ σ_v ≤ σ_max always. Where ε and v·B are both 0 the share is 1.
/// @param field  B, in the unit of ε, and H; H is not read by the constant law
/// @param xi     two independent standard normal numbers
Eigen::Vector2d perturbation(const ControlLaw& law, double dt_s, double epsilon,
                             const FieldAt& field, const Eigen::Vector2d& xi);

}  // namespace ergocast
