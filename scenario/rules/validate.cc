// SPDX-License-Identifier: BSD-3-Clause
// One function for each block checks the rules between fields, which the table of fields cannot
// contain.
#include "scenario/rules/validate.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "scenario/parse/convert.h"
#include "scenario/parse/explain.h"
#include "scenario/parse/fields.h"
#include "scenario/parse/utf8.h"
#include "scenario/rules/validate_free_domain.h"
#include "scenario/rules/validate_kinds.h"
#include "scenario/rules/validate_objects.h"
#include "scenario/rules/validate_separation.h"
#include "scenario/rules/validate_sites.h"
#include "scenario/rules/validate_stations.h"
#include "scenario/rules/validate_target.h"
#include "scenario/rules/validate_vehicle.h"
#include "scenario/rules/validate_walls.h"

namespace ergocast {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using limits::kMaxOriginPerSize;
using limits::kMaxTicks;
using limits::kMinWallStep_s;
using limits::kPeriod_ticks;

/// Limit (Scenario): length of a description, `Scenario.description` [bytes]. Beyond it: the
/// scenario is refused.
constexpr std::size_t kMaxDescriptionBytes = 2000;

class Validator {
 public:
  Validator(const proto::Scenario& scenario, Checks& checks)
      : scenario_(scenario), checks_(checks) {}

  void run() {
    each_field(scenario_, "");
    words();
    domain();
    if (scenario_.has_target()) validate_target(scenario_, checks_);
    basis();
    validate_free_domain(scenario_, checks_);
    law();
    time();
    agents();
    disturbance();
    validate_kinds(scenario_, checks_);
    validate_vehicle(scenario_, checks_);
    if (scenario_.has_separation()) validate_separation(scenario_, checks_);
    validate_walls(scenario_, checks_);
    validate_objects(scenario_, checks_);
    validate_stations(scenario_, checks_);
    validate_sites(scenario_, checks_);
  }

 private:
  void problem(const std::string& path, const std::string& what, std::string remedy) {
    checks_.problem(path, what, std::move(remedy));
  }
  bool sound(const std::string& path) const { return checks_.sound(path); }
  void missing(const std::string& path, const std::string& what, std::string remedy) {
    checks_.missing(path, what, std::move(remedy));
  }
  bool in_range(const std::string& path, double value, const Range& range,
                const std::string& wanted = "") {
    return checks_.in_range(path, value, range, wanted);
  }

  // Rules for single fields.

  void each_field(const Message& message, const std::string& prefix) {
    const auto* reflection = message.GetReflection();
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
      const FieldDescriptor& field = *message.GetDescriptor()->field(i);
      const std::string path = prefix + field.name();
      if (field.message_type() == nullptr) {
        scalar(message, field, path);
      } else if (field.is_repeated()) {
        for (int j = 0; j < reflection->FieldSize(message, &field); ++j) {
          each_field(reflection->GetRepeatedMessage(message, &field, j), indexed(path, j) + ".");
        }
      } else if (reflection->HasField(message, &field)) {
        each_field(reflection->GetMessage(message, &field), path + ".");
      }
    }
  }

  void scalar(const Message& message, const FieldDescriptor& field, const std::string& path) {
    if (field.enum_type() != nullptr) return enumeration(message, field, path);
    const FieldRule* rule = rule_of(field);
    if (rule == nullptr) return;
    const bool of_a_box_alone = is_along_z(field) && !is_box();
    if (!message.GetReflection()->HasField(message, &field)) {
      if (rule->absence != Absence::kRefused || of_a_box_alone) return;
      const std::string place = place_wanted(field, *rule);
      return missing(path, "is missing",
                     "add " + field.name() + ", " + (place.empty() ? rule->range.text() : place));
    }
    if (of_a_box_alone && sound("domain.size_z_m")) return checks_.of_a_box_alone(path);
    in_range(path, number_in(message, field), rule->range, place_wanted(field, *rule));
  }

  bool is_box() const { return scenario_.domain().has_size_z_m(); }

