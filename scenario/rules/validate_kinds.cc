// SPDX-License-Identifier: BSD-3-Clause
// Checks each kind of agents against the others, the team, the law, the basis and the domain.
#include "scenario/rules/validate_kinds.h"

#include <cmath>
#include <set>
#include <string>

#include "core/mission/kinds.h"
#include "plan/mission_limits.h"
#include "scenario/parse/convert.h"

namespace ergocast {
namespace {

class KindRules {
 public:
  KindRules(const proto::Scenario& scenario, Checks& checks)
      : scenario_(scenario), kinds_(scenario.agents().kind()), checks_(checks) {}

  void run() {
    if (kinds_.size() > kMaxKinds) {
      checks_.problem(
          "agents.kind",
          std::to_string(kinds_.size()) + " kinds are above the limit " + std::to_string(kMaxKinds),
          "leave out " + std::to_string(kinds_.size() - kMaxKinds));
    }
    names();
    counts();
    for (int i = 0; i < kinds_.size(); ++i) {
      speed(i);
      noise(i);
      footprint(i);
      band(i);
    }
  }

 private:
  static std::string path_of(int i) { return indexed("agents.kind", i); }
  bool sound(const std::string& path) const { return checks_.sound(path); }

  void names() {
    std::set<std::string> taken;
    for (int i = 0; i < kinds_.size(); ++i) {
      const std::string path = path_of(i) + ".name", &name = kinds_[i].name();
      if (!kinds_[i].has_name()) {
        checks_.missing(path, "is missing", "add it, such as name: \"fast\"");
      } else if (!is_kind_name(name)) {
        checks_.problem(path, "cannot name a kind",
                        "write 1 to " + std::to_string(kMaxKindNameLength) +
                            " letters, digits, '_', '-' or '.', and begin with a letter, a digit "
                            "or '_'");
      } else if (!taken.insert(name).second) {
        checks_.problem(path, "another kind is called \"" + name + "\", too",
                        "give each kind a name of its own");
      }
    }
  }

  void counts() {
    const proto::Agents& agents = scenario_.agents();
    if (!sound("agents.random_count") || kinds_.empty()) return;
    int count = 0;
    for (int i = 0; i < kinds_.size(); ++i) {
      if (!sound(path_of(i) + ".count")) return;
      count += kinds_[i].count();
    }
    const int size = agents.starts_size() + agents.random_count();
    if (count == size) return;
    checks_.problem("agents.kind",
                    "the counts add up to " + std::to_string(count) + " agents, and the team has " +
                        std::to_string(size),
                    "write counts that add up to " + std::to_string(size) +
                        ", or other starts or random_count");
  }

  /// Checks a kind's speed and noise by the rules for the law's.
  void speed(int i) {
    const std::string path = path_of(i) + ".u_max_mps";
    if (!sound(path) || !sound("law") || !sound("domain") || !sound("time.dt_s")) return;
    const Box domain = domain_of(scenario_.domain());
    const double u_max_mps = kinds_[i].u_max_mps(), side_m = domain.shortest_side_m();
    step(path, "a step of the input", u_max_mps, scenario_.time().dt_s(), side_m);
    const double needed_mps =
        scenario_.law().contraction_gain_per_s() *
        domain.farthest_distance_m(contraction_center_of(scenario_.law(), domain));
    if (u_max_mps >= needed_mps) return;
    checks_.problem(path,
                    shortest(u_max_mps) +
                        " is too weak for the law's contraction_gain_per_s at the farthest corner, "
                        "which needs " +
                        shortest(rounded_up(needed_mps)),
                    "write at least " + shortest(rounded_up(needed_mps)) +
                        ", or a smaller law.contraction_gain_per_s");
  }

  void noise(int i) {
    const std::string path = path_of(i) + ".noise_";
    if (!sound(path + "intensity") || !sound(path + "ceiling") || !sound("domain") ||
        !sound("time.dt_s") || !sound("law"))
      return;
    const proto::Kind& kind = kinds_[i];
    const double side_m = domain_of(scenario_.domain()).shortest_side_m();
    const double root_dt = std::sqrt(scenario_.time().dt_s());
    step(path + "intensity", "a step of the least noise", kind.noise_intensity(), root_dt, side_m);
    step(path + "ceiling", "a step of the greatest noise", kind.noise_ceiling(), root_dt, side_m);
    const bool adaptive = scenario_.law().perturbation() == proto::Law::ADAPTIVE;
    if (!adaptive || kind.noise_ceiling() >= kind.noise_intensity()) return;
    checks_.problem(path + "ceiling",
                    shortest(kind.noise_ceiling()) + " is less than the kind's least noise, " +
                        shortest(kind.noise_intensity()),
                    "write no less than that");
  }

  /// One step of `size` per `unit` must not be longer than the domain.
  void step(const std::string& path, const std::string& which, double size, double unit,
            double side_m) {
    if (size * unit <= side_m) return;
    checks_.problem(
        path,
        shortest(size) + " makes " + which + " " + shortest(rounded_up(size * unit)) +
            " m long, and the domain's shorter side is " + shortest(side_m) + " m",
        "write at most " + shortest(rounded_down(side_m / unit)) + ", or take shorter steps");
  }

  void footprint(int i) {
    const std::string path = footprint_path(scenario_.agents(), i);
    if (!sound(path) || !sound("domain")) return;
    const double longest_m = domain_of(scenario_.domain()).size_m.maxCoeff();
    const double sigma_m = kinds_[i].footprint_sigma_m();
    if (sigma_m <= longest_m) return;
    checks_.problem(path,
                    shortest(sigma_m) + " is larger than the domain, whose longest side is " +
                        shortest(longest_m) + " m",
                    "write at most " + shortest(longest_m));
  }

  void band(int i) {
    const std::string path = path_of(i) + ".band";
    if (!kinds_[i].has_band() || !sound(path) || !sound("basis")) return;
    const proto::Band& band = kinds_[i].band();
    const Basis basis = basis_of(scenario_.basis());
    AgentKind kind;
    kind.band_from = band.from();
    kind.band_to = band.to();
    if (covers_any_mode(kind, basis)) return;
    const double largest = std::hypot(basis.modes_x - 1, basis.modes_y - 1, basis.modes_z - 1);
    const std::string end = band.has_to() ? " to " + shortest(band.to()) : " on";
    checks_.problem(path,
                    "covers no mode: no |k| other than 0 is from " + shortest(band.from()) + end,
                    "write a band within 1 to " + shortest(rounded_down(largest)) +
                        ", with a from below its to");
  }

  const proto::Scenario& scenario_;
  const google::protobuf::RepeatedPtrField<proto::Kind>& kinds_;
  Checks& checks_;
};

}  // namespace

std::string footprint_path(const proto::Agents& agents, int kind) {
  const bool inherited = agents.has_footprint_sigma_m() &&
                         agents.kind(kind).footprint_sigma_m() == agents.footprint_sigma_m();
  return (inherited ? "agents" : indexed("agents.kind", kind)) + ".footprint_sigma_m";
}

void validate_kinds(const proto::Scenario& scenario, Checks& checks) {
  if (scenario.agents().kind_size() > 0) KindRules(scenario, checks).run();
}

}  // namespace ergocast
