// SPDX-License-Identifier: BSD-3-Clause
// Every field has a rule that draws its value, and a field without a rule is an error.
#include "tests/support/drawn_scenario.h"

#include <google/protobuf/descriptor.h>

#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>
#include <vector>

#include "lab/random_stream.h"
#include "scenario/parse/fields.h"
#include "tests/support/drawn_agreement.h"

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
      {"Scenario.sensor", may(draw_block)},
      {"Scenario.team", may(draw_block)},
      {"Team.sites", may(number(1, 20))},  // most teams stay whole: see drawn_agreement.h
      {"Team.site_row_period_ticks", may(number(1, 5))},
      {"Sensor.radius_m", may(spread(1, 50))},
      {"Sensor.detections_per_s", may(spread(0.01, 5))},
      {"Sensor.false_alarms_per_s", may(spread(0.001, 0.5))},  // see drawn_agreement.h
      {"Sensor.position_error_m", may(number(0, 0.5))},
      {"Sensor.confirm_at", may(number(0.5, 0.999))},
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
      {"Layer.high_z_m", must(number(40, 50))},  // the second lies above: see drawn_agreement.h
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
      {"Basis.free_domain", may(kRarely)},  // in a plane, of few modes: see drawn_agreement.h

      {"Law.u_max_mps", must(spread(1, 40))},
      {"Law.kind", may(word(0.8))},
      {"Law.epsilon", may(spread(1e-3, 1))},
      {"Law.noise_intensity", may(spread(0.01, 2))},
      {"Law.noise_ceiling", may(spread(2, 20))},
      {"Law.contraction_gain_per_s", may(spread(1e-5, 1e-2))},
      {"Law.contraction_x_m", may(kPlace)},
      {"Law.contraction_y_m", may(kPlace)},
      {"Law.contraction_z_m", may(kPlace)},
      {"Law.anticipation", may(either(0, spread(0.01, 10)))},
      {"Law.memory_half_life_s",
       may(either(0, spread(10.1, 40)))},  // in ticks: see drawn_agreement.h

      {"Time.dt_s", may(spread(0.02, 1))},
      {"Time.duration_s", must(number(0.5, 60))},  // in ticks: see drawn_agreement.h
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
      {"Agents.quorum", may(either(100, number(1, 24)))},  // of all at most: see drawn_agreement.h
      {"Agents.forget_silent_after_s", may(either(0, spread(1e-3, 10)))},
      {"Agents.kind", many(0, 3)},
      {"Kind.name", must(text({"a", "fast-1", "_b.C"}))},  // each once: see drawn_agreement.h
      {"Kind.count", must(number(1, 3))},                  // the counts add up to the agents
      {"Kind.u_max_mps", may(spread(2, 40))},
      {"Kind.noise_intensity", may(spread(0.01, 2))},
      {"Kind.noise_ceiling", may(spread(2, 20))},
      {"Kind.footprint_sigma_m", may(spread(0.5, 40))},
      {"Kind.quality", may(spread(0.1, 5))},
      {"Kind.band", may(draw_block)},
      {"Kind.vehicle", may(draw_block)},
      {"Kind.speed_limit_mps", may(spread(5, 20))},
      {"Kind.station", many(0, 1)},  // in time of all: see drawn_agreement.h
      {"Kind.reserve_s", may(number(0.01, 0.3))},
      {"Kind.battery", may(draw_block)},  // where there is a station
      {"Battery.capacity_wh", must(number(10, 20))},
      {"Battery.power_w", must(number(1, 100))},
      {"Battery.charge_w", may(number(1, 100))},
      {"Battery.reserve", may(number(0.01, 0.5))},
      {"Band.from", may(number(0, 4))},
      {"Band.to", may(number(5, 20))},
      {"Start.x_m", must(kPlace)},
      {"Start.y_m", must(kPlace)},
      {"Start.z_m", must(kPlace)},

      {"Vehicle.kind", may(word(0.3))},
      {"Vehicle.max_acceleration_mps2", must(spread(20, 200))},  // by kind: see drawn_agreement.h
      {"Vehicle.max_turn_radps", must(spread(0.5, 10))},
      {"Vehicle.min_speed_mps", must(spread(0.05, 0.5))},

      {"Separation.distance_m", must(number(0.5, 8))},
      {"Separation.position_error_m", may(either(0, number(0.01, 0.2)))},
      {"Separation.disturbance_m", may(spread(1e-4, 1e-2))},
      {"Separation.response_s", may(either(0, spread(0.01, 1)))},
      {"Separation.lease_s", may(either(0, number(5, 50)))},

      {"Polygon.solid", may(kTrue)},
      {"Polygon.unknown_free", {kTrue, 0, 0}},  // for maps of robots alone
      {"Polygon.solid_white", {kTrue, 0, 0}},   // for drawings alone
      {"World.walls", many(0, 2)},
      {"World.objects", may(draw_block)},
      {"Objects.count", may(number(1, 6))},  // or places: see drawn_agreement.h
      {"Objects.places", many(0, 3)},
      {"Objects.motion", may(draw_block)},
      {"Motion.speed_mps", must(spread(0.01, 2))},
      {"Motion.persistence_s", must(spread(0.1, 500))},
      {"Objects.end_when_found", may(number(1, 3))},  // see drawn_agreement.h
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

void add_fields(const Descriptor& type, std::set<std::string>& names) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (names.insert(name_of(field)).second && field.message_type() != nullptr) {
      add_fields(*field.message_type(), names);
    }
  }
}

}  // namespace

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
