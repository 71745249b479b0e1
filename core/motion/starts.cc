// SPDX-License-Identifier: BSD-3-Clause
// Draws starts, and computes how far apart bodies begin.
#include "core/motion/starts.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/noise.h"
#include "core/motion/filter_rules.h"
#include "core/motion/vehicle.h"
#include "core/motion/walls.h"

namespace ergocast {
namespace {

/// How far a body moves in `ticks` ticks.
double moved_m(const Mission& mission, const Motion& motion, Tick ticks) {
  const double step_m = (motion.speed_limit_mps + motion.vehicle.min_speed_mps) * motion.dt_s +
                        mission.separation.disturbance_m;
  return static_cast<double>(ticks) * step_m;
}

/// What a body adds to D at its start. The loiter centres of two fixed wings may lie between them.
double start_margin_m(const Mission& mission, AgentId id) {
  const Motion motion = motion_of(mission, id);
  return bulge_m(motion) + 2 * loiter_radius_m(motion) +
         (2 * mission.separation.position_error_m +
          2 * moved_m(mission, motion, unguarded_hold_ticks(mission)));
}

}  // namespace

Eigen::Vector3d start_of(const Mission& mission, AgentId id) {
  const auto at = static_cast<std::size_t>(id);
  return at < mission.starts_m.size() ? mission.starts_m[at]
                                      : start_beside(mission, id, {}, start_distance_m);
}

Eigen::Vector3d random_start(const Box& domain, std::uint64_t seed, AgentId id, int attempt) {
  return uniform_in(domain, seed, Purpose::kStart, static_cast<std::uint32_t>(id),
                    static_cast<std::uint64_t>(attempt));
}

Box room_to_begin(const Mission& mission, AgentId id) {
  Box room = room_to_begin(motion_of(mission, id));
  if (mission.separation.response_s == 0) return room;
  const double edge_m =
      std::min(late_edge_margin_m(mission, id), mission.domain.shortest_side_m() / 4);
  const int axes = mission.domain.planar() ? 2 : 3;
  room.origin_m.head(axes).array() += edge_m;
  room.size_m.head(axes).array() -= 2 * edge_m;
  return room;
}

double start_distance_m(const Mission& mission, AgentId one, AgentId other) {
  if (!keeps_distance(mission)) return 0;
  return mission.separation.distance_m +
         (start_margin_m(mission, one) + start_margin_m(mission, other));
}

double join_distance_m(const Mission& mission, AgentId newcomer, AgentId other) {
  const Motion appears = motion_of(mission, newcomer), moves = motion_of(mission, other);
  const Tick ticks = unguarded_hold_ticks(mission) + 1;
  return start_distance_m(mission, newcomer, other) +
         (moved_m(mission, appears, ticks) + moved_m(mission, moves, ticks)) +
         longest_braking_path_m(moves);
}

std::optional<std::pair<AgentId, AgentId>> too_near_at_start(const Mission& mission, AgentId from) {
  const auto& starts_m = mission.starts_m;
  std::vector<double> margins_m;
  for (AgentId id = 0; id < std::ssize(starts_m); ++id)
    margins_m.push_back(start_margin_m(mission, id));
  for (auto i = static_cast<std::size_t>(from); i < starts_m.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double least_m = mission.separation.distance_m + (margins_m[i] + margins_m[j]);
      if (length_of(starts_m[i] - starts_m[j]) < least_m)
        return std::pair(static_cast<AgentId>(i), static_cast<AgentId>(j));
    }
  }
  return std::nullopt;
}

double least_distance_m(std::span<const Eigen::Vector3d> places_m) {
  double least_m = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      least_m = std::min(least_m, length_of(places_m[i] - places_m[j]));
  }
  return least_m;
}

double packing(const Mission& mission, std::size_t bodies) {
  const Eigen::Vector3d& size_m = mission.domain.size_m;
  double sum = 0;
  for (AgentId id = 0; id < static_cast<AgentId>(bodies); ++id) {
    const double diameter_m = start_distance_m(mission, id, id);
    const double disc = std::numbers::pi / 4 * diameter_m * diameter_m / (size_m.x() * size_m.y());
    // The volume of a ball is two thirds of a disc that is as thick as the ball is wide.
    sum += mission.domain.planar() ? disc : disc * 2 / 3 * diameter_m / size_m.z();
  }
  return sum;
}

Eigen::Vector3d start_beside(const Mission& mission, AgentId id, std::span<const Placed> others,
                             double (*distance_m)(const Mission&, AgentId, AgentId)) {
  const Box room = room_to_begin(mission, id);
  std::vector<double> least_m;
  for (const Placed& other : others) least_m.push_back(distance_m(mission, id, other.id));
  Eigen::Vector3d best_m{0, 0, 0};
  double best_spare_m = -std::numeric_limits<double>::max();
  for (int attempt = 0; attempt < kMostDraws && best_spare_m < 0; ++attempt) {
    const Eigen::Vector3d x_m = random_start(room, mission.seed, id, attempt);
    double spare_m = spare_at_start_m(mission, id, x_m) - late_edge_margin_m(mission, id);
    for (std::size_t i = 0; i < others.size(); ++i)
      spare_m = std::min(spare_m, length_of(others[i].position_m - x_m) - least_m[i]);
    if (spare_m <= best_spare_m) continue;
    best_m = x_m;
    best_spare_m = spare_m;
  }
  return best_m;
}

}  // namespace ergocast
