// SPDX-License-Identifier: BSD-3-Clause
// Takes the allowed step of a point that is nearest to the wanted one, or a sideways step if that
// one is very short.
#include "core/motion/separation.h"

#include <algorithm>
#include <limits>

#include "core/base/geometry.h"
#include "core/base/noise.h"
#include "core/base/require.h"
#include "core/mission/kinds.h"
#include "core/motion/filter_rules.h"
#include "core/motion/walls.h"
#include "core/motion/zones.h"

namespace ergocast {
namespace {

/// The longest step, as a share of V dt: rounding then does not cut its velocity.
constexpr double kReachShare = 1 - 5e-13;
/// A step shorter than this share of the wanted one is blocked.
constexpr double kBlockedShare = 0.1;
/// For how many ticks a blocked body tries one side.
constexpr Tick kSideTicks = 15;
/// The share of the wanted step in a sideways step.
constexpr double kForwardShare = 0.2;

/// The greatest coordinate that a place in `domain` can have.
double greatest_coordinate_m(const Box& domain) {
  return domain.origin_m.cwiseAbs().maxCoeff() + domain.size_m.maxCoeff();
}

std::vector<Motion> motions_in(const Mission& mission) {
  std::vector<Motion> motions = {motion_of_kind(mission, 0)};
  for (int kind = 1; kind < std::ssize(mission.kinds); ++kind)
    motions.push_back(motion_of_kind(mission, kind));
  return motions;
}

}  // namespace

double closing_gain(const Mission& mission) {
  const double response_s = mission.separation.response_s;
  return response_s > 0 ? std::min(1.0, mission.timing.dt_s / (4 * response_s)) : 1;
}

SeparationFilter::SeparationFilter(const Mission& mission, Tick hold_ticks)
    : mission_(mission),
      motions_(motions_in(mission)),
      hold_ticks_(static_cast<double>(hold_ticks)),
      gain_(closing_gain(mission)),
      rounding_m_(kContactTicks * 4 * std::numeric_limits<double>::epsilon() *
                  (greatest_coordinate_m(mission.domain) + mission.separation.distance_m)),
      // A wall that touches a body may need four sets.
      constraints_(kMaxAgents + 4 * vertex_count(mission.walls)) {
  taken_.reserve(kMaxAgents + 4 * vertex_count(mission.walls));
  near_.reserve(vertex_count(mission.walls));
  for (const Motion& motion : motions_)
    kept_from_walls_m_.push_back(kept_from_walls_m(mission, motion));
  for (const Motion& motion : motions_) {
    kept_from_zones_m_.push_back(kept_from_zones_m(mission, motion));
    bound_from_zones_m_.push_back(bound_from_zones_m(mission, motion));
  }
  for (const Motion& one : motions_) {
    for (const Motion& other : motions_) pairs_.push_back(pair_between(one, other));
  }
}

void SeparationFilter::set_zones(std::span<const Zone> zones) {
  zones_.assign(zones.begin(), zones.end());
  std::size_t edges = vertex_count(mission_.walls);
  for (const Zone& zone : zones_) edges += zone.corners_m.size();
  constraints_ = StepConstraints(kMaxAgents + 4 * edges);
  taken_.reserve(kMaxAgents + 4 * edges);
}

const Motion& SeparationFilter::motion_of(AgentId id) const {
  return motions_[static_cast<std::size_t>(planned_kind(mission_, id))];
}

const SeparationFilter::Pair& SeparationFilter::pair_of(AgentId one, AgentId other) const {
  const auto row = static_cast<std::size_t>(planned_kind(mission_, one));
  return pairs_[row * motions_.size() + static_cast<std::size_t>(planned_kind(mission_, other))];
}

SeparationFilter::Pair SeparationFilter::pair_between(const Motion& one,
                                                      const Motion& other) const {
  const double limit_mps = one.speed_limit_mps, its_mps = other.speed_limit_mps;
  const double reach = reach_m(one, limit_mps), tolerance = StepConstraints::kTolerance;
  const double circles_m = loiter_radius_m(one) + loiter_radius_m(other);
  const double kept_m = mission_.separation.distance_m + margin_m(std::max(limit_mps, its_mps)) +
                        circles_m + (bulge_m(one) + bulge_m(other)) + rounding_m_ +
                        kContactTicks * (tolerance * (reach + reach_m(other, its_mps)));
  return {kept_m, circles_m + longest_braking_path_m(one) + longest_braking_path_m(other), reach};
}

double SeparationFilter::contact_m(AgentId one, AgentId other) const {
  return pair_of(one, other).kept_m;
}

/// What disturbance and response time add to D. A disturbance closes 2 w in a tick. If one of the
/// two bodies cannot move away, the other opens κ/2 of the gap that is missing.
double SeparationFilter::margin_m(double fastest_mps) const {
  const Separation& rule = mission_.separation;
  return 4 * rule.disturbance_m / gain_ + rule.response_s * fastest_mps;
}

double SeparationFilter::uncertainty_m(const Mover& self, const Neighbour& other) const {
  const Separation& rule = mission_.separation;
  const double dt_s = mission_.timing.dt_s;
  const auto age_ticks = static_cast<double>(other.age_ticks);
  return age_ticks * (other.max_speed_mps * dt_s + rule.disturbance_m) +
         hold_ticks_ *
             ((self.max_speed_mps + other.max_speed_mps) * dt_s + 2 * rule.disturbance_m) +
         2 * rule.position_error_m;
}

/// Forgets all others. Only the domain, seen from the body, remains: a step out of it would be
/// folded back at its edge, perhaps into another body.
void SeparationFilter::begin(const Mover& self, double reach_m) {
  const Separation& rule = mission_.separation;
  const Box& domain = mission_.domain;
  const double error_m =
      rule.response_s > 0 ? late_edge_margin_m(mission_, self.id) : rule.position_error_m;
  const double edge_m =
      hold_ticks_ * (self.max_speed_mps * mission_.timing.dt_s + rule.disturbance_m) + error_m +
      loiter_radius_m(motion_of(self.id));
  const Eigen::Vector3d inset_m = Eigen::Vector3d::Constant(edge_m);
  const Eigen::Vector3d low_m = domain.origin_m - self.position_m + inset_m;
  const Eigen::Vector3d high_m = domain.origin_m + domain.size_m - self.position_m - inset_m;
  StepConstraints::Room room{reach_m, gain_ * low_m.cwiseMin(0.0), gain_ * high_m.cwiseMax(0.0)};
  if (domain.planar()) room.low_m.z() = room.high_m.z() = 0;
  constraints_.begin(room);
  taken_.clear();
}

void SeparationFilter::take(AgentId whose, const StepConstraints::Set& set) {
  taken_.push_back(whose);
  constraints_.add(set);
}

/// The result names the neighbour or wall whose set the step exceeds most, if there is one.
SafeVelocity SeparationFilter::blocked_by(const Eigen::Vector3d& wanted_m) const {
  const int most = constraints_.most_exceeded(wanted_m);
  const AgentId by = most < 0 ? kUnassigned : taken_[static_cast<std::size_t>(most)];
  return {{0, 0, 0}, true, by, most >= 0 && by == kUnassigned};
}

/// ±1. If all took the same side they would still block each other, so each draws its side again
/// every kSideTicks.
double SeparationFilter::side(const Mover& self) const {
  const RandomBits bits =
      random_words(mission_.seed, Purpose::kSide, static_cast<std::uint32_t>(self.id),
                   static_cast<std::uint64_t>(self.tick / kSideTicks));
  return bits.first >> 63 == 0 ? 1 : -1;
}

SafeVelocity SeparationFilter::safe(const Mover& self, const Eigen::Vector3d& wanted_mps,
                                    std::span<const Neighbour> others) {
  ERGOCAST_REQUIRE(self.max_speed_mps > 0);
  if (!keeps_distance(mission_)) others = {};
  for (const Neighbour& other : others) {
    if (other.id != self.id && !other.known) return stopped(self, other);
  }
  switch (motion_of(self.id).vehicle.kind) {
    case VehicleKind::kAcceleration:
      return safe_change(self, wanted_mps, others);
    case VehicleKind::kUnicycle:
      return safe_arc(self, wanted_mps, others);
    case VehicleKind::kFixedWing:
      return safe_circle(self, wanted_mps, others);
    case VehicleKind::kPoint:
      break;
  }
  return safe_step(self, wanted_mps, others);
}

/// The body stands, brakes as hard as it can, or loiters, because `other` may be anywhere around.
SafeVelocity SeparationFilter::stopped(const Mover& self, const Neighbour& other) const {
  return {executed(motion_of(self.id), self.velocity_mps, {0, 0, 0}), true, other.id, false, true};
}

// ---- points ----

/// A step across the wanted one, and a little along it.
Eigen::Vector3d SeparationFilter::sideways(const Mover& self,
                                           const Eigen::Vector3d& wanted_m) const {
  return kForwardShare * wanted_m + side(self) * Eigen::Vector3d(-wanted_m.y(), wanted_m.x(), 0);
}

SafeVelocity SeparationFilter::safe_step(const Mover& self, const Eigen::Vector3d& wanted_mps,
                                         std::span<const Neighbour> others) {
  const double dt_s = mission_.timing.dt_s;
  begin(self, self.max_speed_mps * dt_s * kReachShare);
  if (const Neighbour* blind = keep_from_all(self, others)) return stopped(self, *blind);
  Eigen::Vector3d possible_mps = wanted_mps;
  if (mission_.domain.planar()) possible_mps.z() = 0;
  const Eigen::Vector3d wanted_m = within_speed(possible_mps, self.max_speed_mps) * dt_s;
  if (constraints_.allow(wanted_m)) return {wanted_mps};

  SafeVelocity safe = blocked_by(wanted_m);
  Eigen::Vector3d step_m = constraints_.nearest(wanted_m);
  const double shortest_m = kBlockedShare * length_of(wanted_m);
  // An agent that faces a wall goes along it for longer, core/motion/wall_following.h.
  if (length_of(step_m) < shortest_m && (!safe.wall || !mission_.domain.planar())) {
    const Eigen::Vector3d beside_m = constraints_.nearest(sideways(self, wanted_m));
    const bool better = constraints_.allow(beside_m) && length_of(beside_m) > length_of(step_m);
    if (better) step_m = beside_m;
  }
  safe.blocked = length_of(step_m) < shortest_m;
  safe.velocity_mps = step_m / dt_s;
  return safe;
}

}  // namespace ergocast
