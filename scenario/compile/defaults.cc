// SPDX-License-Identifier: BSD-3-Clause
// Applies the options to the text, fills absent fields, first those that depend on other fields,
// and draws the random starts.
#include "scenario/compile/defaults.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "core/measure/detection.h"
#include "core/measure/drift.h"
#include "core/motion/starts.h"
#include "scenario/parse/assign.h"
#include "scenario/parse/convert.h"
#include "scenario/parse/fields.h"
#include "scenario/parse/names.h"

namespace ergocast {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

void set_number(Message& message, const FieldDescriptor& field, double value) {
  const auto* reflection = message.GetReflection();
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
    reflection->SetDouble(&message, &field, value);
  } else {
    reflection->SetInt32(&message, &field, static_cast<std::int32_t>(value));
  }
}

void fill_scalar(Message& message, const FieldDescriptor& field) {
  const auto* reflection = message.GetReflection();
  if (reflection->HasField(message, &field)) return;
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
    reflection->SetEnumValue(&message, &field, 0);
  } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL) {
    // A polygon has this flag only if it is solid.
    if (field.containing_type() != proto::Polygon::descriptor())
      reflection->SetBool(&message, &field, false);
  } else if (const FieldRule* rule = rule_of(field); rule && rule->absence == Absence::kDefaulted) {
    set_number(message, field, rule->default_value);
  }
}

/// Whether the absence of a field has a meaning. Without a covariance a Gaussian is round. Without
/// an origin places are in metres only. Without a vehicle all bodies are points, or a kind has the
/// scenario's vehicle. Without a separation bodies keep no distance. Without a sensor measures
/// assume the usual one. Without a band all modes count. Without objects there is nothing to find.
/// Without motion they stand still. Without a battery no charge counts.
bool means_something_absent(const FieldDescriptor& field) {
  return field.message_type() == proto::Covariance::descriptor() ||
         field.message_type() == proto::Origin::descriptor() ||
         field.message_type() == proto::Vehicle::descriptor() ||
         field.message_type() == proto::Separation::descriptor() ||
         field.message_type() == proto::Sensor::descriptor() ||
         field.message_type() == proto::Objects::descriptor() ||
         field.message_type() == proto::Motion::descriptor() ||
         field.message_type() == proto::Battery::descriptor() ||
         field.message_type() == proto::Band::descriptor();
}

/// Constant defaults of `message` and of every block below it; in a plane none along z.
void fill_constants(Message& message, bool planar) {
  const auto* reflection = message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    if (field.message_type() == nullptr) {
      if (!planar || !is_along_z(field)) fill_scalar(message, field);
    } else if (field.is_repeated()) {
      for (int j = 0; j < reflection->FieldSize(message, &field); ++j) {
        fill_constants(*reflection->MutableRepeatedMessage(&message, &field, j), planar);
      }
    } else if (reflection->HasField(message, &field) || !means_something_absent(field)) {
      fill_constants(*reflection->MutableMessage(&message, &field), planar);
    }
  }
}

constexpr int kModesInPlane = 16, kModesInBox = 10;

/// The Sobolev weight in as many dimensions as the domain has.
void fill_basis(bool planar, proto::Basis& basis) {
  const int modes = planar ? kModesInPlane : kModesInBox;
  if (!basis.has_modes_x()) basis.set_modes_x(modes);
  if (!basis.has_modes_y()) basis.set_modes_y(modes);
  if (!basis.has_modes_z() && !planar) basis.set_modes_z(modes);
  if (!basis.has_sobolev_exponent()) basis.set_sobolev_exponent(planar ? 1.5 : 2);
}

void fill_heights(const Box& domain, proto::Polygon& polygon) {
  const Heights all = heights_of(domain);
  if (!polygon.has_low_z_m()) polygon.set_low_z_m(all.low_m);
  if (!polygon.has_high_z_m()) polygon.set_high_z_m(all.high_m);
}