  /// "in the domain, 0 to 2000", if the domain is known; empty for fields that are no place in it.
  std::string place_wanted(const FieldDescriptor& field, const FieldRule& rule) const {
    const proto::Domain& domain = scenario_.domain();
    if (!rule.range.coordinate) return "";
    const auto [low_m, size_m] =
        field.name().ends_with("x_m")   ? std::pair(domain.origin_x_m(), domain.size_x_m())
        : field.name().ends_with("y_m") ? std::pair(domain.origin_y_m(), domain.size_y_m())
                                        : std::pair(domain.origin_z_m(), domain.size_z_m());
    if (!rule.range.contains(low_m) || !(size_m > 0) || !rule.range.contains(size_m))
      return "in the domain";
    return "in the domain, " + shortest(low_m) + " to " + shortest(low_m + size_m);
  }

  void enumeration(const Message& message, const FieldDescriptor& field, const std::string& path) {
    const int value = message.GetReflection()->GetEnumValue(message, &field);
    if (field.enum_type()->FindValueByNumber(value) != nullptr) return;
    problem(path, "has no value " + std::to_string(value),
            "write one of " + enum_names(*field.enum_type()));
  }

  // Rules between fields.

  void words() {
    if (!is_name(scenario_.name())) {
      problem("name", "cannot name a folder",
              "write 1 to " + std::to_string(kMaxNameLength) +
                  " letters, digits, '_', '-' or '.', and begin with a letter, a digit or '_'");
    }
    const std::string& description = scenario_.description();
    if (description.size() > kMaxDescriptionBytes) {
      problem("description",
              std::to_string(description.size()) + " bytes are above the limit " +
                  std::to_string(kMaxDescriptionBytes),
              "use fewer words, or write a comment");
    }
    if (first_bad_utf8(description) != std::string_view::npos) {
      problem("description", "is not UTF-8", "write the characters themselves, not their bytes");
    }
  }

  void domain() {
    const proto::Domain& domain = scenario_.domain();
    origin("domain.origin_x_m", domain.origin_x_m(), "domain.size_x_m", domain.size_x_m());
    origin("domain.origin_y_m", domain.origin_y_m(), "domain.size_y_m", domain.size_y_m());
    if (is_box()) {
      origin("domain.origin_z_m", domain.origin_z_m(), "domain.size_z_m", domain.size_z_m());
    }
    if (!sound("domain")) return;
    shorter_side_m_ = domain_of(domain).shortest_side_m();
  }

  void origin(const std::string& path, double origin_m, const std::string& size_path,
              double size_m) {
    if (!sound(path) || !sound(size_path)) return;
    const double limit_m = kMaxOriginPerSize * size_m;
    if (std::abs(origin_m) <= limit_m) return;
    problem(path,
            shortest(origin_m) + " is more than " + shortest(limit_m) +
                " m from 0, too far for a domain of " + shortest(size_m) + " m",
            path.ends_with("z_m")
                ? "count heights from the lowest"
                : "count from its corner; if these are coordinates of a map, such as UTM, write "
                  "the corner as origin { latitude_deg: … longitude_deg: … }");
  }

  void basis() {
    const proto::Basis& basis = scenario_.basis();
    if (!sound("basis")) return;
    const int modes = basis_of(basis).mode_count();
    if (modes < 2) {
      problem("basis", "a single mode cannot distinguish two places", "write modes_x: 2 or more");
    } else if (modes > kMaxModes) {
      problem("basis",
              std::to_string(modes) + " modes are above the limit " + std::to_string(kMaxModes),
              "write fewer, such as 16 along each axis");
    }
  }

  void law() {
    const proto::Law& law = scenario_.law();
    if (!law.has_u_max_mps())
      missing("law.u_max_mps", "is missing, and agents need a speed",
              "add it, above 0, or write u_max_mps in every kind");
    contraction_point("law.contraction_x_m", law.has_contraction_x_m());
    contraction_point("law.contraction_y_m", law.has_contraction_y_m());
    if (is_box()) contraction_point("law.contraction_z_m", law.has_contraction_z_m());
    step("law.u_max_mps", law.u_max_mps(), scenario_.time().dt_s(), "u_max_mps · dt_s");
    step("law.noise_intensity", law.noise_intensity(), std::sqrt(scenario_.time().dt_s()),
         "noise_intensity · sqrt(dt_s)");
    if (sound("law.noise_intensity")) {
      step("law.noise_ceiling", law.noise_ceiling(), std::sqrt(scenario_.time().dt_s()),
           "noise_ceiling · sqrt(dt_s)");
    }
    ceiling();
    contraction();
    memory();
    if (law.kind() == proto::Law::SEARCH && is_box())
      problem("law.kind", "SEARCH needs a plane, and the domain is a box", "write COVER or MOW");
  }

