// SPDX-License-Identifier: BSD-3-Clause
// Checks distance, speed, holding, disturbance, room and starts of a team against each other.
#include "scenario/rules/validate_separation.h"

#include <algorithm>
#include <array>

#include "core/motion/filter_rules.h"
#include "core/motion/starts.h"
#include "core/motion/vehicle.h"
#include "scenario/parse/convert.h"

namespace ergocast {
namespace {

class SeparationRules {
 public:
  SeparationRules(const proto::Scenario& scenario, Checks& checks)
      : scenario_(scenario), checks_(checks), mission_(mission_of(scenario)) {}

  void run() {
    const int team = scenario_.agents().starts_size() + scenario_.agents().random_count();
    distance();
    for (int kind = 0; kind < std::max(1, scenario_.agents().kind_size()); ++kind)
      disturbance(motion_of_kind(mission_, kind).speed_limit_mps * mission_.timing.dt_s);
    hold();
    lease(team);
    room(static_cast<std::size_t>(team));
    starts();
  }

 private:
  void distance() {
    const double most_m = mission_.domain.shortest_side_m() / 4;
    if (mission_.separation.distance_m <= most_m) return;
    checks_.problem("separation.distance_m",
                    shortest(mission_.separation.distance_m) +
                        " is above a quarter of the domain's shorter side, " + shortest(most_m),
                    "write at most " + shortest(rounded_down(most_m)));
  }

  void disturbance(double step_m) {
    const double limit_m = step_m / 4;
    if (mission_.separation.disturbance_m < limit_m || !checks_.sound("separation.disturbance_m"))
      return;
    checks_.problem("separation.disturbance_m",
                    shortest(rounded_up(mission_.separation.disturbance_m)) +
                        " is not below a quarter of a step, speed_limit_mps · dt_s / 4 = " +
                        shortest(rounded_down(limit_m)) + ": vehicles could not make up for it",
                    "write less, or a greater speed_limit_mps, or less disturbance_intensity");
  }

  void hold() {
    const double held_s =
        static_cast<double>(unguarded_hold_ticks(mission_)) * mission_.timing.dt_s;
    const double step_s = uses_beacons(mission_) ? mission_.timing.dt_s : 0;
    const double whole_s = mission_.separation.distance_m / (4 * fastest_mps(mission_));
    if (held_s <= whole_s * (1 + 1e-9)) return;
    const double most_s = whole_s - step_s;
    checks_.problem("time.command_hold_s",
                    shortest(mission_.timing.command_hold_s) +
                        " is too long without separation.guard: a vehicle may be anywhere within "
                        "distance_m, unless it is at most distance_m / (4 speed_limit_mps)" +
                        (step_s > 0 ? " - dt_s" : "") +
                        (most_s < 0 ? ", which is below 0" : " = " + shortest(rounded_up(most_s))),
                    most_s < 0 ? "write a greater distance_m, or a smaller dt_s or speed_limit_mps"
                               : "write at most " + shortest(rounded_down(most_s)) +
                                     (step_s > 0 ? "" : ", or guard: true"));
  }

  void lease(int team) {
    const double lease_s = mission_.separation.lease_s, dt_s = mission_.timing.dt_s;
    if (lease_s == 0) return;
    const Tick ticks = lease_ticks(mission_);
    if (ticks < kLeastLeaseTicks || ticks > kMostLeaseTicks) {
      lease_problem(shortest(lease_s) + " is not between " +
                        shortest(static_cast<double>(kLeastLeaseTicks) * dt_s) + " and " +
                        shortest(static_cast<double>(kMostLeaseTicks) * dt_s) +
                        ", 5 and 10000 steps of dt_s",
                    "write " + shortest(static_cast<double>(20) * dt_s));
    }
    if (mission_.separation.guard)
      lease_problem("means that no process knows all places, and guard that the world does",
                    "remove guard or lease_s");
    if (mission_.separation.disturbance_m > 0)
      lease_problem(
          "relies on bodies that stay where they stand, and disturbance_m lets them drift",
          "write world.disturbance_intensity: 0, or remove lease_s");
    if (mission_.radio_range_m > 0)
      lease_problem(
          "needs the beacons of all agents to reach all others, and world.radio_range_m prevents "
          "that",
          "remove one of them");
    if (team > kMostLeasedAgents)
      lease_problem("is for at most " + std::to_string(kMostLeasedAgents) + " agents, not " +
                        std::to_string(team),
                    "write fewer agents, or remove lease_s");
  }
  void lease_problem(const std::string& what, std::string remedy) {
    checks_.problem("separation.lease_s", what, std::move(remedy));
  }

  void room(std::size_t team) {
    const double share = packing(mission_, team);
    if (share <= kHopelessPacking) return;
    checks_.problem("separation.distance_m",
                    std::to_string(team) + " agents " + spacing_text(mission_, team) +
                        " m apart take up " + shortest(rounded_up(100 * share)) +
                        " % of the domain, above the limit 30 %: they would block each other",
                    "write a smaller distance, fewer agents or a larger domain");
  }

  void starts() {
    for (auto pair = too_near_at_start(mission_); pair;
         pair = too_near_at_start(mission_, pair->first + 1)) {
      const auto [id, other] = *pair;
      const std::array places_m = {mission_.starts_m[static_cast<std::size_t>(id)],
                                   mission_.starts_m[static_cast<std::size_t>(other)]};
      checks_.problem(indexed("agents.starts", id),
                      "is " + shortest(rounded_down(least_distance_m(places_m))) +
                          " m from starts[" + std::to_string(other) +
                          "], nearer than the distance at the start, " +
                          shortest(rounded_up(start_distance_m(mission_, id, other))),
                      "move it away");
    }
  }

  const proto::Scenario& scenario_;
  Checks& checks_;
  Mission mission_;
};

}  // namespace

std::string spacing_text(const Mission& mission, std::size_t bodies) {
  double least_m = start_distance_m(mission, 0, 0), most_m = least_m;
  for (AgentId id = 1; id < static_cast<AgentId>(bodies); ++id) {
    least_m = std::min(least_m, start_distance_m(mission, id, id));
    most_m = std::max(most_m, start_distance_m(mission, id, id));
  }
  return shortest(least_m) + (most_m > least_m ? " to " + shortest(most_m) : "");
}

void validate_separation(const proto::Scenario& scenario, Checks& checks) {
  // The rules use all of these blocks, so all of them must be valid.
  const std::array parts = {"domain", "basis", "law",     "time",
                            "agents", "world", "vehicle", "separation"};
  if (!std::ranges::all_of(parts, [&](const char* part) { return checks.sound(part); })) return;
  const auto& kinds = scenario.agents().kind();
  const bool limited =
      scenario.world().has_speed_limit_mps() ||
      (!kinds.empty() && std::ranges::all_of(kinds, &proto::Kind::has_speed_limit_mps));
  if (!limited) {
    checks.missing("world.speed_limit_mps", "is missing, and separation relies on it",
                   "add the hard limit of the vehicles, or remove separation");
    return;
  }
  SeparationRules(scenario, checks).run();
}

}  // namespace ergocast