/// Fills the heights of a target in a box: parts are as high as the domain, or as wide along z as
/// along x and y.
void fill_heights(const Box& domain, proto::Target& target) {
  for (proto::Gaussian& gaussian : *target.mutable_gaussians()) {
    if (gaussian.has_sigma_m() && !gaussian.has_sigma_z_m())
      gaussian.set_sigma_z_m(gaussian.sigma_m());
  }
  for (proto::Region& region : *target.mutable_regions())
    fill_heights(domain, *region.mutable_polygon());
  for (proto::Polygon& keep_out : *target.mutable_keep_outs()) fill_heights(domain, keep_out);
  for (proto::Map& map : *target.mutable_maps()) {
    if (map.layers_size() > 0) continue;
    proto::Layer& layer = *map.add_layers();
    layer.set_low_z_m(heights_of(domain).low_m);
    layer.set_high_z_m(heights_of(domain).high_m);
  }
}

/// The distance of a push, as a share of the shorter side.
constexpr double kPushShare = 0.01;
/// The maximum share of u_max that the contraction takes.
constexpr double kContractionShare = 0.01;
constexpr double kFloorOfCeiling = 0.05;
constexpr double kMostIntensity = 1e6;
/// A normal vector in the plane is longer than this many deviations once in 65 million steps.
constexpr double kDisturbanceDeviations = 6;

constexpr double kAnticipation = 2;
constexpr double kEpsilon = 0.05;
constexpr double kEpsilonWithoutAnticipation = 0.2;
/// Steps between two broadcasts where teammates extrapolate in between: docs/network.md.
constexpr int kReckonedPeriodTicks = 10;

/// How far ahead agents look, and how often they broadcast, if the law is ours and not the paper's.
void fill_foresight(proto::Scenario& scenario) {
  proto::Law& law = *scenario.mutable_law();
  const bool is_ours =
      law.regularization() == proto::Law::RELATIVE && law.perturbation() == proto::Law::ADAPTIVE;
  if (!law.has_anticipation()) law.set_anticipation(is_ours ? kAnticipation : 0);
  const bool looks_ahead = is_ours && law.anticipation() > 0;
  if (!law.has_ends_with_plan()) law.set_ends_with_plan(looks_ahead);
  if (!law.has_paired_pushes()) law.set_paired_pushes(looks_ahead);
  if (!scenario.agents().has_dead_reckoning()) scenario.mutable_agents()->set_dead_reckoning(true);
  if (scenario.time().has_broadcast_period_ticks()) return;
  const bool dead_reckons = law.anticipation() > 0 && scenario.agents().dead_reckoning();
  scenario.mutable_time()->set_broadcast_period_ticks(dead_reckons ? kReckonedPeriodTicks : 1);
}

/// Objects that have drifted so many sensor radii are somewhere else.
constexpr double kRadiiDrifted = 2;

/// Whether a number of a block is given and within its limits.
bool has_valid(const Message& block, const char* name) {
  const auto& field = find_field(block, name).field;
  return block.GetReflection()->HasField(block, &field) &&
         rule_of(field)->range.contains(number_in(block, field));
}

/// What a team that searches has seen of drifting objects is old after a time. Numbers outside
/// their limits give no default: validate() reports them.
/// @pre the constants are filled in
void fill_memory(const Box& domain, proto::Scenario& scenario) {
  proto::Law& law = *scenario.mutable_law();
  if (law.has_memory_half_life_s()) return;
  law.set_memory_half_life_s(0);
  const proto::Motion& motion = scenario.world().objects().motion();
  const bool persists = !motion.has_persistence_s() || has_valid(motion, "persistence_s");
  const bool known = has_valid(motion, "speed_mps") && persists && has_valid(law, "u_max_mps") &&
                     has_valid(scenario.time(), "dt_s") &&
                     limits::kSize_m.contain(domain.size_m.x()) &&
                     limits::kSize_m.contain(domain.size_m.y());
  if (law.kind() != proto::Law::SEARCH || !domain.planar() || !known) return;
  Mission mission;
  mission.domain = domain;
  if (has_valid(scenario.sensor(), "radius_m"))
    mission.sensor.radius_m = scenario.sensor().radius_m();
  ObjectMotion drift{.speed_mps = motion.speed_mps()};
  if (motion.has_persistence_s()) drift.persistence_s = motion.persistence_s();
  const double drifted_s = time_to_drift_s(drift, kRadiiDrifted * sensor_radius_m(mission));
  const double crossing_s = domain.size_m.maxCoeff() / law.u_max_mps();
  const double least_s = limits::kLeastHalfLife_ticks * scenario.time().dt_s();
  law.set_memory_half_life_s(std::min(std::ceil(std::max({drifted_s, crossing_s, least_s})), 1e9));
}