  /// Some steps are needed between two halvings.
  void memory() {
    const double half_life_s = scenario_.law().memory_half_life_s();
    if (half_life_s == 0 || !sound("law.memory_half_life_s") || !sound("time.dt_s")) return;
    const double least_s = limits::kLeastHalfLife_ticks * scenario_.time().dt_s();
    if (half_life_s >= least_s) return;
    problem("law.memory_half_life_s",
            shortest(half_life_s) + " is below 10 steps of dt_s, " + shortest(rounded_up(least_s)) +
                " s",
            "write at least that, or 0: nothing is forgotten");
  }

  void ceiling() {
    const proto::Law& law = scenario_.law();
    if (!law.has_noise_ceiling() || !sound("law.noise") || !sound("law.perturbation")) return;
    if (law.perturbation() == proto::Law::CONSTANT) {
      problem("law.noise_ceiling", "has no effect with perturbation: CONSTANT",
              "remove it, or write perturbation: ADAPTIVE");
    } else if (law.noise_ceiling() < law.noise_intensity()) {
      problem("law.noise_ceiling",
              shortest(law.noise_ceiling()) + " is below noise_intensity, " +
                  shortest(law.noise_intensity()),
              "write at least that");
    }
  }

  void contraction_point(const std::string& path, bool present) {
    if (!sound("law.contraction_center")) return;
    const bool wanted = scenario_.law().contraction_center() == proto::Law::POINT;
    if (wanted && !present) {
      missing(path, "is missing", "add it, or choose another contraction_center");
    } else if (present && !wanted) {
      problem(path, "has no effect without contraction_center: POINT",
              "remove it, or write contraction_center: POINT");
    }
  }

  /// One step of `size` per `unit` must not be longer than the domain.
  void step(const std::string& path, double size, double unit, const std::string& product) {
    if (!sound(path) || !sound("time.dt_s") || !sound("domain")) return;
    if (size * unit <= shorter_side_m_) return;
    problem(
        path,
        shortest(size) + " makes " + product + " " + shortest(rounded_up(size * unit)) +
            " m, above the limit, the domain's shorter side " + shortest(shorter_side_m_) + " m",
        "write at most " + shortest(rounded_down(shorter_side_m_ / unit)) + ", or a smaller dt_s");
  }

  void contraction() {
    const proto::Law& law = scenario_.law();
    const double gain_per_s = law.contraction_gain_per_s();
    if (!sound("law.contraction") || !sound("domain")) return;
    const double dt_s = scenario_.time().dt_s();
    if (sound("time.dt_s") && gain_per_s * dt_s > 1) {
      problem("law.contraction_gain_per_s",
              shortest(gain_per_s) + " makes contraction_gain_per_s · dt_s " +
                  shortest(rounded_up(gain_per_s * dt_s)) + ", above the limit 1",
              "write at most " + shortest(rounded_down(1 / dt_s)));
    }
    if (!sound("law.u_max_mps")) return;
    const Box domain = domain_of(scenario_.domain());
    const Eigen::Vector3d center_m = contraction_center_of(law, domain);
    const double needed_mps = gain_per_s * domain.farthest_distance_m(center_m);
    if (law.u_max_mps() >= needed_mps) return;
    problem("law.u_max_mps",
            shortest(law.u_max_mps()) + " is too weak for contraction_gain_per_s " +
                shortest(gain_per_s) + " at the farthest corner, which needs " +
                shortest(rounded_up(needed_mps)),
            "write at least " + shortest(rounded_up(needed_mps)) +
                ", or a smaller contraction_gain_per_s");
  }

  void time() {
    duration();
    wall_time_of_a_step();
    longest_period();
  }

  void longest_period() {
    const proto::Time& time = scenario_.time();
    if (!sound("time.broadcast_period_ticks") || !sound("time.high_mode_period_factor")) return;
    const int factor = time.high_mode_period_factor(), period = time.broadcast_period_ticks();
    const auto most = static_cast<int>(kPeriod_ticks.high);
    if (factor * period <= most) return;
    problem("time.high_mode_period_factor",
            std::to_string(factor) + " makes " + std::to_string(factor * period) +
                " ticks with broadcast_period_ticks " + std::to_string(period) +
                ", above the limit " + std::to_string(most),
            "write at most " + std::to_string(most / period) + ", or a shorter period");
  }

