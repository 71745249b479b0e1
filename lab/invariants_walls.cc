// SPDX-License-Identifier: BSD-3-Clause
// Checks the places of bodies among walls, and computes distances again. Edges that are far away
// are left out by the tree of core/base/indexed_rings.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/motion/walls.h"
#include "lab/invariants.h"

namespace ergocast::lab {
namespace {

/// The error that rounding may cause in a clearance, as a share of the longer side.
constexpr double kRounding = 1e-9;

/// How often the ray from `x_m` downwards meets the rings. The tree of edges leaves out only those
/// that are apart from the ray.
/// @param low_m  below all rings
int crossings_below(const IndexedRings& walls, const Eigen::Vector2d& x_m, double low_m) {
  int count = 0;
  walls.find_near({x_m, {x_m.x(), low_m}}, 0, [&](const Edge& edge) {
    const Eigen::Vector2d a_m = edge.segment.from_m - x_m, b_m = edge.segment.to_m - x_m;
    const bool left = a_m.x() < 0;
    const double cross = a_m.x() * b_m.y() - a_m.y() * b_m.x();
    if (left != (b_m.x() < 0) && !(left ? cross < 0 : cross > 0)) ++count;
    return false;
  });
  return count;
}

/// The distance from the nearest edge: the height of the triangle of `x_m` and an edge, or the
/// distance from the nearer end. Edges that are farther away than `within_m` may be left out.
double nearest_edge_m(const IndexedRings& walls, const Eigen::Vector2d& x_m, double within_m) {
  double least_m = std::numeric_limits<double>::max();
  walls.find_near({x_m, x_m}, within_m, [&](const Edge& edge) {
    const Eigen::Vector2d a_m = edge.segment.from_m - x_m, b_m = edge.segment.to_m - x_m,
                          side_m = b_m - a_m;
    const bool beside = side_m.dot(a_m) < 0 && side_m.dot(b_m) > 0;
    const double area_m2 = std::abs(a_m.x() * b_m.y() - a_m.y() * b_m.x());
    least_m =
        std::min(least_m, beside ? area_m2 / side_m.norm() : std::min(a_m.norm(), b_m.norm()));
    return false;
  });
  return least_m;
}

}  // namespace

/// Checks the true place alone. Loiter circles and braking paths are not checked.
void Invariants::check_wall(double t_s, const Vehicle& vehicle) {
  const Eigen::Vector2d x_m = vehicle.position_m.head<2>();
  const double longer_m = mission_.domain.size_m.maxCoeff();
  const double low_m = mission_.domain.origin_m.y() - 2 * kFarthestWallPerSize * longer_m;
  const bool solid = crossings_below(mission_.walls, x_m, low_m) % 2 == 1;
  const double least_m = mission_.wall_clearance_m - kRounding * longer_m;
  if (!solid && nearest_edge_m(mission_.walls, x_m, mission_.wall_clearance_m) >= least_m) return;
  const double apart_m = nearest_edge_m(mission_.walls, x_m, std::abs(x_m.y() - low_m));
  violate(t_s, Invariant::kWallsKept, "vehicle " + std::to_string(vehicle.id),
          std::to_string(apart_m) + (solid ? " m inside a wall" : " m from a wall") + ", at (" +
              std::to_string(x_m.x()) + ", " + std::to_string(x_m.y()) + ") m");
}

}  // namespace ergocast::lab
