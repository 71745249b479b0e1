// SPDX-License-Identifier: BSD-3-Clause
// The sets of Proposition 1 that symmetric targets make invariant, and the distance from them.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/base/geometry.h"

namespace ergocast::lab {

enum class ManifoldKind {
  kEdge,      ///< x = 0 and y = 0 are the paper's axes; the edges opposite are alike by reflection
  kMidline,   ///< x = Lx/2, y = Ly/2
  kDiagonal,  ///< of a square only
  kCorner,
  kCenter,
  kCrossing,  ///< of an edge and a midline
};

struct Manifold {
  ManifoldKind kind;
  Eigen::Vector2d point_m;  ///< on it
  Eigen::Vector2d normal;   ///< of length 1; (0, 0) if the set is the point alone

  double distance_m(const Eigen::Vector3d& x_m) const;
};

/// The smallest of these sets that `x_m` lies on, up to 1e-9 of the domain's sides; none for a
/// point in general position. Where two lines cross, the set is the point. For a place in space
/// only x and y count.
std::optional<Manifold> manifold_at(const Eigen::Vector3d& x_m, const Box& domain);

/// An agent has escaped if it is farther off than this: 1 % of the shorter side.
double escape_distance_m(const Box& domain);

}  // namespace ergocast::lab