/// The law has the speed of the fastest kind if each has its own. Where one of them is outside its
/// limits, validate() reports that one alone.
void fill_speed(const proto::Agents& agents, proto::Law& law) {
  if (law.has_u_max_mps() || agents.kind_size() == 0) return;
  double fastest_mps = 0;
  for (const proto::Kind& kind : agents.kind()) {
    if (!kind.has_u_max_mps()) return;
    fastest_mps = std::max(fastest_mps, kind.u_max_mps());
  }
  constexpr Limits kSpeed_mps = limits::above(0, 1e6);
  law.set_u_max_mps(kSpeed_mps.contain(fastest_mps) ? fastest_mps : 1);
}

/// Defaults that follow from speed and domain, so that a law scales with them. A value outside its
/// limits gives no default: validate() reports it.
void fill_law(const Box& domain, proto::Law& law) {
  if (!law.has_epsilon()) {
    const double relative = law.anticipation() > 0 ? kEpsilon : kEpsilonWithoutAnticipation;
    law.set_epsilon(law.regularization() == proto::Law::RELATIVE ? relative : 0);
  }
  const double side_m = domain.shortest_side_m();
  if (!(law.u_max_mps() > 0) || !(side_m > 0) || !domain.size_m.allFinite()) return;
  // The diffusion that crosses this length in the same time as the input.
  const double ceiling = std::sqrt(law.u_max_mps() * kPushShare * side_m);
  if (!law.has_noise_intensity()) law.set_noise_intensity(kFloorOfCeiling * ceiling);
  if (!law.has_noise_ceiling() && law.perturbation() == proto::Law::ADAPTIVE) {
    law.set_noise_ceiling(std::clamp(law.noise_intensity(), ceiling, kMostIntensity));
  }
  if (law.has_contraction_gain_per_s()) return;
  const double reach_m = domain.farthest_distance_m(contraction_center_of(law, domain));
  law.set_contraction_gain_per_s(kContractionShare * law.u_max_mps() / reach_m);
}

/// A kind's noise diffuses over the same length as the law's, in the time that the kind needs for
/// it.
void fill_kinds(const proto::Law& law, proto::Agents& agents) {
  for (proto::Kind& kind : *agents.mutable_kind()) {
    if (!kind.has_u_max_mps() && law.has_u_max_mps()) kind.set_u_max_mps(law.u_max_mps());
    if (!(kind.u_max_mps() > 0) || !(law.u_max_mps() > 0)) continue;
    const double scale = std::sqrt(kind.u_max_mps() / law.u_max_mps());
    if (!kind.has_noise_intensity()) kind.set_noise_intensity(scale * law.noise_intensity());
    if (!kind.has_noise_ceiling()) kind.set_noise_ceiling(scale * law.noise_ceiling());
  }
}

/// What kinds leave open of their sensors. A team without kinds becomes one. A value outside its
/// limits is no default: validate() reports it.
void fill_sensors(proto::Agents& agents) {
  const auto valid = [&](const char* field, bool given, double value) {
    return given && rule_of(find_field(agents, field).field)->range.contains(value);
  };
  const bool sigma =
      valid("footprint_sigma_m", agents.has_footprint_sigma_m(), agents.footprint_sigma_m());
  const bool quality = valid("quality", agents.has_quality(), agents.quality());
  const std::int64_t size = std::int64_t{agents.starts_size()} + agents.random_count();
  if ((sigma || quality) && agents.kind_size() == 0 && size > 0 && size <= kMostAgentsOfSites) {
    proto::Kind& all = *agents.add_kind();
    all.set_name("all");
    all.set_count(static_cast<int>(size));
  }
  for (proto::Kind& kind : *agents.mutable_kind()) {
    if (sigma && !kind.has_footprint_sigma_m())
      kind.set_footprint_sigma_m(agents.footprint_sigma_m());
    if (quality && !kind.has_quality()) kind.set_quality(agents.quality());
  }
}

