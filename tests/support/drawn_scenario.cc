// SPDX-License-Identifier: BSD-3-Clause
// Every field has a rule that draws its value, and a field without a rule is an error.
#include "tests/support/drawn_scenario.h"

#include <google/protobuf/descriptor.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "lab/random_stream.h"
#include "scenario/parse/fields.h"
#include "tests/support/grey_png.h"
#include "tests/support/netcdf_writer.h"

namespace ergocast::test {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using Block = google::protobuf::Message;
using lab::RandomStream;

/// How one value of a field is drawn; a repeated one gets one more.
using Draw = std::function<void(Block&, const FieldDescriptor&, RandomStream&)>;
struct Rule {
  Draw draw;
  int least, most;  ///< number of values; `least` is 0 for an optional field
};

std::string name_of(const FieldDescriptor& field) {
  return std::string(field.containing_type()->name()) + '.' + std::string(field.name());
}

void draw_fields(Block& block, RandomStream& random);

// ---- values ----

void set(Block& block, const FieldDescriptor& field, double value) {
  const auto& fields = *block.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return fields.SetDouble(&block, &field, value);
    case FieldDescriptor::CPPTYPE_INT32:
      return fields.SetInt32(&block, &field, static_cast<std::int32_t>(std::lround(value)));
    case FieldDescriptor::CPPTYPE_UINT64:
      return fields.SetUInt64(&block, &field, static_cast<std::uint64_t>(value));
    default:
      throw std::logic_error(name_of(field) + " is no number");
  }
}

/// The same density everywhere.
Draw number(double low, double high) {
  return [=](Block& block, const FieldDescriptor& field, RandomStream& random) {
    set(block, field, low + (high - low) * random.uniform());
  };
}
/// Each power of ten as likely.
Draw spread(double low, double high) {
  return [=](Block& block, const FieldDescriptor& field, RandomStream& random) {
    set(block, field, random.log_uniform(low, high));
  };
}
/// A value without effect, or another one.
Draw either(double neutral, Draw other) {
  return [=](Block& block, const FieldDescriptor& field, RandomStream& random) {
    random.uniform() < 0.8 ? set(block, field, neutral) : other(block, field, random);
  };
}
/// The field's first value, or any.
Draw word(double first) {
  return [=](Block& block, const FieldDescriptor& field, RandomStream& random) {
    const auto& type = *field.enum_type();
    const int any =
        static_cast<int>(random.word() % static_cast<std::uint64_t>(type.value_count()));
    block.GetReflection()->SetEnum(&block, &field, type.value(random.uniform() < first ? 0 : any));
  };
}
Draw text(std::vector<std::string> choice) {
  return [=](Block& block, const FieldDescriptor& field, RandomStream& random) {
    block.GetReflection()->SetString(&block, &field, choice[random.word() % choice.size()]);
  };
}
void draw_block(Block& block, const FieldDescriptor& field, RandomStream& random) {
  const auto& fields = *block.GetReflection();
  draw_fields(*(field.is_repeated() ? fields.AddMessage(&block, &field)
                                    : fields.MutableMessage(&block, &field)),
              random);
}

Rule may(Draw draw) { return {std::move(draw), 0, 1}; }
Rule must(Draw draw) { return {std::move(draw), 1, 1}; }
Rule many(int least, int most) { return {draw_block, least, most}; }

const Draw kCoin = [](Block& block, const FieldDescriptor& field, RandomStream& random) {
  block.GetReflection()->SetBool(&block, &field, random.coin());
};
/// Now and then true.
const Draw kRarely = [](Block& block, const FieldDescriptor& field, RandomStream& random) {
  block.GetReflection()->SetBool(&block, &field, random.uniform() < 0.2);
};
const Draw kTrue = [](Block& block, const FieldDescriptor& field, RandomStream&) {
  block.GetReflection()->SetBool(&block, &field, true);
};
/// A place [m] inside every domain.
const Draw kPlace = number(1, 99);

