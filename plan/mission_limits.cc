// SPDX-License-Identifier: BSD-3-Clause
// Checks a mission against its limits, field by field.
#include "plan/mission_limits.h"

#include <algorithm>
#include <cmath>

#include "core/law/site_row.h"
#include "core/measure/detection.h"
#include "core/measure/drift.h"
#include "core/mission/amendments.h"
#include "core/mission/kinds.h"
#include "core/mission/sites.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/home.h"
#include "core/motion/starts.h"
#include "core/motion/vehicle.h"
#include "core/motion/walls.h"
#include "plan/mission_fields.h"

namespace ergocast {
namespace {

/// ASCII only: std::isalnum depends on the locale.
bool may_lead(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}
bool may_follow(char c) { return may_lead(c) || c == '-' || c == '.'; }

bool is_place(const Eigen::Vector3d& x_m) {
  return limits::kCoordinate_m.contain(x_m.x()) && limits::kCoordinate_m.contain(x_m.y()) &&
         limits::kCoordinate_m.contain(x_m.z());
}

/// Checks each field by itself.
class EachWithinLimits : public FieldVisitor {
 public:
  bool ok = true;

  void number(const Field& field, double value) {
    const When& when = field.when;
    ok = ok && (when.given ? field.limits.contain(value) : value == when.otherwise);
  }
  void choice(const Field&, auto value, Words words) {
    ok = ok && static_cast<std::size_t>(value) < words.size();
  }
  void text(const Field& field, const std::string& name) {
    ok = ok && is_name(name) && field.limits.contain(static_cast<double>(name.size()));
  }
  void part(const Field&, const auto& part) { list_fields(*this, part); }
  void part(const Field&, const std::vector<AgentKind>& kinds) {
    for (const AgentKind& kind : kinds) list_fields(*this, kind);
  }
  void part(const Field&, const std::optional<VehicleLimits>& vehicle) {
    if (vehicle) list_fields(*this, *vehicle);
  }
  void places(const Field&, const Field&, const Eigen::Vector3d& x_m) { ok = ok && is_place(x_m); }
  void places(const Field&, const Field&, const std::vector<Eigen::Vector3d>& places_m) {
    ok = ok && std::ranges::all_of(places_m, is_place);
  }
};

/// A plane has the height 0.
bool fits(const Box& domain) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(domain.origin_m[axis]) <= limits::kMaxOriginPerSize * domain.size_m[axis]))
      return false;
  }
  return true;
}

/// A single mode cannot distinguish two places, and a plane has one mode along z.
bool fit_together(const Basis& basis, const Box& domain) {
  return basis.mode_count() >= 2 && basis.mode_count() <= kMaxModes &&
         (basis.planar() || !domain.planar());
}

bool in_domain(const Box& domain, const Eigen::Vector3d& x_m) {
  return domain.contains(x_m) && (x_m.z() == 0 || !domain.planar());
}

/// A plan that names a table also has μ in cosines. Footprints and bands need cosines.
bool fits(const Basis& basis, const Mission& mission) {
  if (!basis.free_domain) return basis.table_hash == 0;
  const auto sees_points = [](const AgentKind& kind) {
    return kind.footprint_sigma_m == 0 && kind.band_from == 0 && kind.band_to == 0;
  };
  return basis.table_hash != 0 && basis.mode_count() <= kMostFreeModes && mission.domain.planar() &&
         std::ranges::all_of(mission.kinds, sees_points);
}

/// Adaptive noise is between its floor and its ceiling.
bool fits(const ControlLaw& law) {
  return law.perturbation == Perturbation::kConstant || law.noise_ceiling >= law.noise_intensity;
}

/// Rows of a search are of cells in a plane.
bool fits(LawKind kind, const Box& domain) { return kind != LawKind::kSearch || domain.planar(); }

/// Some steps are needed between two halvings.
bool memory_fits(const ControlLaw& law, double dt_s) {
  return law.memory_half_life_s == 0 ||
         law.memory_half_life_s >= limits::kLeastHalfLife_ticks * dt_s;
}

bool fits(const Timing& timing) {
  const bool realtime = timing.pace == Pace::kRealtime;
  return is_tick_count(timing.tick_count, timing) &&
         limits::kPeriod_ticks.contain(static_cast<double>(longest_period_ticks(timing))) &&
         (!realtime || timing.dt_s / timing.realtime_factor >= limits::kMinWallStep_s);
}

/// No step of input, noise or contraction is longer than the domain, and the input is as fast as
/// the contraction everywhere.
/// @pre each of them is within its own limits
bool fit_together(const ControlLaw& law, double disturbance_intensity, const Box& domain,
                  double dt_s) {
  if (domain.planar() && law.contraction_center_m.z() != 0) return false;
  const double side_m = domain.shortest_side_m();
  const double reach_m = domain.farthest_distance_m(law.contraction_center_m);
  const auto noise_fits = [&](double intensity) { return intensity * std::sqrt(dt_s) <= side_m; };
  return law.u_max_mps * dt_s <= side_m && noise_fits(law.noise_intensity) &&
         noise_fits(law.noise_ceiling) && noise_fits(disturbance_intensity) &&
         law.contraction_gain_per_s * dt_s <= 1 &&
         law.u_max_mps >= law.contraction_gain_per_s * reach_m;
}

