// SPDX-License-Identifier: BSD-3-Clause
// Proposition 1 in floating point: how far from 0 the normal part of B is, and its effect.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/mission/mission.h"
#include "target/rectangle.h"

namespace ergocast::studies {

/// A set of Proposition 1 and a team whose first agent is on it. If the premises are to hold, the
/// other agents mirror each other at it.
struct InvariantSet {
  std::string name, text;
  /// Makes a team from two numbers in (0, 1).
  std::vector<Eigen::Vector2d> (*team)(const Eigen::Vector2d& share, const Rectangle& domain);
  bool is_point = false;       ///< the set is a single point
  bool symmetric_team = true;  ///< whether the premises are met
};
std::span<const InvariantSet> invariant_sets();

/// `mission` under the classical law (5), without noise or contraction, with a team drawn from
/// `seed`.
Mission classical(const InvariantSet& set, Mission mission, std::uint64_t seed);

/// |B·n| of the first agent (|B| where the set is a point), n the normal of the set that it starts
/// on.
struct NormalResidual {
  /// In units of 2⁻⁵³ Σ |λ_k (c_k − μ_k)| (|n_x| mπ/Lx + |n_y| nπ/Ly): roundings of the summands,
  /// each at its largest possible value.
  double units = 0;
  double share_of_b = 0;  ///< |B·n| / ‖B‖; 0 if B = 0
};
/// @param tick  0: at its start
NormalResidual normal_residual(const Mission& mission, Tick tick = 0);

}  // namespace ergocast::studies