  void wall_time_of_a_step() {
    const proto::Time& time = scenario_.time();
    if (time.pace() != proto::Time::REALTIME) return;
    if (!sound("time.dt_s") || !sound("time.realtime_factor")) return;
    const double wall_s = time.dt_s() / time.realtime_factor();
    if (wall_s >= kMinWallStep_s) return;
    problem("time.realtime_factor",
            shortest(time.realtime_factor()) + " makes a step last " + shortest(wall_s) +
                " s of wall time, below the limit " + shortest(kMinWallStep_s) + " s",
            "write at most " + shortest(rounded_down(time.dt_s() / kMinWallStep_s)) +
                ", or a greater dt_s");
  }

  void duration() {
    const proto::Time& time = scenario_.time();
    if (!sound("time.dt_s") || !sound("time.duration_s")) return;
    const double ticks = std::round(time.duration_s() / time.dt_s());
    if (ticks < 1) {
      problem(
          "time.duration_s",
          shortest(time.duration_s()) + " is less than one step of dt_s " + shortest(time.dt_s()),
          "write at least " + shortest(time.dt_s()));
    } else if (ticks > kMaxTicks) {
      problem("time.duration_s",
              shortest(ticks) + " steps are above the limit " + shortest(kMaxTicks),
              "write at most " + shortest(rounded_down(kMaxTicks * time.dt_s())) +
                  ", or a greater dt_s");
    }
  }

  void agents() {
    const proto::Agents& agents = scenario_.agents();
    starts();
    if (!sound("agents.random_count") || !sound("agents.quorum")) return;
    const int size = agents.starts_size() + agents.random_count();
    if (size == 0) {
      missing("agents", "the team is empty",
              is_box() ? "add starts { x_m: … y_m: … z_m: … } or random_count"
                       : "add starts { x_m: … y_m: … } or random_count");
    } else if (const int most = most_agents(scenario_); size > most) {
      problem("agents",
              "a team of " + std::to_string(size) + " is above the limit " + std::to_string(most),
              "leave out " + std::to_string(size - most));
    } else if (agents.quorum() > size) {
      problem("agents.quorum",
              std::to_string(agents.quorum()) + " is above the limit, the team's size " +
                  std::to_string(size),
              "write 1 to " + std::to_string(size));
    }
  }

  void starts() {
    const proto::Domain& domain = scenario_.domain();
    // Each axis separately: a problem of one hides no problem of the other.
    const bool x_known =
        domain.has_size_x_m() && sound("domain.origin_x_m") && sound("domain.size_x_m");
    const bool y_known =
        domain.has_size_y_m() && sound("domain.origin_y_m") && sound("domain.size_y_m");
    const bool z_known = is_box() && sound("domain.origin_z_m") && sound("domain.size_z_m");
    for (int i = 0; i < scenario_.agents().starts_size(); ++i) {
      const proto::Start& start = scenario_.agents().starts(i);
      const std::string path = indexed("agents.starts", i);
      if (!sound(path)) continue;
      if (x_known) inside(path + ".x_m", start.x_m(), domain.origin_x_m(), domain.size_x_m());
      if (y_known) inside(path + ".y_m", start.y_m(), domain.origin_y_m(), domain.size_y_m());
      if (z_known) inside(path + ".z_m", start.z_m(), domain.origin_z_m(), domain.size_z_m());
    }
  }

  void inside(const std::string& path, double value_m, double low_m, double size_m) {
    const double high_m = low_m + size_m;
    if (value_m >= low_m && value_m <= high_m) return;
    problem(path, shortest(value_m) + " is outside the domain",
            "write " + shortest(low_m) + " to " + shortest(high_m));
  }

  void disturbance() {
    step("world.disturbance_intensity", scenario_.world().disturbance_intensity(),
         std::sqrt(scenario_.time().dt_s()), "disturbance_intensity · sqrt(dt_s)");
  }

  const proto::Scenario& scenario_;
  Checks& checks_;
  double shorter_side_m_ = 0;  // known once the domain is valid
};

}  // namespace

void validate(const proto::Scenario& scenario, Checks& checks) {
  Validator(scenario, checks).run();
}

}  // namespace ergocast