/// The rules of blocks, texts and required fields. Some values also have rules that keep missions
/// valid, short and different. All other fields are drawn by usual_rule().
const std::map<std::string, Rule>& rules() {
  static const std::map<std::string, Rule> rules = {
      {"Scenario.name", may(text({"drawn", "0", "a.b-c_d"}))},
      {"Scenario.description", may(text({"", "Drawn by a test."}))},
      {"Scenario.seed", may(spread(1, 1e19))},
      {"Scenario.domain", must(draw_block)},
      {"Scenario.target", must(draw_block)},
      {"Scenario.basis", may(draw_block)},
      {"Scenario.law", must(draw_block)},
      {"Scenario.time", must(draw_block)},
      {"Scenario.agents", must(draw_block)},
      {"Scenario.world", may(draw_block)},
      {"Scenario.vehicle", may(draw_block)},
      {"Scenario.separation", may(draw_block)},
      {"Scenario.goal_ergodic_metric", may(spread(1e-9, 1))},
      {"Scenario.origin", may(draw_block)},
      {"Origin.latitude_deg", must(number(54, 54))},  // where the GeoJSON files lie
      {"Origin.longitude_deg", must(number(10, 10))},

      {"Domain.origin_x_m", may(number(-20, 0))},
      {"Domain.origin_y_m", may(number(-20, 0))},
      {"Domain.size_x_m", must(number(120, 200))},
      {"Domain.size_y_m", must(number(120, 200))},
      {"Domain.origin_z_m", may(number(-20, 0))},
      {"Domain.size_z_m", may(number(120, 200))},

      {"Target.gaussians", many(0, 3)},
      {"Target.uniform_weight", may(number(0.1, 2))},
      {"Target.maps", many(0, 2)},
      {"Target.regions", many(0, 2)},
      {"Target.keep_outs", many(0, 2)},
      {"Target.voxels", many(0, 1)},
      {"Voxels.file", must(text({"a.nc"}))},
      {"Voxels.variable", must(text({"v"}))},
      {"Voxels.weight", may(spread(0.1, 10))},
      {"Voxels.time_index", must(number(0, 1))},
      {"Voxels.x_axis", may(text({"x"}))},
      {"Voxels.y_axis", may(text({"y"}))},
      {"Voxels.z_axis", may(text({"z", "depth"}))},
      {"Voxels.time_axis", may(text({"time"}))},
      {"Gaussian.weight", may(spread(0.1, 10))},
      {"Gaussian.mean_x_m", must(kPlace)},
      {"Gaussian.mean_y_m", must(kPlace)},
      {"Gaussian.mean_z_m", must(kPlace)},
      {"Gaussian.sigma_m", may(spread(3, 50))},
      {"Gaussian.sigma_z_m", may(spread(3, 50))},
      {"Gaussian.covariance", may(draw_block)},
      {"Covariance.xx_m2", must(spread(10, 1000))},
      {"Covariance.yy_m2", must(spread(10, 1000))},
      {"Covariance.zz_m2", must(spread(10, 1000))},
      {"Covariance.xy_m2", may(number(-9, 9))},
      {"Covariance.xz_m2", may(number(-1, 1))},
      {"Covariance.yz_m2", may(number(-1, 1))},
      {"Map.file", must(text({"a.png", "a.csv", "a.asc"}))},
      {"Map.weight", may(spread(0.1, 10))},
      {"Map.origin_x_m", may(number(-10, 10))},
      {"Map.origin_y_m", may(number(-10, 10))},
      {"Map.size_x_m", may(number(20, 100))},
      {"Map.size_y_m", may(number(20, 100))},
      {"Map.layers", many(0, 2)},
      {"Layer.low_z_m", must(number(0, 30))},
      {"Layer.high_z_m", must(number(40, 50))},  // the second lies above: see agree()
      {"Layer.value", may(spread(0.1, 10))},
      {"Region.weight", may(spread(0.1, 10))},
      {"Region.polygon", must(draw_block)},
      {"Polygon.vertices", many(3, 6)},
      {"Polygon.holes", many(0, 1)},
      {"Polygon.low_z_m", may(number(-30, 40))},
      {"Polygon.high_z_m", may(number(50, 220))},
      {"Polygon.file", may(text({"a.geojson", "b.geojson"}))},
      {"Ring.vertices", many(3, 6)},
      {"Vertex.x_m", must(kPlace)},
      {"Vertex.y_m", must(kPlace)},

      {"Basis.modes_x", may(number(1, 24))},
      {"Basis.modes_y", may(number(2, 24))},
      {"Basis.modes_z", may(number(1, 6))},
      {"Basis.sobolev_exponent", may(number(0.1, 3))},
      {"Basis.free_domain", may(kRarely)},  // in a plane, of few modes: see agree()

      {"Law.u_max_mps", must(spread(1, 40))},
      {"Law.epsilon", may(spread(1e-3, 1))},
      {"Law.noise_intensity", may(spread(0.01, 2))},
      {"Law.noise_ceiling", may(spread(2, 20))},
      {"Law.contraction_gain_per_s", may(spread(1e-5, 1e-2))},
      {"Law.contraction_x_m", may(kPlace)},
      {"Law.contraction_y_m", may(kPlace)},
      {"Law.contraction_z_m", may(kPlace)},
      {"Law.anticipation", may(either(0, spread(0.01, 10)))},

      {"Time.dt_s", may(spread(0.02, 1))},
      {"Time.duration_s", must(number(0.5, 60))},  // in ticks: see agree()
      {"Time.broadcast_period_ticks", may(either(1, number(1, 10)))},
      {"Time.high_mode_period_factor", may(either(1, number(2, 10)))},
      {"Time.contribution_encoding", may(word(0.8))},
      {"Time.pace", may(word(0.8))},
      {"Time.realtime_factor", may(spread(0.1, 10))},
      {"Time.lockstep_timeout_s", may(spread(1e-3, 1e4))},
      {"Time.command_hold_s", may(spread(1e-3, 10))},
      // An admission takes a question and its answer.
      {"Time.admission_timeout_s", may(spread(1, 1e4))},
      {"Time.catch_up_limit_ticks", may(number(0, 20))},

      {"Agents.starts", many(1, 4)},
      {"Agents.random_count", may(spread(0.5, 20))},
      {"Agents.quorum", may(either(100, number(1, 24)))},  // of all at most: see agree()
      {"Agents.forget_silent_after_s", may(either(0, spread(1e-3, 10)))},
      {"Agents.kind", many(0, 3)},
      {"Kind.name", must(text({"a", "fast-1", "_b.C"}))},  // each once: see agree()
      {"Kind.count", must(number(1, 3))},                  // the counts add up to the agents
      {"Kind.u_max_mps", may(spread(2, 40))},
      {"Kind.noise_intensity", may(spread(0.01, 2))},
      {"Kind.noise_ceiling", may(spread(2, 20))},
      {"Kind.footprint_sigma_m", may(spread(0.5, 40))},
      {"Kind.quality", may(spread(0.1, 5))},
      {"Kind.band", may(draw_block)},
      {"Kind.vehicle", may(draw_block)},
      {"Kind.speed_limit_mps", may(spread(5, 20))},
      {"Kind.station", many(0, 1)},  // in time of all: see agree()
      {"Kind.reserve_s", may(number(0.01, 0.3))},
      {"Band.from", may(number(0, 4))},
      {"Band.to", may(number(5, 20))},
      {"Start.x_m", must(kPlace)},
      {"Start.y_m", must(kPlace)},
      {"Start.z_m", must(kPlace)},

      {"Vehicle.kind", may(word(0.3))},
      {"Vehicle.max_acceleration_mps2", must(spread(20, 200))},  // by kind: see agree()
      {"Vehicle.max_turn_radps", must(spread(0.5, 10))},
      {"Vehicle.min_speed_mps", must(spread(0.05, 0.5))},

      {"Separation.distance_m", must(number(0.5, 8))},
      {"Separation.position_error_m", may(either(0, number(0.01, 0.2)))},
      {"Separation.disturbance_m", may(spread(1e-4, 1e-2))},
      {"Separation.response_s", may(either(0, spread(0.01, 1)))},
      {"Separation.lease_s", may(either(0, number(5, 50)))},

      {"Polygon.solid", may(kTrue)},
      {"World.walls", many(0, 2)},
      {"World.wall_clearance_m", may(either(0, number(0.5, 1)))},
      {"World.disturbance_intensity", may(spread(0.01, 5))},
      {"World.radio_range_m", may(either(0, spread(5, 500)))},
      {"World.speed_limit_mps", may(spread(0.5, 100))},
  };
  return rules;
}

