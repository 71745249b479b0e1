// SPDX-License-Identifier: BSD-3-Clause
// Measures from a body's holding set to the edges of each zone.
#include "core/motion/zones.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/geometry.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/free_region.h"
#include "core/motion/home.h"
#include "core/motion/step_constraints.h"
#include "core/motion/walls.h"
#include "core/motion/way_home.h"
#include "core/motion/way_out.h"

namespace ergocast {
namespace {

/// As core/motion/walls.cc has it. A mission may have no speed limit; no step is longer than the
/// domain.
double zone_rounding_m(const Mission& mission, const Motion& motion) {
  const Box& domain = mission.domain;
  const double side_m = domain.size_m.maxCoeff();
  const double farthest_m =
      domain.origin_m.cwiseAbs().maxCoeff() + (1 + kFarthestWallPerSize) * side_m;
  return kContactTicks *
         (4 * std::numeric_limits<double>::epsilon() * farthest_m +
          StepConstraints::kTolerance * (side_m + reach_m(motion, motion.speed_limit_mps)));
}

double clearance_of(const Mission& mission, const Motion& motion) {
  return mission.wall_clearance_m + loiter_radius_m(motion) + bulge_m(motion);
}

/// The agents that differ in how they move: the first of each kind.
std::vector<AgentId> one_of_each_kind(const Mission& mission) {
  std::vector<AgentId> ids = {0};
  if (mission.kinds.empty()) return ids;
  for (std::size_t i = 1; i < mission.kinds.size(); ++i)
    ids.push_back(ids.back() + mission.kinds[i - 1].count);
  return ids;
}

bool zone_meets(const Zone& zone, const Box& domain) {
  Eigen::Vector2d low_m = zone.corners_m.front(), high_m = low_m;
  for (const Eigen::Vector2d& corner_m : zone.corners_m) {
    low_m = low_m.cwiseMin(corner_m);
    high_m = high_m.cwiseMax(corner_m);
  }
  const Eigen::Vector2d from_m = domain.origin_m.head<2>();
  const Eigen::Vector2d to_m = from_m + domain.size_m.head<2>();
  if (!((high_m.array() > from_m.array()).all() && (low_m.array() < to_m.array()).all()))
    return false;
  // The boxes overlap, but do the zone and the domain? They do if an edge meets the other, or one
  // contains the other.
  const Ring sides = {from_m, {to_m.x(), from_m.y()}, to_m, {from_m.x(), to_m.y()}};
  if (contains(zone.corners_m, from_m) || contains(sides, zone.corners_m.front())) return true;
  bool meets = false;
  for_segments({zone.corners_m}, [&](const Segment& edge) {
    for_segments({sides}, [&](const Segment& side) { meets = meets || touch(edge, side); });
  });
  return meets;
}

/// The first agent whose station is in the zone, or nearer to it than the agent can stay.
std::optional<AgentId> agent_at_home_in(const Mission& mission, const Zone& zone) {
  for (AgentId id = 0; id < std::ssize(mission.starts_m); ++id) {
    const auto home_m = station_of(mission, id);
    if (!home_m) continue;
    const double kept_m = kept_from_zones_m(mission, motion_of(mission, id));
    if (!lies_outside(zone, {*home_m, {0, 0, 0}}, kept_m)) return id;
  }
  return std::nullopt;
}

}  // namespace

StraightWay holding_way(const Motion& motion, const Eigen::Vector3d& x_m,
                        const Eigen::Vector3d& v_mps) {
  return {anchor_m(motion, x_m, v_mps), braking_path_m(motion, v_mps)};
}

double bound_from_zones_m(const Mission& mission, const Motion& motion) {
  return clearance_of(mission, motion) + zone_rounding_m(mission, motion) / 2;
}

double kept_from_zones_m(const Mission& mission, const Motion& motion) {
  return clearance_of(mission, motion) + zone_rounding_m(mission, motion);
}

Eigen::Vector2d shortest_to_m(const Segment& way, const Segment& edge) {
  const Eigen::Vector2d candidates[] = {
      edge.nearest_m(way.from_m) - way.from_m, edge.nearest_m(way.to_m) - way.to_m,
      edge.from_m - way.nearest_m(edge.from_m), edge.to_m - way.nearest_m(edge.to_m)};
  return *std::ranges::min_element(candidates, {},
                                   [](const Eigen::Vector2d& one) { return one.squaredNorm(); });
}

double beside_m(const Zone& zone, const StraightWay& way) {
  if (contains(zone.corners_m, way.from_m.head<2>())) return -1;
  const Segment seen = way.seen_from_above();
  double least_m = std::numeric_limits<double>::max();
  const auto& corners_m = zone.corners_m;
  for (std::size_t i = 0; i < corners_m.size(); ++i) {
    const Segment edge{corners_m[i], corners_m[i + 1 < corners_m.size() ? i + 1 : 0]};
    least_m = std::min(least_m, distance_m(seen, edge));
  }
  return least_m;
}

double above_or_below_m(const Zone& zone, const StraightWay& way) {
  if (zone.low_m >= zone.high_m) return -1;
  const double one_m = way.from_m.z(), other_m = one_m + way.along_m.z();
  return std::max(std::min(one_m, other_m) - zone.high_m, zone.low_m - std::max(one_m, other_m));
}

bool lies_outside(const Zone& zone, const StraightWay& way, double distance_m) {
  return above_or_below_m(zone, way) >= distance_m || beside_m(zone, way) >= distance_m;
}

bool is_inside(const Zone& zone, const Eigen::Vector3d& x_m) {
  const bool all_heights = zone.low_m >= zone.high_m;
  return (all_heights || (x_m.z() > zone.low_m && x_m.z() < zone.high_m)) &&
         contains(zone.corners_m, x_m.head<2>());
}

double limit_or_speed_mps(double limit_mps, const Eigen::Vector3d& wanted_mps) {
  constexpr double kMore = 1 + 1e-6, kLeast_mps = 1e-3;
  return limit_mps > 0 ? limit_mps : std::max(kLeast_mps, kMore * length_of(wanted_mps));
}

bool any_closed(std::span<const Zone> zones, Tick tick) {
  return std::ranges::any_of(zones, [tick](const Zone& zone) { return zone.closed_at(tick); });
}

bool must_leave(std::span<const Zone> zones, Tick tick, const Mission& mission,
                const Motion& motion, const StraightWay& way) {
  const double bound_m = bound_from_zones_m(mission, motion);
  return std::ranges::any_of(zones, [&](const Zone& zone) {
    return zone.closed_at(tick) && !lies_outside(zone, way, bound_m);
  });
}

Eigen::Vector3d stopped_by_zones(std::span<const Zone> zones, Tick tick, const Mission& mission,
                                 const Motion& motion, const StraightWay& way,
                                 const Eigen::Vector3d& push_m) {
  if (!any_closed(zones, tick)) return push_m;
  double share = 1;
  const auto keep = [&](double along_m, double bound_m) {
    if (along_m > bound_m) share = std::min(share, std::max(0.0, bound_m) / along_m);
  };
  const Eigen::Vector3d high_m = mission.domain.origin_m + mission.domain.size_m;
  for (int axis = 0; axis < (mission.domain.planar() ? 2 : 3); ++axis) {
    keep(push_m[axis], high_m[axis] - way.from_m[axis]);
    keep(-push_m[axis], way.from_m[axis] - mission.domain.origin_m[axis]);
  }
  const double kept_m = kept_from_zones_m(mission, motion);
  const double bound_m = bound_from_zones_m(mission, motion);
  for (const Zone& zone : zones) {
    if (!zone.closed_at(tick) || !lies_outside(zone, way, bound_m)) continue;
    const double above_m = above_or_below_m(zone, way);
    if (above_m >= beside_m(zone, way)) {
      const double up = way.from_m.z() > zone.low_m ? 1 : -1;
      keep(-up * push_m.z(), above_m - kept_m);
      continue;
    }
    for_segments({zone.corners_m}, [&](const Segment& edge) {
      const Eigen::Vector2d to_m = shortest_to_m(way.seen_from_above(), edge);
      const double apart_m = std::sqrt(to_m.squaredNorm());
      if (apart_m > 0) keep(to_m.dot(push_m.head<2>()) / apart_m, apart_m - kept_m);
    });
  }
  return share < 1 ? Eigen::Vector3d((1 - 1e-12) * share * push_m) : push_m;
}

std::optional<ZoneProblem> zone_problem(const Mission& mission, const Zone& zone,
                                        std::span<const Zone> others) {
  if (!zone_meets(zone, mission.domain))
    return ZoneProblem{"is outside of the domain", "move it into the domain"};
  if (const auto id = agent_at_home_in(mission, zone))
    return ZoneProblem{"covers the station of agent " + std::to_string(*id),
                       "leave the station out, with the clearance of its vehicle"};
  for (const AgentId id : one_of_each_kind(mission)) {
    const WayOut way(mission, id, zone, others);
    if (!way.any_outside())
      return ZoneProblem{"leaves no place of the domain for agent " + std::to_string(id),
                         "make it smaller"};
    if (std::isinf(way.longest_m()))
      return ZoneProblem{"has places from which no way leads out",
                         "join it with the walls or zones around, or leave these places out"};
    if (const auto cut = way.station_cut_off(mission))
      return ZoneProblem{"cuts the station of agent " + std::to_string(*cut) +
                             " off from the largest part of the domain",
                         "leave a way to the station that is wide enough"};
  }
  return std::nullopt;
}

Tick least_notice_ticks(const Mission& mission, const Zone& zone, std::span<const Zone> others) {
  double longest_s = 0;
  for (const AgentId id : one_of_each_kind(mission)) {
    const WayOut way(mission, id, zone, others);
    longest_s = std::max(longest_s, WayOut::needed_s(mission, id, 2 * way.longest_m()));
  }
  return static_cast<Tick>(std::ceil(longest_s / mission.timing.dt_s));
}

}  // namespace ergocast