/// The starts that the kinds leave open are drawn.
void fill_team(proto::Agents& agents) {
  if (agents.kind_size() == 0 || agents.has_random_count()) return;
  std::int64_t count = 0;
  for (const proto::Kind& kind : agents.kind()) count += std::max(0, kind.count());
  agents.set_random_count(static_cast<int>(
      std::clamp<std::int64_t>(count - agents.starts_size(), 0, std::int64_t{kMostAgentsOfSites})));
}

/// @pre the constants are filled in
void fill_separation(proto::Scenario& scenario) {
  if (!scenario.has_separation() || scenario.separation().has_disturbance_m()) return;
  scenario.mutable_separation()->set_disturbance_m(
      kDisturbanceDeviations * scenario.world().disturbance_intensity() *
      std::sqrt(std::max(0.0, scenario.time().dt_s())));
}

/// The name of a file is relative to the scenario's folder, not to the working directory.
void make_absolute(const std::filesystem::path& file, proto::Scenario& scenario) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::absolute(file, error).parent_path();
  for (std::string* name : file_names(scenario)) {
    if (!name->empty()) *name = (folder / *name).lexically_normal().string();
  }
}

void resize_team(int size, proto::Agents& agents) {
  if (agents.starts_size() > size) {
    agents.mutable_starts()->DeleteSubrange(size, agents.starts_size() - size);
  }
  agents.set_random_count(size - agents.starts_size());
  if (agents.has_quorum()) agents.set_quorum(std::min(agents.quorum(), size));
}

void put_flags_over(const Overrides& overrides, proto::Scenario& scenario, Findings& findings) {
  if (overrides.seed) {
    scenario.set_seed(*overrides.seed);
    findings.blame("seed", "--seed");
  }
  if (overrides.duration_s) {
    scenario.mutable_time()->set_duration_s(*overrides.duration_s);
    findings.blame("time.duration_s", "--duration");
  }
  if (overrides.pace) {
    scenario.mutable_time()->set_pace(*overrides.pace == Pace::kLockstep ? proto::Time::LOCKSTEP
                                                                         : proto::Time::REALTIME);
    findings.blame("time.pace", *overrides.pace == Pace::kLockstep ? "--lockstep" : "--realtime");
  }
  if (overrides.realtime_factor) {
    scenario.mutable_time()->set_realtime_factor(*overrides.realtime_factor);
    findings.blame("time.realtime_factor", "--realtime");
  }
  if (!overrides.agents) return;
  findings.blame("agents.random_count", "--agents");
  const int most = most_agents(scenario);
  const std::string limits = "1 to " + std::to_string(most);
  if (*overrides.agents >= 1 && *overrides.agents <= most) {
    resize_team(*overrides.agents, *scenario.mutable_agents());
  } else {
    findings.add_to_flag("--agents",
                         std::to_string(*overrides.agents) + " is outside the limits " + limits,
                         "write a number " + limits);
  }
}

/// A place that a person writes on the upper edge may be beyond origin + size by rounding. For
/// instance 0.8 is, for a domain from 0.7 with a length of 0.1. Such a place becomes the edge.
double on_edge(double place_m, double origin_m, double size_m) {
  const double high_m = origin_m + size_m;
  const double rounding_m =
      4 * std::numeric_limits<double>::epsilon() * (std::abs(origin_m) + size_m);
  return place_m > high_m && place_m <= high_m + rounding_m ? high_m : place_m;
}

void put_on_edge(const Box& domain, proto::Start& place) {
  const Eigen::Vector3d &low_m = domain.origin_m, &size_m = domain.size_m;
  if (place.has_x_m()) place.set_x_m(on_edge(place.x_m(), low_m.x(), size_m.x()));
  if (place.has_y_m()) place.set_y_m(on_edge(place.y_m(), low_m.y(), size_m.y()));
  if (place.has_z_m()) place.set_z_m(on_edge(place.z_m(), low_m.z(), size_m.z()));
}

void put_on_edges(const Box& domain, proto::Agents& agents) {
  for (proto::Start& start : *agents.mutable_starts()) put_on_edge(domain, start);
  for (proto::Kind& kind : *agents.mutable_kind()) {
    for (proto::Start& station : *kind.mutable_station()) put_on_edge(domain, station);
  }
}

}  // namespace