/// A switch or an enumeration may have any value. A number has one up to ten times its default, or
/// 10.
Rule usual_rule(const FieldDescriptor& field) {
  if (field.enum_type() != nullptr) return may(word(0));
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL) return may(kCoin);
  const FieldRule* rule = rule_of(field);
  if (rule == nullptr) {
    throw std::logic_error("scenario.proto has " + name_of(field) +
                           ", and tests/support/drawn_scenario.cc does not say how it is drawn");
  }
  const auto& [low, high, low_excluded] = static_cast<const Limits&>(rule->range);
  return may(number(low, std::min(high, 10 * std::max(rule->default_value, 1.0))));
}

void draw_fields(Block& block, RandomStream& random) {
  for (int i = 0; i < block.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *block.GetDescriptor()->field(i);
    const auto rule = rules().find(name_of(field));
    const auto& [draw, least, most] = rule == rules().end() ? usual_rule(field) : rule->second;
    const auto range = static_cast<std::uint64_t>(most - least + 1);
    const int count = least + static_cast<int>(random.word() % range);
    for (int n = 0; n < count; ++n) draw(block, field, random);
  }
}

// ---- what depends on more than one field ----

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
    if (is_along_z(field) || name_of(field) == "Map.layers" || name_of(field) == "Target.voxels") {
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

/// A plane, sensors that see points, and a table that is soon computed.
void agree_on_free_domain(proto::Scenario& scenario) {
  proto::Basis& basis = *scenario.mutable_basis();
  if (scenario.domain().has_size_z_m()) basis.clear_free_domain();
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
    if (kind.station_size() == 0) continue;
    *kind.mutable_station(0) = agents.starts(0);
    time.set_duration_s(std::max(time.duration_s(), 20 * dt_s));
    if (kind.has_reserve_s()) kind.set_reserve_s(20 * dt_s * kind.reserve_s());
  }
}

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
  time.set_duration_s(time.duration_s() * (time.has_dt_s() ? time.dt_s() : 0.1));
  proto::Agents& agents = *scenario.mutable_agents();
  const int team = agents.starts_size() + agents.random_count();
  if (agents.has_quorum()) agents.set_quorum(std::min(agents.quorum(), team));
  agree_on_kinds(team, agents);
  agree_on_free_domain(scenario);
  agree_on_vehicles(scenario);
  if (scenario.has_separation()) agree_on_distance(scenario);
  agree_on_walls(scenario);
  agree_on_stations(scenario);
}

