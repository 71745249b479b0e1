// SPDX-License-Identifier: BSD-3-Clause
// Takes two scenarios that have every field between them, and spoils one field at a time. The
// limits come from the program's own table of fields.
#include "tests/checks_can_fail/planted_fields.h"

#include <google/protobuf/text_format.h>

#include <cmath>

#include "scenario/compile/defaults.h"

namespace ergocast::test {
namespace {

using google::protobuf::FieldDescriptor;
using Block = google::protobuf::Message;

/// A scenario with every block, and every number that other fields determine or limit.
constexpr const char* kRich = R"(
name: "rich" description: "all fields" seed: 1 goal_ergodic_metric: 1
origin { latitude_deg: 47.5 longitude_deg: 9.2 }
domain { origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50 origin_z_m: 0 size_z_m: 40 }
target {
  gaussians { weight: 1 mean_x_m: 30 mean_y_m: 20 mean_z_m: 20 sigma_m: 5 }
  gaussians { weight: 1 mean_x_m: 60 mean_y_m: 20 mean_z_m: 20 covariance { xx_m2: 25 yy_m2: 25 xy_m2: 1 zz_m2: 25 } }
  uniform_weight: 1
  maps { file: "even.csv" weight: 1 origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50 first_row: NORTH }
  regions { weight: 1 polygon { vertices { x_m: 1 y_m: 1 } vertices { x_m: 9 y_m: 1 } vertices { x_m: 9 y_m: 9 } } }
  keep_outs { file: "pier.geojson" }
  voxels { file: "grid.nc" variable: "v" weight: 1 time_index: 1 x_axis: "x" y_axis: "y" z_axis: "z" time_axis: "time" }
}
basis { modes_x: 8 modes_y: 8 modes_z: 8 }
law {
  u_max_mps: 5 regularization: RELATIVE epsilon: 0.2 perturbation: ADAPTIVE noise_intensity: 0.1 noise_ceiling: 2
  contraction_gain_per_s: 0.001 contraction_center: POINT contraction_x_m: 50 contraction_y_m: 25 contraction_z_m: 20
  anticipation: 2 memory_half_life_s: 30
}
time {
  dt_s: 0.1 duration_s: 60 broadcast_period_ticks: 1 high_mode_period_factor: 4 contribution_encoding: FIXED16 pace: REALTIME
}
agents {
  starts { x_m: 10 y_m: 20 z_m: 20 } random_count: 1 quorum: 1 footprint_sigma_m: 2 quality: 3
  kind {
    name: "all" count: 2 u_max_mps: 5 noise_intensity: 0.1 noise_ceiling: 2 footprint_sigma_m: 1 quality: 1
    band { from: 0 to: 9 } vehicle { kind: ACCELERATION max_acceleration_mps2: 900 }
    speed_limit_mps: 90
    station { x_m: 20 y_m: 20 z_m: 20 } station { x_m: 60 y_m: 20 z_m: 20 } reserve_s: 20
    battery { capacity_wh: 50 power_w: 100 charge_w: 90 reserve: 0.3 }
  }
}
world { speed_limit_mps: 100 }
vehicle { kind: ACCELERATION max_acceleration_mps2: 1000 }
separation { distance_m: 2 lease_s: 0 }
sensor { radius_m: 5 detections_per_s: 0.5 false_alarms_per_s: 0 position_error_m: 0.5 confirm_at: 0.9 }
)";

/// The fields that exclude many of the others.
constexpr const char* kDivided = R"(
domain { size_x_m: 100 size_y_m: 50 }
target { uniform_weight: 1 }
law { u_max_mps: 5 }
time { duration_s: 60 }
team { sites: 1 site_row_period_ticks: 3 }
agents { starts { x_m: 10 y_m: 20 } }
)";

/// The fields that its kind of vehicles does not have.
constexpr const char* kWinged = R"(
domain { size_x_m: 100 size_y_m: 50 }
target {
  uniform_weight: 1
  keep_outs { vertices { x_m: 60 y_m: 10 } vertices { x_m: 70 y_m: 10 } vertices { x_m: 70 y_m: 20 } solid: true }
}
law { u_max_mps: 5 }
time { duration_s: 60 }
agents { starts { x_m: 10 y_m: 20 } }
world {
  speed_limit_mps: 100 wall_clearance_m: 1 objects { count: 3 end_when_found: 2 motion { speed_mps: 1 persistence_s: 60 } }
  walls { vertices { x_m: 80 y_m: 10 } vertices { x_m: 90 y_m: 10 } vertices { x_m: 90 y_m: 20 } }
  walls { file: "room.yaml" unknown_free: true }
  walls { file: "dot.svg" solid_white: true }
}
vehicle { kind: FIXED_WING max_turn_radps: 1 min_speed_mps: 4 }
)";