/// A kind has its own limits and no others.
bool fits(const VehicleLimits& vehicle) {
  const bool has_inertia = vehicle.kind == VehicleKind::kAcceleration;
  const bool has_wings = vehicle.kind == VehicleKind::kFixedWing;
  const bool turns = has_wings || vehicle.kind == VehicleKind::kUnicycle;
  return (vehicle.max_acceleration_mps2 > 0) == has_inertia &&
         (vehicle.max_turn_radps > 0) == turns && (vehicle.min_speed_mps > 0) == has_wings;
}

/// Whether a vehicle has a speed limit if it or the mission relies on one, and room to brake or to
/// loiter.
bool fits(const Motion& motion, double u_max_mps, const Separation& separation) {
  const VehicleLimits& vehicle = motion.vehicle;
  const double step_m = motion.speed_limit_mps * motion.dt_s;
  const bool limited = motion.speed_limit_mps > 0 && separation.disturbance_m < step_m / 4;
  if (separation.distance_m > 0 && !limited) return false;
  if (motion.is_point()) return true;
  const bool turns = !motion.has_inertia();
  const double room_m = motion.domain.shortest_side_m() / 4;
  return motion.speed_limit_mps > 0 && (motion.domain.planar() || !turns) &&
         vehicle.min_speed_mps < std::min(motion.speed_limit_mps, u_max_mps) &&
         longest_braking_path_m(motion) <= room_m && loiter_radius_m(motion) <= room_m;
}

/// Whether each body can move in the domain as the mission requires.
bool bodies_fit(const Mission& mission) {
  if (!fits(mission.vehicle)) return false;
  for (int kind = 0; kind < std::max<int>(1, static_cast<int>(mission.kinds.size())); ++kind) {
    const Motion motion = motion_of_kind(mission, kind);
    if (!fits(motion.vehicle) || !fits(motion, law_of(mission, kind).u_max_mps, mission.separation))
      return false;
  }
  for (AgentId id = 0; id < std::ssize(mission.starts_m); ++id) {
    const Eigen::Vector3d& start_m = mission.starts_m[static_cast<std::size_t>(id)];
    if (!room_to_begin(motion_of(mission, id)).contains(start_m)) return false;
  }
  return true;
}

/// A lease requires that no other process knows the places, and that all agents receive each other.
bool lease_fits(const Mission& mission) {
  if (mission.separation.lease_s == 0) return true;
  const Tick ticks = lease_ticks(mission);
  return ticks >= kLeastLeaseTicks && ticks <= kMostLeaseTicks && !mission.separation.guard &&
         mission.separation.disturbance_m == 0 && mission.radio_range_m == 0 &&
         mission.starts_m.size() <= kMostLeasedAgents;
}

/// Whether bodies have the room that keeping a distance needs.
bool fits(const Separation& separation, const Mission& mission) {
  if (separation.distance_m == 0) return !separation.guard && separation.lease_s == 0;
  if (!lease_fits(mission)) return false;
  if (any_but_points(mission) && !sure_of_bodies(mission)) return false;
  const double held_s = static_cast<double>(unguarded_hold_ticks(mission)) * mission.timing.dt_s;
  return separation.distance_m <= mission.domain.shortest_side_m() / 4 &&
         2 * held_s * fastest_mps(mission) <= separation.distance_m / 2 * (1 + 1e-9) &&
         packing(mission, mission.starts_m.size()) <= kHopelessPacking &&
         !too_near_at_start(mission);
}

/// A battery needs a station, and has both numbers or none.
bool fits(const Battery& battery, const AgentKind& kind) {
  if (!battery.any())
    return battery.power_w == 0 && battery.charge_w == 0 && battery.reserve == Battery().reserve;
  return battery.power_w > 0 && !kind.stations_m.empty();
}

bool fits(const AgentKind& kind, const Mission& mission) {
  const bool ends_in_order = kind.band_to == 0 || kind.band_from <= kind.band_to;
  const ControlLaw law = law_of(mission, *kind_named(mission, kind.name));
  return kind.footprint_sigma_m <= mission.domain.size_m.maxCoeff() && ends_in_order &&
         (kind.reserve_s == 0 || !kind.stations_m.empty()) && fits(kind.battery, kind) &&
         covers_any_mode(kind, mission.basis) && fits(law) &&
         fit_together(law, mission.disturbance_intensity, mission.domain, mission.timing.dt_s);
}

/// Their names differ, and each planned agent is of one kind.
bool are_kinds(const Mission& mission) {
  const std::vector<AgentKind>& kinds = mission.kinds;
  if (kinds.empty()) return true;
  if (kinds.size() > static_cast<std::size_t>(kMaxKinds)) return false;
  std::size_t count = 0;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    if (kind_named(mission, kinds[kind].name) != static_cast<int>(kind)) return false;
    count += static_cast<std::size_t>(kinds[kind].count);
  }
  return count == mission.starts_m.size() &&
         std::ranges::all_of(kinds, [&](const AgentKind& kind) { return fits(kind, mission); });
}

