// SPDX-License-Identifier: BSD-3-Clause
// How fast noise carries an agent off a set of Proposition 1, to first order in how far off it is.
//
// One agent on such a set, x = x̄ + δ n: x̄ is its path without noise, which stays on the set, n the
// unit normal. Mirroring the whole past at the set mirrors the future, so to first order in δ
// neither the path along the set nor ‖B‖ changes, and
//
//   δ' = γ δ − u_max/(ρ t) ∫_0^t K(t, τ) δ(τ) dτ + σ ξ,    ρ = √(‖B‖² + ε²),
//   γ = −u_max nᵀHn/ρ − k,    H = Σ λ_k (c_k − μ_k) ∇²f_k(x̄(t)),
//   K(t, τ) = Σ λ_k (n·∇f_k(x̄(t))) (n·∇f_k(x̄(τ))).
//
// The integral is what the deviation of the past path does to c_k. It is of first order too, except
// on edges and corners, where n·∇f_k = 0 for every mode. Everything here is for the discrete
// recursion.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mission/mission.h"

namespace ergocast::studies {

/// One step of the linearised recursion
///   δ_{j+1} = (1 + γ_j dt) δ_j − memory_j Σ_k λ_k g_jk Σ_{i≤j} g_ik δ_i + σ √dt ξ_j.
struct LinearStep {
  double rate_per_s = 0;   ///< γ_j
  double memory = 0;       ///< u_max dt / (ρ_j (j + 1)) [m²]
  Eigen::VectorXd slopes;  ///< g_jk = n·∇f_k(x̄_j) [1/m]
};

/// The normal of the set that the mission's agent starts on, and how many directions lead off it.
struct Normal {
  Eigen::Vector2d direction;
  int dimensions = 1;  ///< 2 at a corner, where both are alike
};
/// @pre one agent, which starts on an edge, a midline, a diagonal or at a corner
Normal normal_of(const Mission& mission);

/// The recursion along the noise-free path of `mission`'s one agent. The path is kept on the set in
/// spite of rounding.
/// @pre as normal_of(); the centre of contraction lies on the set; ε > 0, or B ≠ 0 on the path
std::vector<LinearStep> linearised(const Mission& mission, Tick steps);

/// Whether the integral over the past is counted.
enum class Past { kCounted, kNeglected };

/// Standard deviation of δ_j for σ = 1, j = 0 … steps [√s]: δ_j is Gaussian with mean 0.
std::vector<double> spread(const std::vector<LinearStep>& steps, const Mission& mission, Past past);

/// δ_j [m], j = 0 … steps, with the noise of the mission's seed, in the direction of the normal.
std::vector<double> deviation(const std::vector<LinearStep>& steps, const Mission& mission);

}  // namespace ergocast::studies
