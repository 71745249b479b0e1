#include "scenario/validate.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "core/ids.h"
#include "scenario/convert.h"
#include "scenario/explain.h"
#include "scenario/fields.h"
#include "scenario/names.h"
#include "scenario/utf8.h"

namespace ergocast {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr std::size_t kMaxDescriptionBytes = 2000;
constexpr double kMaxOriginPerSize = 1e5;
constexpr Range kSigmaPerSide{1e-4, 1e4};
constexpr int kMaxGaussians = 64;
/// Above this the ridge is too thin for the quadrature of μ.
constexpr double kMaxCorrelation = 0.99;
constexpr double kMinMassInside = 1e-6;
constexpr double kMaxTicks = 1e8;
constexpr double kMinWallStep_s = 1e-4;

std::string indexed(const std::string& path, int index) {
  return path + "[" + std::to_string(index) + "]";
}

/// `value` rounded up to four digits: a limit that a person would like to type.
double rounded_up(double value) {
  if (!(value > 0)) return 0;
  const double scale = std::pow(10, 3 - std::floor(std::log10(value)));
  return std::ceil(value * scale) / scale;
}

/// `value` rounded down likewise.
double rounded_down(double value) {
  if (!(value > 0)) return 0;
  const double scale = std::pow(10, 3 - std::floor(std::log10(value)));
  return std::floor(value * scale) / scale;
}

double number_in(const Message& message, const FieldDescriptor& field) {
  const auto* reflection = message.GetReflection();
  return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE
             ? reflection->GetDouble(message, &field)
             : reflection->GetInt32(message, &field);
}

class Validator {
 public:
  Validator(const proto::Scenario& scenario, Findings& findings)
      : scenario_(scenario), findings_(findings), unsound_(findings.given_up()) {}

  void run() {
    each_field(scenario_, "");
    words();
    domain();
    target();
    basis();
    law();
    time();
    agents();
    disturbance();
  }

 private:
  void problem(const std::string& path, const std::string& what, std::string remedy) {
    unsound_.insert(path);
    findings_.add(path, what, std::move(remedy));
  }

  /// Whether nothing is wrong yet at `path` or below it. Fields are compared with each other only
  /// where each is sound by itself: one mistake is one problem.
  bool sound(const std::string& path) const {
    const auto next = unsound_.lower_bound(path);
    return next == unsound_.end() || !next->starts_with(path);
  }

  /// A field that nobody could read is not missing, nor is one in a block that nobody could read.
  void missing(const std::string& path, const std::string& what, std::string remedy) {
    if (!sound(path)) return;
    for (const std::string& lost : findings_.given_up()) {
      if (path.starts_with(lost + ".")) return;
    }
    problem(path, what, std::move(remedy));
  }

  // Each field by itself.

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
    if (!message.GetReflection()->HasField(message, &field)) {
      if (rule->absence != Absence::kRefused) return;
      return missing(path, "is missing", "add " + field.name() + ", " + rule->range.text());
    }
    in_range(path, number_in(message, field), rule->range);
  }

  void enumeration(const Message& message, const FieldDescriptor& field, const std::string& path) {
    const int value = message.GetReflection()->GetEnumValue(message, &field);
    if (field.enum_type()->FindValueByNumber(value) != nullptr) return;
    problem(path, "has no value " + std::to_string(value),
            "write one of " + enum_names(*field.enum_type()));
  }

  bool in_range(const std::string& path, double value, const Range& range) {
    if (range.contains(value)) return true;
    std::string what = shortest(value);
    if (std::isnan(value)) {
      what = "nan is not a number";
    } else if (value > range.high) {
      what += " is above the limit " + shortest(range.high);
    } else if (range.low_excluded) {
      what += " is not above " + shortest(range.low);
    } else {
      what += " is below the limit " + shortest(range.low);
    }
    problem(path, what, "write a number " + range.text());
    return false;
  }