std::vector<std::string*> file_names(proto::Scenario& scenario) {
  std::vector<std::string*> names;
  const auto add = [&names](auto& named) {
    if (named.has_file()) names.push_back(named.mutable_file());
  };
  if (scenario.has_target()) {
    proto::Target& target = *scenario.mutable_target();
    for (proto::Map& map : *target.mutable_maps()) add(map);
    for (proto::Voxels& voxels : *target.mutable_voxels()) add(voxels);
    for (proto::Region& region : *target.mutable_regions()) {
      if (region.has_polygon()) add(*region.mutable_polygon());
    }
    for (proto::Polygon& keep_out : *target.mutable_keep_outs()) add(keep_out);
  }
  if (scenario.has_world()) {
    for (proto::Polygon& wall : *scenario.mutable_world()->mutable_walls()) add(wall);
  }
  return names;
}

void put_over(const Overrides& overrides, proto::Scenario& scenario, Findings& findings) {
  put_flags_over(overrides, scenario, findings);
  for (const FieldValue& field : overrides.fields) assign(field, scenario, findings);
}

void fill_in(proto::Scenario& scenario, const std::string& file) {
  if (!scenario.has_name()) {
    scenario.set_name(name_from(std::filesystem::path(file).stem().string()));
  }
  if (!scenario.has_description()) scenario.set_description("");
  if (!scenario.has_seed()) scenario.set_seed(kDefaultSeed);
  fill_foresight(scenario);
  const bool planar = !scenario.domain().has_size_z_m();
  fill_basis(planar, *scenario.mutable_basis());
  const Box domain = domain_of(scenario.domain());
  // A domain outside its limits gives no default: validate() reports it.
  if (limits::kSize_m.contain(domain.size_m.z()) &&
      limits::kCoordinate_m.contain(domain.origin_m.z()))
    fill_heights(domain, *scenario.mutable_target());
  if (!planar && !scenario.domain().has_origin_z_m()) scenario.mutable_domain()->set_origin_z_m(0);
  if (scenario.has_separation() && !scenario.separation().has_guard())
    scenario.mutable_separation()->set_guard(scenario.separation().lease_s() == 0);
  fill_team(*scenario.mutable_agents());
  fill_sensors(*scenario.mutable_agents());
  fill_speed(scenario.agents(), *scenario.mutable_law());
  fill_constants(scenario, planar);
  fill_separation(scenario);
  make_absolute(file, scenario);
  if (has_walls(scenario) && !scenario.world().has_wall_clearance_m())
    scenario.mutable_world()->set_wall_clearance_m(0);
  fill_law(domain, *scenario.mutable_law());
  fill_memory(domain, scenario);
  proto::Agents& agents = *scenario.mutable_agents();
  put_on_edges(domain, agents);
  fill_kinds(scenario.law(), agents);
  if (!agents.has_quorum()) {
    const std::int64_t size = std::int64_t{agents.starts_size()} + agents.random_count();
    // A team outside its limits is reported for its size, not also for its quorum.
    agents.set_quorum(static_cast<int>(std::clamp<std::int64_t>(size, 1, kMostAgentsOfSites)));
  }
}

void draw_starts(proto::Scenario& scenario) {
  proto::Agents& agents = *scenario.mutable_agents();
  const Mission mission = mission_of(scenario);  // starts_m: the listed starts
  std::vector<Placed> bodies;
  for (const Eigen::Vector3d& x_m : mission.starts_m)
    bodies.push_back({static_cast<AgentId>(bodies.size()), x_m});
  for (; agents.random_count() > 0; agents.set_random_count(agents.random_count() - 1)) {
    const AgentId id = agents.starts_size();
    const Eigen::Vector3d x_m = start_beside(mission, id, bodies, start_distance_m);
    bodies.push_back({id, x_m});
    proto::Start& start = *agents.add_starts();
    start.set_x_m(x_m.x());
    start.set_y_m(x_m.y());
    if (!mission.domain.planar()) start.set_z_m(x_m.z());
  }
}

}  // namespace ergocast
