// SPDX-License-Identifier: BSD-3-Clause
// Checks the places of bodies among zones. A body that was surely outside of a closed zone must
// never be inside: it was so far outside that it could have stopped in whatever direction it moved.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/mission/kinds.h"
#include "core/motion/vehicle.h"
#include "lab/invariants.h"

namespace ergocast::lab {
namespace {

/// What a margin for rounding may add to a distance, as a share of the longer side.
constexpr double kSpareShare = 1e-4;

/// Whether the ray from `x_m` to the right meets the ring an odd number of times.
bool in_ring(const Ring& ring, const Eigen::Vector3d& x_m) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Eigen::Vector2d &a_m = ring[i], &b_m = ring[j];
    if ((a_m.y() > x_m.y()) == (b_m.y() > x_m.y())) continue;
    const double at_m = a_m.x() + (x_m.y() - a_m.y()) / (b_m.y() - a_m.y()) * (b_m.x() - a_m.x());
    inside ^= x_m.x() < at_m;
  }
  return inside;
}

double from_edges_m(const Ring& ring, const Eigen::Vector3d& x_m) {
  double least_m = std::numeric_limits<double>::max();
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Eigen::Vector2d along_m = ring[i] - ring[j], to_m = x_m.head<2>() - ring[j];
    const double share = std::clamp(to_m.dot(along_m) / along_m.squaredNorm(), 0.0, 1.0);
    least_m = std::min(least_m, (to_m - share * along_m).norm());
  }
  return least_m;
}

/// How far outside of a zone a place is; below 0 inside [m].
double outside_m(const Zone& zone, const Eigen::Vector3d& x_m) {
  const double edge_m = from_edges_m(zone.corners_m, x_m);
  const double beside_m = in_ring(zone.corners_m, x_m) ? -edge_m : edge_m;
  if (zone.low_m == zone.high_m) return beside_m;
  return std::max({beside_m, x_m.z() - zone.high_m, zone.low_m - x_m.z()});
}

/// Outside by this much a body is bound, however it moves [m].
double surely_bound_m(const Mission& mission, AgentId id) {
  const Motion motion = motion_of(mission, id);
  return mission.wall_clearance_m + 2 * loiter_radius_m(motion) + longest_braking_path_m(motion) +
         bulge_m(motion) + kSpareShare * mission.domain.size_m.maxCoeff();
}

}  // namespace

void Invariants::check_zones(double t_s, const WorldState& world) {
  // Another world may find a vehicle where it was some ticks ago.
  if (world.header.incarnation != zone_world_) beside_zones_.clear();
  zone_world_ = world.header.incarnation;
  for (const Zone& zone : truth_.amendments().zones) {
    // Bodies may enter it when it is cancelled, and a coordinator that does not know of that may
    // take over.
    if (zone.cancelled >= 0 && zone.cancelled <= world.header.tick) forget_bound(zone.number);
    const auto named = zone_revisions_.find(zone.number);
    // In real time a world may not have received it yet.
    if (named == zone_revisions_.end() || world.roster_revision < named->second) continue;
    if (zone.closed_at(world.header.tick)) check_zone(t_s, world, zone);
  }
}

void Invariants::note_zone(const Zone& zone) {
  // The list of another coordinator may give a number to another zone.
  const auto known = zones_.find(zone.number);
  if (known != zones_.end() &&
      (known->second.closed != zone.closed || zone_hash(known->second) != zone_hash(zone))) {
    zone_revisions_.erase(zone.number);
    std::erase_if(beside_zones_, [&](const auto& one) { return one.first.first == zone.number; });
  }
  zone_revisions_.try_emplace(zone.number, truth_.revision());
  zones_.insert_or_assign(zone.number, zone);
}

void Invariants::forget_bound(std::int32_t zone) {
  for (auto& [which, beside] : beside_zones_)
    if (which.first == zone) beside.bound = false;
}

void Invariants::check_zone(double t_s, const WorldState& world, const Zone& zone) {
  const Tick tick = world.header.tick;
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    BesideZone& beside =
        beside_zones_.try_emplace({zone.number, vehicle.id}, BesideZone{tick}).first->second;
    const double apart_m = outside_m(zone, vehicle.position_m);
    const std::string who = "vehicle " + std::to_string(vehicle.id);
    const auto where = [&] {
      return std::to_string(-apart_m) + " m inside the zone of amendment " +
             std::to_string(zone.number) + " at tick " + std::to_string(tick) +
             ", closed from tick " + std::to_string(zone.closed) + ", free from " +
             std::to_string(zone.from);
    };
    if (apart_m < 0 && beside.bound) violate(t_s, Invariant::kZonesNotEntered, who, where());
    // An agent that joined later may have begun inside.
    const bool was_there = beside.first_seen == zone.closed;
    if (apart_m < 0 && zones_are_left_ && tick >= zone.from && was_there)
      violate(t_s, Invariant::kZonesLeft, who, where());
    beside.bound = beside.bound || apart_m > surely_bound_m(mission_, vehicle.id);
  }
}

/// Whether a body may have to leave a zone: it is inside, or not surely outside.
bool Invariants::may_leave_a_zone(AgentId id, const Eigen::Vector3d& x_m, Tick tick) const {
  const double limit_mps = motion_of(mission_, id).speed_limit_mps;
  const double u_max_mps = law_of(mission_, planned_kind(mission_, id)).u_max_mps;
  const double step_m = std::max(limit_mps, u_max_mps) * mission_.timing.dt_s;
  return std::ranges::any_of(truth_.amendments().zones, [&](const Zone& zone) {
    // The velocity in a state is that of the step that led there. In real time an agent may not
    // know yet that a zone is cancelled.
    const bool exact = mission_.timing.pace == Pace::kLockstep;
    const bool counts = zone.closed <= tick && tick <= (exact ? zone.end() : zone.until);
    return counts && outside_m(zone, x_m) <= surely_bound_m(mission_, id) + step_m;
  });
}

}  // namespace ergocast::lab
