// SPDX-License-Identifier: BSD-3-Clause
// Asks the tree of edges for those nearby.
#include "core/motion/walls.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/geometry.h"
#include "core/motion/filter_rules.h"
#include "core/motion/step_constraints.h"

namespace ergocast {
namespace {

/// A hole is in the wall that comes before it, and an outline in no wall.
bool in_order(const Rings& walls, const std::vector<int>& depth) {
  std::size_t outline = 0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    if (depth[i] % 2 == 0) outline = i;
    const bool is_hole = depth[i] % 2 == 1;
    const bool in_it =
        outline < i && depth[outline] == depth[i] - 1 && contains(walls[outline], walls[i].front());
    if (is_hole && !in_it) return false;
  }
  return true;
}

/// Whether the area of each outline without its holes is large enough; the rings are in_order().
bool wide_enough(const Rings& walls, const std::vector<int>& depth, const Box& domain) {
  const double side_m = domain.size_m.maxCoeff();
  double area = 0;
  for (std::size_t i = walls.size(); i-- > 0;) {
    const bool is_hole = depth[i] % 2 == 1;
    area += (is_hole ? -1 : 1) * area_m2(walls[i]);
    if (is_hole) continue;
    if (!(area >= kLeastWallArea * side_m * side_m)) return false;
    area = 0;
  }
  return true;
}

bool is_ring(const Ring& ring, const Box& domain) {
  if (ring.size() < 3) return false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (!near_enough(ring[i], domain) || ring[i] == ring[(i + 1) % ring.size()]) return false;
  }
  return true;
}

}  // namespace

bool solid_at(const IndexedRings& walls, const Eigen::Vector2d& x_m) { return walls.solid_at(x_m); }

double clearance_m(const IndexedRings& walls, const Eigen::Vector2d& x_m) {
  const double least = walls.least_square_m2(x_m);
  const double apart_m = walls.empty() ? least : std::sqrt(least);
  return solid_at(walls, x_m) ? -apart_m : apart_m;
}

bool is_clear(const IndexedRings& walls, const Segment& way, double kept_m) {
  return !walls.find_near(way, kept_m,
                          [&](const Edge& edge) { return distance_m(way, edge.segment) < kept_m; });
}

std::size_t vertex_count(const Rings& walls) {
  std::size_t count = 0;
  for (const Ring& ring : walls) count += ring.size();
  return count;
}

bool near_enough(const Eigen::Vector2d& corner_m, const Box& domain) {
  const double far_m = kFarthestWallPerSize * domain.size_m.maxCoeff();
  const Eigen::Array2d low_m = domain.origin_m.head<2>().array() - far_m;
  const Eigen::Array2d high_m = (domain.origin_m + domain.size_m).head<2>().array() + far_m;
  return (corner_m.array() >= low_m).all() && (corner_m.array() <= high_m).all();
}

bool are_walls(const IndexedRings& walls, const Box& domain) {
  const auto ring = [&](const Ring& one) { return is_ring(one, domain); };
  if (walls.edge_count() > static_cast<std::size_t>(kMaxWallVertices) ||
      !std::ranges::all_of(walls, ring) || walls.is_crowded() || touching_edges(walls))
    return false;
  const std::vector<int> depth = depths(walls);
  return in_order(walls, depth) && wide_enough(walls, depth, domain);
}

double kept_from_walls_m(const Mission& mission, const Motion& motion) {
  const Box& domain = mission.domain;
  const double farthest_m =
      domain.origin_m.cwiseAbs().maxCoeff() + (1 + kFarthestWallPerSize) * domain.size_m.maxCoeff();
  const double rounding_m =
      kContactTicks * (4 * std::numeric_limits<double>::epsilon() * farthest_m +
                       StepConstraints::kTolerance * reach_m(motion, motion.speed_limit_mps));
  return mission.wall_clearance_m + loiter_radius_m(motion) + bulge_m(motion) + rounding_m;
}

double least_wall_clearance_m(const Mission& mission) {
  const Separation& rule = mission.separation;
  if (!keeps_distance(mission)) return 0;
  const auto hold_ticks = static_cast<double>(unguarded_hold_ticks(mission));
  const double step_m = fastest_mps(mission) * mission.timing.dt_s + rule.disturbance_m;
  return 2 * rule.position_error_m + hold_ticks * step_m;
}

double spare_at_start_m(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m) {
  if (mission.walls.empty()) return std::numeric_limits<double>::max();
  const Motion motion = motion_of(mission, id);
  const Eigen::Vector3d at_m = anchor_m(motion, x_m, first_velocity(motion, x_m));
  return clearance_m(mission.walls, at_m.head<2>()) - kept_from_walls_m(mission, motion);
}

Eigen::Vector3d stopped_by_walls(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m,
                                 const Eigen::Vector3d& push_m) {
  if (mission.walls.empty()) return push_m;
  const double kept_m = kept_from_walls_m(mission, motion_of(mission, id));
  double share = 1;
  const auto keep = [&](double along_m, double bound_m) {
    if (along_m > bound_m) share = std::min(share, std::max(0.0, bound_m) / along_m);
  };
  const Eigen::Vector3d high_m = mission.domain.origin_m + mission.domain.size_m;
  for (int axis = 0; axis < 2; ++axis) {
    keep(push_m[axis], high_m[axis] - x_m[axis]);
    keep(-push_m[axis], x_m[axis] - mission.domain.origin_m[axis]);
  }
  const Eigen::Vector2d at_m = x_m.head<2>();
  mission.walls.find_near({at_m, at_m}, kept_m + length_of(push_m), [&](const Edge& edge) {
    const Eigen::Vector2d way_m = edge.segment.nearest_m(at_m) - at_m;
    const double apart_m = std::sqrt(way_m.squaredNorm());
    if (apart_m > 0) keep(way_m.dot(push_m.head<2>()) / apart_m, apart_m - kept_m);
    return false;
  });
  return share < 1 ? Eigen::Vector3d((1 - 1e-12) * share * push_m) : push_m;
}

bool walls_fit(const Mission& mission) {
  if (mission.walls.empty()) return true;
  if (!mission.domain.planar() || !are_walls(mission.walls, mission.domain)) return false;
  if (mission.disturbance_intensity > 0 && any_but_points(mission)) return false;
  if (mission.wall_clearance_m < least_wall_clearance_m(mission)) return false;
  for (AgentId id = 0; id < std::ssize(mission.starts_m); ++id) {
    const Eigen::Vector3d& start_m = mission.starts_m[static_cast<std::size_t>(id)];
    if (!(motion_of(mission, id).speed_limit_mps > 0) ||
        !(spare_at_start_m(mission, id, start_m) >= 0))
      return false;
  }
  return true;
}

}  // namespace ergocast
