// SPDX-License-Identifier: BSD-3-Clause
// Holds distance, speed, holding, disturbance, room and starts of a team against each other.
#include "scenario/validate_separation.h"

#include <algorithm>
#include <array>

#include "core/separation.h"
#include "scenario/convert.h"

namespace ergocast {
namespace {

class SeparationRules {
 public:
  SeparationRules(const proto::Scenario& scenario, Checks& checks)
      : scenario_(scenario), checks_(checks), mission_(mission_of(scenario)) {}

  void run() {
    const int team = scenario_.agents().starts_size() + scenario_.agents().random_count();
    distance();
    disturbance();
    hold();
    room(static_cast<std::size_t>(team));
    starts();
  }

 private:
  double step_m() const { return mission_.speed_limit_mps * mission_.timing.dt_s; }

  void distance() {
    const double most_m = mission_.domain.shortest_side_m() / 4;
    if (mission_.separation.distance_m <= most_m) return;
    checks_.problem("separation.distance_m",
                    shortest(mission_.separation.distance_m) +
                        " is above a quarter of the domain's shorter side, " + shortest(most_m),
                    "write at most " + shortest(rounded_down(most_m)));
  }

  void disturbance() {
    const double limit_m = step_m() / 4;
    if (mission_.separation.disturbance_m < limit_m) return;
    checks_.problem("separation.disturbance_m",
                    shortest(rounded_up(mission_.separation.disturbance_m)) +
                        " is not below a quarter of a step, speed_limit_mps · dt_s / 4 = " +
                        shortest(rounded_down(limit_m)) + ": vehicles could not make up for it",
                    "write less, or a greater speed_limit_mps, or less disturbance_intensity");
  }

  void hold() {
    const double held_s =
        static_cast<double>(unguarded_hold_ticks(mission_)) * mission_.timing.dt_s;
    const double most_s = mission_.separation.distance_m / (4 * mission_.speed_limit_mps);
    if (held_s <= most_s * (1 + 1e-9)) return;
    checks_.problem("time.command_hold_s",
                    shortest(mission_.timing.command_hold_s) +
                        " is too long without separation.guard: a vehicle may be anywhere within "
                        "distance_m, unless it is at most distance_m / (4 speed_limit_mps) = " +
                        shortest(rounded_up(most_s)),
                    "write at most " + shortest(rounded_down(most_s)) + ", or guard: true");
  }

  void room(std::size_t team) {
    const double share = packing(mission_, team);
    if (share <= kHopelessPacking) return;
    checks_.problem("separation.distance_m",
                    std::to_string(team) + " agents " + shortest(start_distance_m(mission_)) +
                        " m apart take up " + shortest(rounded_up(100 * share)) +
                        " % of the domain, above the limit 30 %: they would block each other",
                    "write a smaller distance, fewer agents or a larger domain");
  }

  void starts() {
    const double least_m = start_distance_m(mission_);
    const auto& starts_m = mission_.starts_m;
    for (std::size_t i = 0; i < starts_m.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const std::array pair = {starts_m[i], starts_m[j]};
        const double apart_m = least_distance_m(pair);
        if (apart_m >= least_m) continue;
        checks_.problem(indexed("agents.starts", static_cast<int>(i)),
                        "is " + shortest(rounded_down(apart_m)) + " m from starts[" +
                            std::to_string(j) + "], nearer than the distance at the start, " +
                            shortest(rounded_up(least_m)),
                        "move it away");
        break;
      }
    }
  }

  const proto::Scenario& scenario_;
  Checks& checks_;
  Mission mission_;
};

}  // namespace

void validate_separation(const proto::Scenario& scenario, Checks& checks) {
  // Each of them is part of the rules, which need all of them to be sound.
  const std::array parts = {"domain", "basis", "law",     "time",
                            "agents", "world", "vehicle", "separation"};
  if (!std::ranges::all_of(parts, [&](const char* part) { return checks.sound(part); })) return;
  if (!scenario.world().has_speed_limit_mps()) {
    checks.missing("world.speed_limit_mps", "is missing, and separation relies on it",
                   "add the hard limit of the vehicles, or remove separation");
    return;
  }
  SeparationRules(scenario, checks).run();
}

}  // namespace ergocast
