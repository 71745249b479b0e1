// SPDX-License-Identifier: BSD-3-Clause
// The table has a row for each number that a mission does not have, or whose default is not that of
// core/mission/mission.h.
#include "scenario/parse/fields.h"

#include <map>
#include <optional>

#include "core/base/require.h"
#include "plan/mission_fields.h"
#include "scenario/parse/findings.h"
#include "scenario/scenario.pb.h"

namespace ergocast {
namespace {

using enum Absence;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

using limits::above;
using limits::between;

constexpr Range kCoordinate = {limits::kCoordinate_m, true};
/// A variance; its effective limits follow from the domain.
constexpr Limits kVariance = above(0, 1e22);
constexpr Limits kWeight = above(0, 1e9);

/// The range of a mission's field: plan/mission_fields.h has it.
constexpr std::optional<Range> kMissions;

struct Row {
  std::string_view message, field;
  std::optional<Range> range;
  Absence absence;
  double default_value = 0;
};
constexpr Row kRows[] = {
    {"Origin", "latitude_deg", between(-90, 90), kRefused},
    {"Origin", "longitude_deg", between(-180, 180), kRefused},

    {"Domain", "size_x_m", kMissions, kRefused},
    {"Domain", "size_y_m", kMissions, kRefused},

    {"Target", "uniform_weight", between(0, 1e9), kDefaulted, 0},
    {"Gaussian", "weight", kWeight, kDefaulted, 1},
    {"Gaussian", "mean_x_m", kCoordinate, kRefused},
    {"Gaussian", "mean_y_m", kCoordinate, kRefused},
    {"Gaussian", "mean_z_m", kCoordinate, kRefused},
    {"Gaussian", "sigma_m", above(0, 1e11), kLeft},
    {"Gaussian", "sigma_z_m", above(0, 1e11), kLeft},
    {"Covariance", "xx_m2", kVariance, kRefused},
    {"Covariance", "yy_m2", kVariance, kRefused},
    {"Covariance", "xy_m2", between(-1e22, 1e22), kDefaulted, 0},
    {"Covariance", "zz_m2", kVariance, kRefused},
    {"Covariance", "xz_m2", between(-1e22, 1e22), kDefaulted, 0},
    {"Covariance", "yz_m2", between(-1e22, 1e22), kDefaulted, 0},

    {"Map", "weight", kWeight, kDefaulted, 1},
    {"Map", "origin_x_m", kCoordinate, kLeft},
    {"Map", "origin_y_m", kCoordinate, kLeft},
    {"Map", "size_x_m", between(1e-3, 1e9), kLeft},
    {"Map", "size_y_m", between(1e-3, 1e9), kLeft},
    {"Voxels", "weight", kWeight, kDefaulted, 1},
    {"Voxels", "time_index", between(0, 1000000), kLeft},
    {"Layer", "low_z_m", kCoordinate, kRefused},
    {"Layer", "high_z_m", kCoordinate, kRefused},
    {"Layer", "value", between(0, 1e9), kDefaulted, 1},
    {"Region", "weight", kWeight, kDefaulted, 1},
    {"Polygon", "low_z_m", kCoordinate, kLeft},
    {"Polygon", "high_z_m", kCoordinate, kLeft},
    {"Vertex", "x_m", kCoordinate, kRefused},
    {"Vertex", "y_m", kCoordinate, kRefused},

    {"Basis", "modes_x", kMissions, kLeft},
    {"Basis", "modes_y", kMissions, kLeft},
    {"Basis", "sobolev_exponent", kMissions, kLeft},

    {"Law", "u_max_mps", kMissions, kLeft},
    {"Law", "epsilon", kMissions, kLeft},
    {"Law", "noise_intensity", kMissions, kLeft},
    {"Law", "contraction_gain_per_s", kMissions, kLeft},
    {"Law", "contraction_x_m", kCoordinate, kLeft},
    {"Law", "contraction_y_m", kCoordinate, kLeft},
    {"Law", "contraction_z_m", kCoordinate, kLeft},
    {"Law", "anticipation", kMissions, kLeft},
    {"Law", "memory_half_life_s", kMissions, kLeft},

    {"Time", "duration_s", limits::kDuration_s, kRefused},
    {"Time", "broadcast_period_ticks", kMissions, kLeft},

    {"Separation", "distance_m", kMissions, kRefused},
    {"Separation", "position_error_m", kMissions, kDefaulted, 0},
    {"Separation", "response_s", kMissions, kDefaulted, 0},

    {"Agents", "random_count", between(0, kMostAgentsOfSites), kDefaulted, 0},
    {"Agents", "quorum", kMissions, kLeft},
    {"Agents", "footprint_sigma_m", between(0, 1e7), kLeft},
    {"Agents", "quality", above(0, 1e6), kLeft},
    {"Kind", "count", kMissions, kRefused},
    {"Kind", "u_max_mps", kMissions, kLeft},
    {"Kind", "noise_intensity", kMissions, kLeft},
    {"Kind", "noise_ceiling", kMissions, kLeft},
    {"Battery", "capacity_wh", kMissions, kRefused},
    {"Battery", "power_w", kMissions, kRefused},
    {"Band", "from", kMissions, kDefaulted, 0},
    {"Band", "to", above(0, 1000), kLeft},
    {"Motion", "speed_mps", kMissions, kRefused},
    {"Start", "x_m", kCoordinate, kRefused},
    {"Start", "y_m", kCoordinate, kRefused},
    {"Start", "z_m", kCoordinate, kRefused},
};

using Rules = std::map<const FieldDescriptor*, FieldRule>;

/// Adds the rules of the mission's fields in a block.
class RuleCollector : public FieldVisitor {
 public:
  RuleCollector(const Message& block, Rules& rules) : block_(block), rules_(rules) {}

