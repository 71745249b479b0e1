// SPDX-License-Identifier: BSD-3-Clause
// Checks the places of bodies among walls, and computes distances again.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "lab/invariants.h"

namespace ergocast::lab {
namespace {

/// The error that rounding may cause in a clearance, as a share of the longer side.
constexpr double kRounding = 1e-9;

/// How often the ray from `x_m` downwards meets the rings.
int crossings_below(const Rings& walls, const Eigen::Vector2d& x_m) {
  int count = 0;
  for_segments(walls, [&](const Segment& edge) {
    const Eigen::Vector2d a_m = edge.from_m - x_m, b_m = edge.to_m - x_m;
    const bool left = a_m.x() < 0;
    if (left == (b_m.x() < 0)) return;
    const double cross = a_m.x() * b_m.y() - a_m.y() * b_m.x();
    if (left ? cross < 0 : cross > 0) ++count;
  });
  return count;
}

/// The distance from the nearest edge: the height of the triangle of `x_m` and an edge, or the
/// distance from the nearer end.
double nearest_edge_m(const Rings& walls, const Eigen::Vector2d& x_m) {
  double least_m = std::numeric_limits<double>::max();
  for_segments(walls, [&](const Segment& edge) {
    const Eigen::Vector2d a_m = edge.from_m - x_m, b_m = edge.to_m - x_m, side_m = b_m - a_m;
    const bool beside = side_m.dot(a_m) < 0 && side_m.dot(b_m) > 0;
    const double area_m2 = std::abs(a_m.x() * b_m.y() - a_m.y() * b_m.x());
    least_m =
        std::min(least_m, beside ? area_m2 / side_m.norm() : std::min(a_m.norm(), b_m.norm()));
  });
  return least_m;
}

}  // namespace

/// Checks the true place alone. Loiter circles and braking paths are not checked.
void Invariants::check_wall(double t_s, const Vehicle& vehicle) {
  const Eigen::Vector2d x_m = vehicle.position_m.head<2>();
  const bool solid = crossings_below(mission_.walls, x_m) % 2 == 1;
  const double apart_m = nearest_edge_m(mission_.walls, x_m);
  const double least_m = mission_.wall_clearance_m - kRounding * mission_.domain.size_m.maxCoeff();
  if (!solid && apart_m >= least_m) return;
  violate(t_s, Invariant::kWallsKept, "vehicle " + std::to_string(vehicle.id),
          std::to_string(apart_m) + (solid ? " m inside a wall" : " m from a wall") + ", at (" +
              std::to_string(x_m.x()) + ", " + std::to_string(x_m.y()) + ") m");
}

}  // namespace ergocast::lab
