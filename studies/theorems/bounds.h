// SPDX-License-Identifier: BSD-3-Clause
// Theorem 2 and Corollary 1: how far an agent may be from the centre of contraction, and how far it
// is.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mission/mission.h"
#include "lab/ideal_team.h"

namespace ergocast::studies {

/// max{‖x(0) − c‖², u_max²/k² + dσ²/k} of one agent in d dimensions [m²].
double mean_square_bound_m2(const Mission& mission, std::size_t agent);

/// ‖x − c‖² of one agent over time, over many seeds.
struct MeanSquare {
  double t_s = 0, mean_m2 = 0, standard_error_m2 = 0;
};
/// The mean squares over seeds 1 … `seeds`, at `points` times up to the mission's end.
std::vector<std::vector<MeanSquare>> mean_squares(Mission mission, lab::Edges edges, int seeds,
                                                  int points);

/// Per agent, the share of seeds 1 … `seeds` in which it is outside the domain at the mission's end
/// if no edge turns it back.
std::vector<double> shares_outside(Mission mission, int seeds);

/// One agent that is always driven in one direction, by a single mode whose target is never
/// reached. Input, centre and gain are such that the input always has the length `law.u_max_mps`.
Mission driven_outward(const ControlLaw& law, double dt_s, double duration_s);

/// ‖x_n − c‖ ≤ qⁿ ‖x_0 − c‖ + (u_max/k)(1 − qⁿ), q = 1 − k·dt: the bound of Corollary 1 for the
/// discrete recursion, and with e^(−k·n·dt) in place of qⁿ the paper's [m].
double discrete_bound_m(const Mission& mission, double start_distance_m, Tick n);
double continuous_bound_m(const Mission& mission, double start_distance_m, Tick n);

/// How well one run without noise satisfies Corollary 1.
struct Contraction {
  std::int64_t checked = 0;  ///< agents × steps
  std::int64_t violations =
      0;  ///< violations of the discrete bound, beyond the allowance for rounding
  double largest_share = 0;             ///< ‖x_n − c‖ / discrete bound
  double largest_continuous_share = 0;  ///< ‖x_n − c‖ / continuous bound, n ≥ 1
  double allowance_m = 0;  ///< 8 units of rounding of the largest coordinate for each step
};
Contraction contraction_of(const Mission& mission, lab::Edges edges);

/// Domain, target, modes, weights, law, step and starts drawn from `seed`; no noise, k·dt ≤ 1, the
/// centre of contraction in the domain.
Mission random_mission(std::uint64_t seed);

}  // namespace ergocast::studies