  // Fields beside each other.

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
              "say it in fewer words, or in a comment");
    }
    if (first_bad_utf8(description) != std::string_view::npos) {
      problem("description", "is not UTF-8", "write the characters themselves, not their bytes");
    }
  }

  void domain() {
    const proto::Domain& domain = scenario_.domain();
    origin("domain.origin_x_m", domain.origin_x_m(), "domain.size_x_m", domain.size_x_m());
    origin("domain.origin_y_m", domain.origin_y_m(), "domain.size_y_m", domain.size_y_m());
    if (!sound("domain")) return;
    shorter_side_m_ = std::min(domain.size_x_m(), domain.size_y_m());
    longer_side_m_ = std::max(domain.size_x_m(), domain.size_y_m());
  }

  void origin(const std::string& path, double origin_m, const std::string& size_path,
              double size_m) {
    if (!sound(path) || !sound(size_path)) return;
    const double limit_m = kMaxOriginPerSize * size_m;
    in_range(path, origin_m, {-limit_m, limit_m});
  }

  void target() {
    const proto::Target& target = scenario_.target();
    if (target.gaussians_size() > kMaxGaussians) {
      problem("target",
              std::to_string(target.gaussians_size()) + " Gaussians are above the limit " +
                  std::to_string(kMaxGaussians),
              "leave out the lightest");
    }
    for (int i = 0; i < target.gaussians_size(); ++i) {
      width(target.gaussians(i), indexed("target.gaussians", i));
    }
    if (target.gaussians_size() == 0 && target.uniform_weight() == 0) {
      return missing("target", "there is nothing to cover",
                     "add gaussians { } or a uniform_weight above 0");
    }
    if (sound("target") && sound("domain")) mass();
  }

  void width(const proto::Gaussian& gaussian, const std::string& path) {
    if (gaussian.has_sigma_m() == gaussian.has_covariance()) {
      if (gaussian.has_sigma_m()) {
        return problem(path, "has both sigma_m and covariance", "keep one of them");
      }
      if (!sound(path + ".sigma_m") || !sound(path + ".covariance")) return;
      return problem(path, "has no width", "add sigma_m or covariance { }");
    }
    if (gaussian.has_sigma_m()) return deviation(path + ".sigma_m", gaussian.sigma_m());
    if (sound(path + ".covariance")) covariance(gaussian.covariance(), path + ".covariance");
  }

  void deviation(const std::string& path, double sigma_m) {
    if (!sound(path) || !sound("domain")) return;
    in_range(path, sigma_m,
             {kSigmaPerSide.low * longer_side_m_, kSigmaPerSide.high * longer_side_m_});
  }

  void covariance(const proto::Covariance& c, const std::string& path) {
    const double limit_m2 = kMaxCorrelation * std::sqrt(c.xx_m2()) * std::sqrt(c.yy_m2());
    if (!(std::abs(c.xy_m2()) <= limit_m2)) {
      return problem(
          path + ".xy_m2",
          shortest(c.xy_m2()) + " leaves too little for the covariance to be positive " +
              "definite: the limit is " + shortest(kMaxCorrelation) + " sqrt(xx_m2 yy_m2)",
          "write " + shortest(-rounded_down(limit_m2)) + " to " + shortest(rounded_down(limit_m2)));
    }
    if (!sound("domain")) return;
    variance(path + ".xx_m2", c.xx_m2());
    variance(path + ".yy_m2", c.yy_m2());
  }

  void variance(const std::string& path, double variance_m2) {
    const double low_m = kSigmaPerSide.low * longer_side_m_;
    const double high_m = kSigmaPerSide.high * longer_side_m_;
    in_range(path, variance_m2, {low_m * low_m, high_m * high_m});
  }

  void mass() {
    const TargetDensity target = target_of(scenario_.target());
    double all = target.uniform_weight;
    for (const Gaussian& gaussian : target.gaussians) all += gaussian.weight;
    const double inside = mass_inside(target, domain_of(scenario_.domain())) / all;
    if (inside >= kMinMassInside) return;
    problem("target",
            "only " + shortest(inside) + " of its weight is inside the domain, below the limit " +
                shortest(kMinMassInside),
            "move the Gaussians into the domain, or widen them");
  }

  void basis() {
    const proto::Basis& basis = scenario_.basis();
    if (!sound("basis") || basis.modes_x() * basis.modes_y() >= 2) return;
    problem("basis", "a single mode tells no two places apart", "write modes_x: 2 or more");
  }

  void law() {
    const proto::Law& law = scenario_.law();
    contraction_point("law.contraction_x_m", law.has_contraction_x_m());
    contraction_point("law.contraction_y_m", law.has_contraction_y_m());
    step("law.u_max_mps", law.u_max_mps(), scenario_.time().dt_s(), "u_max_mps · dt_s");
    step("law.noise_intensity", law.noise_intensity(), std::sqrt(scenario_.time().dt_s()),
         "noise_intensity · sqrt(dt_s)");
    if (sound("law.noise_intensity")) step("law.noise_ceiling", law.noise_ceiling(), std::sqrt(scenario_.time().dt_s()),
         "noise_ceiling · sqrt(dt_s)");
    ceiling();
    contraction();
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
    const Rectangle domain = domain_of(scenario_.domain());
    const Eigen::Vector2d center_m = law_of(law, domain).contraction_center_m;
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
    heartbeat();
  }

  void heartbeat() {
    const proto::Time& time = scenario_.time();
    if (!sound("time.broadcast") || time.broadcast_error_budget() <= 0) return;
    if (time.broadcast_heartbeat_ticks() >= time.broadcast_period_ticks()) return;
    problem("time.broadcast_heartbeat_ticks",
            std::to_string(time.broadcast_heartbeat_ticks()) +
                " is below broadcast_period_ticks, " + std::to_string(time.broadcast_period_ticks()),
            "write at least that");
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
      missing("agents", "the team is empty", "add starts { x_m: … y_m: … } or random_count");
    } else if (size > kMaxAgents) {
      problem(
          "agents",
          "a team of " + std::to_string(size) + " is above the limit " + std::to_string(kMaxAgents),
          "leave out " + std::to_string(size - kMaxAgents));
    } else if (agents.quorum() > size) {
      problem("agents.quorum",
              std::to_string(agents.quorum()) + " is above the limit, the team's size " +
                  std::to_string(size),
              "write 1 to " + std::to_string(size));
    }
  }

  void starts() {
    const proto::Domain& domain = scenario_.domain();
    // Each axis by itself: one that is wrong hides nothing of the other.
    const bool x_known = domain.has_size_x_m() && sound("domain.origin_x_m") && sound("domain.size_x_m");
    const bool y_known = domain.has_size_y_m() && sound("domain.origin_y_m") && sound("domain.size_y_m");
    for (int i = 0; i < scenario_.agents().starts_size(); ++i) {
      const proto::Start& start = scenario_.agents().starts(i);
      const std::string path = indexed("agents.starts", i);
      if (!sound(path)) continue;
      if (x_known) inside(path + ".x_m", start.x_m(), domain.origin_x_m(), domain.size_x_m());
      if (y_known) inside(path + ".y_m", start.y_m(), domain.origin_y_m(), domain.size_y_m());
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
  Findings& findings_;
  std::set<std::string> unsound_;
  double shorter_side_m_ = 0, longer_side_m_ = 0;  // once the domain is sound
};

}  // namespace

void validate(const proto::Scenario& scenario, Findings& findings) {
  Validator(scenario, findings).run();
}

}  // namespace ergocast