void add_fields(const Descriptor& type, std::set<std::string>& names) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (names.insert(name_of(field)).second && field.message_type() != nullptr) {
      add_fields(*field.message_type(), names);
    }
  }
}

/// Cells of 20 m from (0, 0, 0) on, at two times.
void write_grid(const std::filesystem::path& file) {
  std::vector<NetcdfVariable> variables;
  const auto axis = [&](const std::string& name, int count) {
    NetcdfVariable one{name, {name}, {}, {{"units", "m"}}};
    for (int i = 0; i < count; ++i) one.values.push_back(10 + 20 * i);
    variables.push_back(one);
  };
  axis("x", 4);
  axis("y", 2);
  axis("z", 3);
  NetcdfVariable values{"v", {"time", "z", "y", "x"}, {}, {}};
  for (int i = 0; i < 48; ++i) values.values.push_back(1 + i % 7);
  variables.push_back(values);
  NetcdfWriter(file, {{"time", 2}, {"z", 3}, {"y", 2}, {"x", 4}}, variables);
}

}  // namespace

void write_files(const std::filesystem::path& folder) {
  std::ofstream(folder / "a.csv") << "0,1,2,9\n3,0,1,4\n";
  std::ofstream(folder / "a.asc")
      << "ncols 4\nnrows 2\nxllcorner 5\nyllcorner 5\ncellsize 20\n0 1 2 9\n3 0 1 4\n";
  // A degree is 111 km to the north, and here 65 km to the east.
  const auto triangle = [](const char* ring) {
    return std::string(R"({"type": "Polygon", "coordinates": [[)") + ring + "]]}\n";
  };
  std::ofstream(folder / "a.geojson")
      << triangle("[10.0002, 54.0002], [10.0006, 54.0002], [10.0002, 54.0005], [10.0002, 54.0002]");
  std::ofstream(folder / "b.geojson")
      << triangle("[10.0012, 54.0006], [10.0014, 54.0006], [10.0012, 54.0008], [10.0012, 54.0006]");
  write_grid(folder / "a.nc");
  write_png(folder / "a.png", 4, 2, {.bits = 16},
            [](int column, int row, int) { return 1000 * (1 + column + 4 * row); });
}

proto::Scenario drawn_scenario(std::uint64_t seed) {
  RandomStream random(seed, 0);
  proto::Scenario scenario;
  draw_fields(scenario, random);
  agree(scenario);
  return scenario;
}

std::set<std::string> fields_of(const Block& message) {
  std::set<std::string> names;
  std::vector<const FieldDescriptor*> fields;
  const auto& values = *message.GetReflection();
  values.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    names.insert(name_of(*field));
    if (field->message_type() == nullptr) continue;
    const int count = field->is_repeated() ? values.FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      names.merge(fields_of(field->is_repeated() ? values.GetRepeatedMessage(message, field, i)
                                                 : values.GetMessage(message, field)));
    }
  }
  return names;
}

std::set<std::string> all_fields() {
  std::set<std::string> names;
  add_fields(*proto::Scenario::descriptor(), names);
  return names;
}

}  // namespace ergocast::test
