// SPDX-License-Identifier: BSD-3-Clause
// Removes what contradicts another field, and adds what another field needs.
#include "tests/support/drawn_agreement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenario/parse/fields.h"
#include "tests/support/drawn_scenario.h"

namespace ergocast::test {
namespace {

using google::protobuf::FieldDescriptor;
using Block = google::protobuf::Message;

/// Makes a ring around its first vertex.
template <class Vertices>
void make_round(Vertices& vertices, double radius_m, const proto::Vertex& center) {
  for (int i = 0; i < vertices.size(); ++i) {
    const double angle = 2 * std::numbers::pi * i / vertices.size();
    vertices[i].set_x_m(center.x_m() + radius_m * std::cos(angle));
    vertices[i].set_y_m(center.y_m() + radius_m * std::sin(angle));
  }
}
void make_round(proto::Polygon& polygon, double radius_m) {
  if (polygon.has_file()) {  // in place of the vertices
    polygon.clear_vertices();
    polygon.clear_holes();
    return;
  }
  const proto::Vertex center = polygon.vertices(0);
  make_round(*polygon.mutable_vertices(), radius_m, center);
  for (auto& hole : *polygon.mutable_holes()) {
    make_round(*hole.mutable_vertices(), 0.3 * radius_m, center);
  }
}

/// A plane has no heights.
void clear_heights(Block& block) {
  const auto& fields = *block.GetReflection();
  for (int i = 0; i < block.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *block.GetDescriptor()->field(i);
    if (is_along_z(field) || field.full_name() == "ergocast.proto.Map.layers" ||
        field.full_name() == "ergocast.proto.Target.voxels") {
      fields.ClearField(&block, &field);
    } else if (field.message_type() != nullptr && field.is_repeated()) {
      for (int j = 0; j < fields.FieldSize(block, &field); ++j)
        clear_heights(*fields.MutableRepeatedMessage(&block, &field, j));
    } else if (field.message_type() != nullptr && fields.HasField(block, &field)) {
      clear_heights(*fields.MutableMessage(&block, &field));
    }
  }
}

void agree(proto::Target& target) {
  for (auto& gaussian : *target.mutable_gaussians()) {
    if (gaussian.has_sigma_m()) gaussian.clear_covariance();
    if (!gaussian.has_covariance() && !gaussian.has_sigma_m()) gaussian.set_sigma_m(20);
    if (!gaussian.has_sigma_m()) gaussian.clear_sigma_z_m();
  }
  for (auto& map : *target.mutable_maps()) {
    for (int i = 0; i < map.layers_size(); ++i) {
      auto& layer = *map.mutable_layers(i);
      layer.set_low_z_m(layer.low_z_m() + 50 * i);
      layer.set_high_z_m(layer.high_z_m() + 50 * i);
    }
    const bool says_where = map.file().ends_with(".asc");
    if (says_where || !map.has_origin_x_m()) map.clear_origin_x_m();
    if (says_where) {
      map.clear_origin_y_m();
      map.clear_size_x_m();
      map.clear_size_y_m();
      map.clear_first_row();
      continue;
    }
    if (!map.has_origin_x_m()) map.set_origin_x_m(0);
    if (!map.has_origin_y_m()) map.set_origin_y_m(0);
    if (!map.has_size_x_m()) map.set_size_x_m(80);
    if (!map.has_size_y_m()) map.set_size_y_m(80);
  }
  for (auto& region : *target.mutable_regions()) make_round(*region.mutable_polygon(), 20);
  for (auto& keep_out : *target.mutable_keep_outs()) make_round(keep_out, 10);
}

/// A distance needs a speed limit, starts that are apart, and little uncertainty.
void agree_on_distance(proto::Scenario& scenario) {
  proto::World& world = *scenario.mutable_world();
  if (!world.has_speed_limit_mps()) world.set_speed_limit_mps(20);
  if (!scenario.separation().has_disturbance_m()) world.clear_disturbance_intensity();
  const double step_m =
      world.speed_limit_mps() * (scenario.time().has_dt_s() ? scenario.time().dt_s() : 0.1);
  if (scenario.separation().disturbance_m() >= step_m / 4)
    scenario.mutable_separation()->clear_disturbance_m();
  if (!scenario.separation().guard()) scenario.mutable_time()->clear_pace();
  if (scenario.separation().lease_s() > 0) {
    scenario.mutable_separation()->clear_guard();
    scenario.mutable_separation()->clear_disturbance_m();
    world.clear_disturbance_intensity();
    scenario.mutable_time()->clear_pace();
    world.clear_radio_range_m();
  }
  proto::Agents& agents = *scenario.mutable_agents();
  for (int i = 0; i < agents.starts_size(); ++i) agents.mutable_starts(i)->set_x_m(5 + 20 * i);
}

bool all_are_points(const proto::Scenario& scenario) {
  const auto& kinds = scenario.agents().kind();
  return scenario.vehicle().kind() == proto::Vehicle::POINT &&
         std::all_of(kinds.begin(), kinds.end(), [](const proto::Kind& kind) {
           return kind.vehicle().kind() == proto::Vehicle::POINT;
         });
}

/// Walls stand apart from each other and from the starts, and belong to a plane.
void agree_on_walls(proto::Scenario& scenario) {
  proto::World& world = *scenario.mutable_world();
  const bool planar = !scenario.domain().has_size_z_m();
  int walls = 0;
  const auto put = [&](proto::Polygon& wall) {
    wall.mutable_vertices(0)->set_x_m(95);
    wall.mutable_vertices(0)->set_y_m(95 - 18 * walls++);
    make_round(wall, 8);
    wall.clear_holes();  // a room without a door
  };
  for (proto::Region& region : *scenario.mutable_target()->mutable_regions())
    region.mutable_polygon()->clear_solid();
  if (!planar) world.clear_walls();
  for (proto::Polygon& wall : *world.mutable_walls()) {
    wall.clear_solid();
    wall.clear_file();
    put(wall);
  }
  for (proto::Polygon& keep_out : *scenario.mutable_target()->mutable_keep_outs()) {
    if (!planar || keep_out.has_file()) keep_out.clear_solid();
    if (keep_out.solid()) put(keep_out);
  }
  if (walls == 0) return world.clear_wall_clearance_m();
  if (!world.has_speed_limit_mps()) world.set_speed_limit_mps(20);
  if (!all_are_points(scenario)) world.clear_disturbance_intensity();
  for (proto::Start& start : *scenario.mutable_agents()->mutable_starts())
    start.set_y_m(std::min(start.y_m(), 30.0));
  if (scenario.has_separation()) world.set_wall_clearance_m(1);
}

/// Gives kinds different names, and counts that add up to the team: the last kind has the rest.
void agree_on_kinds(int team, proto::Agents& agents) {
  for (int i = 0; i < agents.kind_size(); ++i) {
    proto::Kind& kind = *agents.mutable_kind(i);
    kind.set_name(kind.name() + std::to_string(i));
    const bool last = i + 1 == agents.kind_size() || team <= kind.count();
    if (last) agents.mutable_kind()->DeleteSubrange(i + 1, agents.kind_size() - i - 1);
    kind.set_count(last ? team : kind.count());
    team -= kind.count();
  }
}

/// Each kind has limits of its own, and belongs to a plane if it turns.
void agree(bool planar, proto::Vehicle& vehicle) {
  const bool turns =
      vehicle.kind() == proto::Vehicle::UNICYCLE || vehicle.kind() == proto::Vehicle::FIXED_WING;
  if (turns && !planar) vehicle.set_kind(proto::Vehicle::ACCELERATION);
  if (vehicle.kind() != proto::Vehicle::ACCELERATION) vehicle.clear_max_acceleration_mps2();
  if (vehicle.kind() != proto::Vehicle::FIXED_WING) vehicle.clear_min_speed_mps();
  if (!turns || vehicle.kind() == proto::Vehicle::ACCELERATION) vehicle.clear_max_turn_radps();
}

/// All but points need a speed limit and bodies that know each other.
void agree_on_vehicles(proto::Scenario& scenario) {
  const bool planar = !scenario.domain().has_size_z_m();
  bool points = true;
  const auto take = [&](proto::Vehicle& vehicle) {
    agree(planar, vehicle);
    points = points && vehicle.kind() == proto::Vehicle::POINT;
  };
  if (scenario.has_vehicle()) take(*scenario.mutable_vehicle());
  for (proto::Kind& kind : *scenario.mutable_agents()->mutable_kind()) {
    if (kind.has_vehicle()) take(*kind.mutable_vehicle());
  }
  if (points) return;
  scenario.mutable_world()->set_speed_limit_mps(20);
  if (!scenario.has_separation()) return;
  const double distance_m = scenario.separation().distance_m();
  scenario.mutable_separation()->Clear();
  scenario.mutable_separation()->set_distance_m(distance_m);
  scenario.mutable_world()->clear_disturbance_intensity();
}

/// Objects are counted or placed, in a plane and beside the walls. A team with stations does not
/// end when they are found.
void agree_on_objects(proto::Scenario& scenario) {
  proto::World& world = *scenario.mutable_world();
  if (!world.has_objects()) return;
  proto::Objects& objects = *world.mutable_objects();
  if (scenario.domain().has_size_z_m()) return world.clear_objects();
  for (proto::Start& place : *objects.mutable_places()) place.set_x_m(std::min(place.x_m(), 80.0));
  if (objects.places_size() > 0) objects.clear_count();
  if (objects.places_size() == 0 && !objects.has_count()) objects.set_count(1);
  const auto& kinds = scenario.agents().kind();
  if (std::ranges::any_of(kinds, [](const auto& kind) { return kind.station_size() > 0; }))
    objects.clear_end_when_found();
  if (scenario.sensor().false_alarms_per_s() > 0) objects.clear_end_when_found();
  if (objects.has_end_when_found())
    objects.set_end_when_found(
        std::min(objects.end_when_found(), std::max(objects.places_size(), objects.count())));
}

/// A plane, sensors that see points, and a table that is soon computed.
void agree_on_free_domain(proto::Scenario& scenario) {
  proto::Basis& basis = *scenario.mutable_basis();
  if (scenario.domain().has_size_z_m()) basis.clear_free_domain();
  if (scenario.domain().has_size_z_m()) scenario.mutable_law()->clear_kind();
  if (!basis.free_domain()) return;
  basis.set_modes_x(std::min(basis.has_modes_x() ? basis.modes_x() : 6, 6));
  basis.set_modes_y(std::min(basis.has_modes_y() ? basis.modes_y() : 6, 6));
  for (proto::Kind& kind : *scenario.mutable_agents()->mutable_kind()) {
    kind.clear_footprint_sigma_m();
    kind.clear_band();
  }
}

/// In the few ticks of a drawn mission only a point that begins at home, without delays, gets home.
void agree_on_stations(proto::Scenario& scenario) {
  proto::Agents& agents = *scenario.mutable_agents();
  proto::Time& time = *scenario.mutable_time();
  const double dt_s = time.has_dt_s() ? time.dt_s() : 0.1;
  const bool undelayed = time.pace() == proto::Time::LOCKSTEP && !scenario.has_separation() &&
                         scenario.world().walls_size() == 0 && all_are_points(scenario);
  for (int i = 0; i < agents.kind_size(); ++i) {
    proto::Kind& kind = *agents.mutable_kind(i);
    if (i > 0 || kind.count() > 1 || !undelayed) kind.clear_station();
    if (kind.station_size() == 0) kind.clear_reserve_s();
    if (kind.station_size() == 0) kind.clear_battery();
    if (kind.station_size() == 0) continue;
    *kind.mutable_station(0) = agents.starts(0);
    time.set_duration_s(std::max(time.duration_s(), 20 * dt_s));
    if (kind.has_reserve_s()) kind.set_reserve_s(20 * dt_s * kind.reserve_s());
  }
}

/// One in four teams that drew sites has them, without what they exclude.
void agree_on_sites(proto::Scenario& scenario) {
  const proto::Team& team = scenario.team();
  if (!team.has_sites() || team.sites() % 4 != 0) return scenario.clear_team();
  const int size = scenario.agents().starts_size() + scenario.agents().random_count();
  scenario.mutable_team()->set_sites(std::min(team.sites(), size));
  proto::Law& law = *scenario.mutable_law();
  law.clear_kind();
  law.clear_memory_half_life_s();
  law.clear_anticipation();
  scenario.mutable_agents()->clear_dead_reckoning();
  scenario.mutable_time()->clear_contribution_encoding();
  scenario.mutable_time()->clear_pace();
  scenario.clear_separation();
  for (proto::Kind& kind : *scenario.mutable_agents()->mutable_kind()) kind.clear_station();
  for (proto::Polygon& keep_out : *scenario.mutable_target()->mutable_keep_outs())
    keep_out.clear_solid();
  if (!scenario.has_world()) return;
  proto::World& world = *scenario.mutable_world();
  world.clear_radio_range_m();
  world.clear_walls();
  if (world.has_objects()) world.mutable_objects()->clear_end_when_found();
}

}  // namespace

void agree(proto::Scenario& scenario) {
  agree(*scenario.mutable_target());
  const bool planar = !scenario.domain().has_size_z_m();
  if (planar) clear_heights(scenario);
  if (fields_of(scenario).contains("Polygon.file") && !scenario.has_origin()) {
    scenario.mutable_origin()->set_latitude_deg(54);
    scenario.mutable_origin()->set_longitude_deg(10);
  }
  proto::Law& law = *scenario.mutable_law();
  if (law.contraction_center() == proto::Law::POINT) {
    if (!law.has_contraction_x_m()) law.set_contraction_x_m(50);
    if (!law.has_contraction_y_m()) law.set_contraction_y_m(50);
    if (!planar && !law.has_contraction_z_m()) law.set_contraction_z_m(50);
  } else {
    law.clear_contraction_x_m();
    law.clear_contraction_y_m();
    law.clear_contraction_z_m();
  }
  if (auto& basis = *scenario.mutable_basis(); !planar) {  // as fast as a plane
    basis.set_modes_x(std::min(basis.has_modes_x() ? basis.modes_x() : 8, 8));
    basis.set_modes_y(std::min(basis.has_modes_y() ? basis.modes_y() : 8, 8));
    if (!basis.has_modes_z()) basis.set_modes_z(4);
  }
  proto::Time& time = *scenario.mutable_time();
  const double dt_s = time.has_dt_s() ? time.dt_s() : 0.1;
  time.set_duration_s(time.duration_s() * dt_s);
  if (law.has_memory_half_life_s()) law.set_memory_half_life_s(law.memory_half_life_s() * dt_s);
  proto::Agents& agents = *scenario.mutable_agents();
  const int team = agents.starts_size() + agents.random_count();
  if (agents.has_quorum()) agents.set_quorum(std::min(agents.quorum(), team));
  if (scenario.has_team()) agree_on_sites(scenario);
  agree_on_kinds(team, agents);
  agree_on_free_domain(scenario);
  agree_on_vehicles(scenario);
  if (scenario.has_separation()) agree_on_distance(scenario);
  agree_on_walls(scenario);
  if (scenario.has_sensor() && scenario.domain().has_size_z_m())
    scenario.mutable_sensor()->clear_false_alarms_per_s();
  agree_on_objects(scenario);
  agree_on_stations(scenario);
}

}  // namespace ergocast::test