/// Calls `visit` for each field that takes a number or a word, with its block.
void each_field(
    Block& message, const std::string& path,
    const std::function<void(Block&, const FieldDescriptor&, const std::string&)>& visit) {
  const auto* reflection = message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    const std::string name = path + field.name();
    if (field.message_type() == nullptr) {
      if (reflection->HasField(message, &field)) visit(message, field, name);
    } else if (field.is_repeated()) {
      for (int j = 0; j < reflection->FieldSize(message, &field); ++j) {
        each_field(*reflection->MutableRepeatedMessage(&message, &field, j),
                   name + "[" + std::to_string(j) + "].", visit);
      }
    } else if (reflection->HasField(message, &field)) {
      each_field(*reflection->MutableMessage(&message, &field), name + ".", visit);
    }
  }
}

}  // namespace

/// rich_ with the defaults of omitted fields.
proto::Scenario PlantedFields::rich_scenario() const {
  proto::Scenario scenario;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(rich_, &scenario));
  fill_in(scenario, file_);
  return scenario;
}

/// Expects this problem of the field at `path` after `spoil` was applied.
void PlantedFields::expect_said(const std::string& path, const std::string& what,
                                const std::function<void(Block&, const FieldDescriptor&)>& spoil) {
  proto::Scenario scenario = rich_scenario();
  each_field(scenario, "", [&](Block& block, const FieldDescriptor& field, const std::string& at) {
    if (at == path) spoil(block, field);
  });
  std::string text;
  google::protobuf::TextFormat::PrintToString(scenario, &text);
  write("s.textproto", text);
  EXPECT_EQ(ergocast({"check", file_}), 2) << path << what;
  bool found = false;
  for (const std::string& line : note(output())) {
    found = found || (line.starts_with(file_.string() + ":") &&
                      line.find(" " + path + ": ") != line.npos && line.find(what) != line.npos);
  }
  EXPECT_TRUE(found) << path << ": " << what << ":\n" << output();
}

void PlantedFields::expect_value_refused(const std::string& path, double value,
                                         const std::string& what) {
  expect_said(path, what, [value](Block& block, const FieldDescriptor& field) {
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
      block.GetReflection()->SetDouble(&block, &field, value);
    } else {
      block.GetReflection()->SetInt32(&block, &field, static_cast<std::int32_t>(value));
    }
  });
}

void PlantedFields::expect_limits(const FieldDescriptor& field, const std::string& path,
                                  const FieldRule& rule) {
  const bool whole = field.cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE;
  const Range& range = rule.range;
  // The domain's origin is not inside the domain.
  const bool in_domain = range.coordinate && !path.starts_with("domain.");
  const std::string above = in_domain ? " is far outside the domain" : " is above the limit ";
  const std::string too_low = in_domain ? above : " is below the limit ";
  expect_value_refused(path, whole ? range.high + 1 : 1.01 * range.high, above);
  if (range.low_excluded) {
    expect_value_refused(path, range.low, " is not above ");
  } else {
    const double below = range.low - std::abs(range.low) - 1;
    expect_value_refused(path, whole ? range.low - 1 : below, too_low);
  }
  if (!whole) expect_value_refused(path, std::nan(""), "nan is not a number");
  if (rule.absence != Absence::kRefused) return;
  expect_said(path, "is missing", [](Block& block, const FieldDescriptor& one) {
    block.GetReflection()->ClearField(&block, &one);
  });
}

void PlantedFields::plant_in_fields() {
  std::set<std::string> covered;
  for (const char* text : {kRich, kWinged, kDivided}) {
    rich_ = text;
    plant_in_fields_of_rich(covered);
  }
  const auto* file = proto::Scenario::descriptor()->file();
  for (int i = 0; i < file->message_type_count(); ++i) {
    for (int j = 0; j < file->message_type(i)->field_count(); ++j) {
      const FieldDescriptor& field = *file->message_type(i)->field(j);
      if (field.message_type() != nullptr) continue;
      EXPECT_TRUE(covered.contains(field.full_name())) << field.full_name() << ": add it to kRich";
    }
  }
}

void PlantedFields::plant_in_fields_of_rich(std::set<std::string>& covered) {
  write("s.textproto", rich_);
  EXPECT_EQ(ergocast({"check", file_}), 0) << output();
  proto::Scenario rich = rich_scenario();
  each_field(rich, "", [&](Block&, const FieldDescriptor& field, const std::string& path) {
    if (!covered.insert(field.full_name()).second) return;
    if (const FieldRule* rule = rule_of(field)) expect_limits(field, path, *rule);
    if (field.enum_type() == nullptr) return;
    expect_said(path, "has no value 99", [](Block& block, const FieldDescriptor& one) {
      block.GetReflection()->SetEnumValue(&block, &one, 99);
    });
  });
}

}  // namespace ergocast::test
