// SPDX-License-Identifier: BSD-3-Clause
// Turns what is known of other bodies into constraints, and takes the nearest step; or one
// sideways, where that is next to none.
#include "core/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/noise.h"
#include "core/require.h"
#include "core/vehicle.h"

namespace ergocast {
namespace {

/// Unbroken contact of so many ticks loses no more to rounding than D' has more than D.
constexpr double kContactTicks = 1e6;
/// The longest step, as a share of V dt: the velocity that it is made from is not cut by rounding.
constexpr double kReachShare = 1 - 5e-13;
/// A step shorter than this share of the wanted one is blocked.
constexpr double kBlockedShare = 0.1;
/// A blocked body tries one side for so many ticks.
constexpr Tick kSideTicks = 15;
/// How much of the wanted step stays in one sideways.
constexpr double kForwardShare = 0.2;

/// The greatest coordinate that a place in `domain` can have.
double greatest_coordinate_m(const Box& domain) {
  return domain.origin_m.cwiseAbs().maxCoeff() + domain.size_m.maxCoeff();
}

/// κ: a body that follows late closes less than the whole gap in a tick.
double gain_of(double response_s, double dt_s) {
  return response_s > 0 ? std::min(1.0, dt_s / (4 * response_s)) : 1;
}

}  // namespace

SeparationFilter::SeparationFilter(const Mission& mission, Tick hold_ticks)
    : mission_(mission),
      hold_ticks_(static_cast<double>(hold_ticks)),
      gain_(gain_of(mission.separation.response_s, mission.timing.dt_s)),
      rounding_m_(kContactTicks * 4 * std::numeric_limits<double>::epsilon() *
                  (greatest_coordinate_m(mission.domain) + mission.separation.distance_m)),
      constraints_(kMaxAgents) {
  ERGOCAST_REQUIRE(filters_commands(mission));
}

double SeparationFilter::contact_m(double max_speed_mps) const {
  const double tolerance_m = 2 * StepConstraints::kTolerance * reach_m(mission_, max_speed_mps);
  return mission_.separation.distance_m + margin_m(max_speed_mps) + 2 * loiter_radius_m(mission_) +
         2 * bulge_m(mission_) + rounding_m_ + kContactTicks * tolerance_m;
}

/// What disturbance and response time add to D. A disturbance closes 2 w in a tick, and where one
/// of the two bodies cannot move away, the other opens κ/2 of the gap that is missing.
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

/// Forgets all others. The domain, seen from the body, stays: a step that leaves it would be folded
/// back at its edge, into whoever is there.
void SeparationFilter::begin(const Mover& self, double reach_m) {
  const Separation& rule = mission_.separation;
  const Box& domain = mission_.domain;
  const double edge_m =
      hold_ticks_ * (self.max_speed_mps * mission_.timing.dt_s + rule.disturbance_m) +
      rule.position_error_m + loiter_radius_m(mission_);
  const Eigen::Vector3d inset_m = Eigen::Vector3d::Constant(edge_m);
  const Eigen::Vector3d low_m = domain.origin_m - self.position_m + inset_m;
  const Eigen::Vector3d high_m = domain.origin_m + domain.size_m - self.position_m - inset_m;
  StepConstraints::Room room{reach_m, low_m.cwiseMin(0.0), high_m.cwiseMax(0.0)};
  if (domain.planar()) room.low_m.z() = room.high_m.z() = 0;
  constraints_.begin(room);
  taken_count_ = 0;
}

void SeparationFilter::take(const Neighbour& other, const StepConstraints::Set& set) {
  taken_[taken_count_++] = other.id;
  constraints_.add(set);
}

/// Whose set the step exceeds most; kUnassigned: none, or an edge.
AgentId SeparationFilter::blocker(const Eigen::Vector3d& wanted_m) const {
  const int by = constraints_.most_exceeded(wanted_m);
  return by < 0 ? kUnassigned : taken_[static_cast<std::size_t>(by)];
}

/// ±1: all on one side would still block each other, so each draws its side, again and again.
double SeparationFilter::side(const Mover& self) const {
  const RandomBits bits =
      random_words(mission_.seed, Purpose::kSide, static_cast<std::uint32_t>(self.id),
                   static_cast<std::uint64_t>(self.tick / kSideTicks));
  return bits.first >> 63 == 0 ? 1 : -1;
}

SafeVelocity SeparationFilter::safe(const Mover& self, const Eigen::Vector3d& wanted_mps,
                                    std::span<const Neighbour> others) {
  ERGOCAST_REQUIRE(self.max_speed_mps > 0);
  if (mission_.separation.distance_m == 0) others = {};
  for (const Neighbour& other : others) {
    if (other.id != self.id && !other.known) return stopped(self, other);
  }
  switch (mission_.vehicle.kind) {
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

/// It stands, brakes as hard as it can or loiters, since `other` may be anywhere around.
SafeVelocity SeparationFilter::stopped(const Mover& self, const Neighbour& other) const {
  return {executed(mission_, self.velocity_mps, {0, 0, 0}), true, other.id, true};
}

// ---- points
// ----------------------------------------------------------------------------------------

/// False if the neighbour may be anywhere around.
bool SeparationFilter::take_step(const Mover& self, const Neighbour& other) {
  const Separation& rule = mission_.separation;
  Eigen::Vector3d y_m = other.position_m - self.position_m;
  if (mission_.domain.planar()) y_m.z() = 0;
  const double share = self.max_speed_mps / (self.max_speed_mps + other.max_speed_mps);
  const double near_m = uncertainty_m(self, other);
  const double kept_m = contact_m(std::max(self.max_speed_mps, other.max_speed_mps));
  const double far_m = near_m + kept_m + reach_m(mission_, self.max_speed_mps) / (gain_ * share);
  const double square_m2 = y_m.squaredNorm();
  if (square_m2 >= far_m * far_m) return true;
  const double rho_m = std::sqrt(square_m2);
  if (rho_m <= near_m) return false;
  double gap_m = rho_m - near_m - kept_m;
  if (rule.disturbance_m == 0 && rule.response_s == 0) gap_m = std::max(0.0, gap_m);
  take(other, {y_m / rho_m, near_m / rho_m, gain_ * share * gap_m});
  return true;
}

/// Across the wanted step, and a little along it.
Eigen::Vector3d SeparationFilter::sideways(const Mover& self,
                                           const Eigen::Vector3d& wanted_m) const {
  return kForwardShare * wanted_m + side(self) * Eigen::Vector3d(-wanted_m.y(), wanted_m.x(), 0);
}

SafeVelocity SeparationFilter::safe_step(const Mover& self, const Eigen::Vector3d& wanted_mps,
                                         std::span<const Neighbour> others) {
  const double dt_s = mission_.timing.dt_s;
  begin(self, self.max_speed_mps * dt_s * kReachShare);
  for (const Neighbour& other : others) {
    if (other.id != self.id && !take_step(self, other)) return stopped(self, other);
  }
  Eigen::Vector3d possible_mps = wanted_mps;
  if (mission_.domain.planar()) possible_mps.z() = 0;
  const Eigen::Vector3d wanted_m = within_speed(possible_mps, self.max_speed_mps) * dt_s;
  if (constraints_.allow(wanted_m)) return {wanted_mps};

  SafeVelocity safe;
  safe.by = blocker(wanted_m);
  Eigen::Vector3d step_m = constraints_.nearest(wanted_m);
  const double shortest_m = kBlockedShare * length_of(wanted_m);
  if (length_of(step_m) < shortest_m) {
    const Eigen::Vector3d beside_m = constraints_.nearest(sideways(self, wanted_m));
    const bool better = constraints_.allow(beside_m) && length_of(beside_m) > length_of(step_m);
    if (better) step_m = beside_m;
  }
  safe.blocked = length_of(step_m) < shortest_m;
  safe.velocity_mps = step_m / dt_s;
  return safe;
}

namespace {

/// By how much the distance of two bodies can change in so many ticks.
double closed_m(const Mission& mission, Tick ticks) {
  const double step_m =
      (mission.speed_limit_mps + mission.vehicle.min_speed_mps) * mission.timing.dt_s +
      mission.separation.disturbance_m;
  return 2 * static_cast<double>(ticks) * step_m;
}

}  // namespace

double start_distance_m(const Mission& mission) {
  const Separation& rule = mission.separation;
  if (rule.distance_m == 0) return 0;
  // Loiter centres may lie between their vehicles.
  return rule.distance_m + 2 * bulge_m(mission) + 4 * loiter_radius_m(mission) +
         2 * (2 * rule.position_error_m + closed_m(mission, unguarded_hold_ticks(mission)));
}

double join_distance_m(const Mission& mission) {
  return start_distance_m(mission) + closed_m(mission, unguarded_hold_ticks(mission) + 1) +
         longest_braking_path_m(mission);
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
  const double diameter_m = start_distance_m(mission);
  const Eigen::Vector3d& size_m = mission.domain.size_m;
  const double disc = std::numbers::pi / 4 * diameter_m * diameter_m / (size_m.x() * size_m.y());
  // A ball is two thirds of a disc as thick as the ball is wide.
  const double share = mission.domain.planar() ? disc : disc * 2 / 3 * diameter_m / size_m.z();
  return static_cast<double>(bodies) * share;
}

Eigen::Vector3d start_beside(const Mission& mission, AgentId id,
                             std::span<const Eigen::Vector3d> others_m, double distance_m) {
  const Box room = room_to_begin(mission);
  Eigen::Vector3d best_m{0, 0, 0};
  double best_distance_m = -1;
  for (int attempt = 0; attempt < kMostDraws; ++attempt) {
    const Eigen::Vector3d x_m = random_start(room, mission.seed, id, attempt);
    double nearest_m = std::numeric_limits<double>::max();
    for (const Eigen::Vector3d& other_m : others_m)
      nearest_m = std::min(nearest_m, length_of(other_m - x_m));
    if (nearest_m <= best_distance_m) continue;
    best_m = x_m;
    best_distance_m = nearest_m;
    if (nearest_m >= distance_m) break;
  }
  return best_m;
}

Tick command_hold_ticks(const Timing& timing) {
  // A command that is exactly as old as command_hold_s is still executed.
  return static_cast<Tick>(std::floor(timing.command_hold_s / timing.dt_s + 1e-6));
}

bool world_guards(const Mission& mission) {
  return mission.separation.distance_m > 0 && mission.separation.guard &&
         mission.timing.pace == Pace::kRealtime;
}

bool sure_of_bodies(const Mission& mission) {
  const Separation& rule = mission.separation;
  return rule.position_error_m == 0 && rule.disturbance_m == 0 && rule.response_s == 0 &&
         (rule.guard || mission.timing.pace == Pace::kLockstep);
}

Tick unguarded_hold_ticks(const Mission& mission) {
  const bool held = mission.timing.pace == Pace::kRealtime && !world_guards(mission);
  return held ? command_hold_ticks(mission.timing) : 0;
}

}  // namespace ergocast