  void number(const Field& field, double value) {
    rules_.emplace(&find_field(block_, field.name).field,
                   FieldRule{field.limits, field.when.given ? kDefaulted : kLeft, value});
  }
  void part(const Field& field, const auto& part) {
    const auto [block, found] = find_field(block_, field.name);
    RuleCollector inner(block.GetReflection()->GetMessage(block, &found), rules_);
    list_fields(inner, part);
  }
  void part(const Field&, const std::vector<AgentKind>&) {
    const proto::Kind block;
    const AgentKind kind;
    RuleCollector inner(block, rules_);
    list_fields(inner, kind);
  }
  /// The rules of a vehicle are those of the mission's own.
  void part(const Field&, const std::optional<VehicleLimits>&) {}

 private:
  const Message& block_;
  Rules& rules_;
};

Rules make_rules() {
  Rules rules;
  const proto::Scenario scenario;
  const Mission mission;
  RuleCollector collector(scenario, rules);
  list_fields(collector, mission);
  for (const auto& [message, name, range, absence, default_value] : kRows) {
    const auto* field = scenario.GetDescriptor()
                            ->file()
                            ->FindMessageTypeByName(std::string(message))
                            ->FindFieldByName(std::string(name));
    rules.insert_or_assign(
        field, FieldRule{range ? *range : rules.at(field).range, absence, default_value});
  }
  return rules;
}

}  // namespace

std::string Range::text() const {
  if (low_excluded) return "above " + shortest(low) + ", at most " + shortest(high);
  return shortest(low) + " to " + shortest(high);
}

const FieldRule* rule_of(const FieldDescriptor& field) {
  static const Rules rules = make_rules();
  const auto found = rules.find(&field);
  return found == rules.end() ? nullptr : &found->second;
}

bool is_along_z(const FieldDescriptor& field) {
  return field.name().find("z_m") != std::string::npos || field.name().ends_with("_z");
}

double number_in(const Message& block, const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE
             ? block.GetReflection()->GetDouble(block, &field)
             : block.GetReflection()->GetInt32(block, &field);
}

FoundField find_field(const Message& block, std::string_view name) {
  const std::size_t dot = name.find('.');
  const auto* field = block.GetDescriptor()->FindFieldByName(std::string(name.substr(0, dot)));
  ERGOCAST_REQUIRE(field != nullptr);
  if (dot == std::string_view::npos) return {block, *field};
  return find_field(block.GetReflection()->GetMessage(block, field), name.substr(dot + 1));
}

}  // namespace ergocast