/// Drifting objects need room for a step, and not too many legs.
bool drift_fits(const Mission& mission) {
  const ObjectMotion& motion = mission.objects.motion;
  if (!motion.any()) return motion.persistence_s == ObjectMotion().persistence_s;
  return motion.speed_mps <= max_drift_mps(mission.domain, mission.timing.dt_s) &&
         drift_legs(mission) <= kMaxLegs;
}

/// Either a count or places, in a plane. Places are free. An end that nobody knows before leaves no
/// time to go to a station.
bool fits(const HiddenObjects& objects, const Mission& mission) {
  if (objects.end_when_found > objects.total()) return false;
  if (objects.end_when_found > 0 && any_station(mission)) return false;
  if (!drift_fits(mission)) return false;
  if (objects.total() == 0) return !objects.motion.any();
  const auto free = [&](const Eigen::Vector3d& x_m) {
    return in_domain(mission.domain, x_m) && !solid_at(mission.walls, x_m.head<2>());
  };
  return mission.domain.planar() && objects.total() <= kMaxObjects &&
         (objects.count == 0 || objects.places_m.empty()) &&
         std::ranges::all_of(objects.places_m, free);
}

/// Reports are cells of a plane. An end by finding needs finds that the world knows at once.
bool fits(const SearchSensor& sensor, const Mission& mission) {
  if (sensor.position_error_m > sensor_radius_m(mission) / 2) return false;
  return !sensor.has_false_alarms() ||
         (mission.domain.planar() && mission.objects.end_when_found == 0);
}

/// Each site has a member and fits in a row.
bool sites_fit(const Mission& mission) {
  const TeamSites& sites = mission.sites;
  if (!sites.any()) return sites.row_period_ticks == TeamSites().row_period_ticks;
  return static_cast<std::size_t>(sites.count) <= mission.starts_m.size() &&
         static_cast<std::size_t>(most_members(mission)) <= kMostMemberRows &&
         why_no_sites(mission) == nullptr;
}

bool is_team(const Mission& mission) {
  const auto size = static_cast<double>(mission.starts_m.size());
  const auto& starts_m = mission.starts_m;
  const auto inside = [&](const Eigen::Vector3d& x_m) { return in_domain(mission.domain, x_m); };
  const double most = mission.sites.any() ? kMostAgentsOfSites : kMaxAgents;
  return size >= 1 && size <= most && mission.quorum <= size &&
         std::all_of(starts_m.begin(), starts_m.end(), inside);
}

}  // namespace

bool is_kind_name(std::string_view name) {
  return is_name(name) && name.size() <= kMaxKindNameLength;
}

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxNameLength && may_lead(name.front()) &&
         std::all_of(name.begin(), name.end(), may_follow);
}

bool is_tick_count(Tick tick_count, Timing timing) {
  timing.tick_count = tick_count;
  const auto ticks = static_cast<double>(tick_count);
  return ticks >= 1 && ticks <= limits::kMaxTicks &&
         std::round(duration_s(timing) / timing.dt_s) == ticks;
}

bool is_law(const LawChange& change, const Mission& mission) {
  if (!bounded_by_plan(change, mission)) return false;
  for (int kind = 0; kind < std::ssize(change.kinds); ++kind) {
    const ControlLaw law = law_of(mission, kind, &change), plans = law_of(mission, kind);
    const bool ceiling_counts = law.perturbation == Perturbation::kAdaptive;
    const bool possible =
        limits::kIntensity.contain(law.noise_intensity) &&
        limits::kIntensity.contain(law.noise_ceiling) && fits(law) &&
        (ceiling_counts || law.noise_ceiling == plans.noise_ceiling) &&
        fit_together(law, mission.disturbance_intensity, mission.domain, mission.timing.dt_s) &&
        fits(motion_of_kind(mission, kind), law.u_max_mps, mission.separation);
    if (!possible) return false;
  }
  return true;
}

double duration_s(const Timing& timing) {
  return std::min(static_cast<double>(timing.tick_count) * timing.dt_s, limits::kDuration_s.high);
}

bool within_limits(const Mission& mission) {
  EachWithinLimits each;
  list_fields(each, mission);
  return each.ok && fits(mission.domain) && fit_together(mission.basis, mission.domain) &&
         is_target(mission.target_coefficients, mission.cosine_target, mission) &&
         fits(mission.basis, mission) && fits(mission.law) &&
         fits(mission.law.kind, mission.domain) && fits(mission.timing) &&
         memory_fits(mission.law, mission.timing.dt_s) &&
         fit_together(mission.law, mission.disturbance_intensity, mission.domain,
                      mission.timing.dt_s) &&
         is_team(mission) && sites_fit(mission) && are_kinds(mission) && bodies_fit(mission) &&
         fits(mission.separation, mission) && walls_fit(mission) && stations_fit(mission) &&
         fits(mission.objects, mission) && fits(mission.sensor, mission);
}

}  // namespace ergocast
