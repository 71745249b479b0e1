// SPDX-License-Identifier: BSD-3-Clause
// Holds the kind of the vehicles against its limits, the domain and the separation.
#include "scenario/validate_vehicle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/separation.h"
#include "core/vehicle.h"
#include "scenario/convert.h"

namespace ergocast {
namespace {

class VehicleRules {
 public:
  VehicleRules(const proto::Scenario& scenario, Checks& checks)
      : scenario_(scenario), checks_(checks) {}

  void run() {
    const bool has_inertia = scenario_.vehicle().kind() == proto::Vehicle::ACCELERATION;
    limits(has_inertia);
    if (!has_inertia || !checks_.sound("vehicle") || !checks_.sound("world")) return;
    room_to_brake();
    if (scenario_.has_separation()) knowledge();
  }

 private:
  void limits(bool has_inertia) {
    const bool given = scenario_.vehicle().has_max_acceleration_mps2();
    if (has_inertia && !given) {
      checks_.missing("vehicle.max_acceleration_mps2", "is missing",
                      "add it, or write kind: POINT");
    } else if (given && !has_inertia) {
      checks_.problem("vehicle.max_acceleration_mps2", "has no effect with kind: POINT",
                      "remove it, or write kind: ACCELERATION");
    }
    if (has_inertia && !scenario_.world().has_speed_limit_mps()) {
      checks_.missing("world.speed_limit_mps", "is missing, and a way to brake depends on it",
                      "add the hard limit of the vehicles, or write kind: POINT");
    }
  }

  void room_to_brake() {
    const Mission mission = mission_of(scenario_);
    const double way_m = longest_braking_path_m(mission);
    const double most_m = mission.domain.shortest_side_m() / 4;
    if (way_m <= most_m) return;
    checks_.problem("vehicle.max_acceleration_mps2",
                    shortest(mission.vehicle.max_acceleration_mps2) + " stops a vehicle after " +
                        shortest(rounded_up(way_m)) +
                        " m, above the limit, a quarter of the domain's shorter side, " +
                        shortest(most_m),
                    "write more, or a smaller world.speed_limit_mps");
  }

  void knowledge() {
    if (sure_of_bodies(mission_of(scenario_))) return;
    checks_.problem(
        "separation",
        "allows errors, disturbances, late vehicles or commands that the world does not "
        "filter: no distance of vehicles with inertia is proven for that",
        "write disturbance_m, position_error_m and response_s: 0, and guard: true, or "
        "vehicle.kind: POINT");
  }

  const proto::Scenario& scenario_;
  Checks& checks_;
};

}  // namespace

void validate_vehicle(const proto::Scenario& scenario, Checks& checks) {
  const std::array parts = {"domain", "basis", "law",     "time",
                            "agents", "world", "vehicle", "separation"};
  if (!std::ranges::all_of(parts, [&](const char* part) { return checks.sound(part); })) return;
  VehicleRules(scenario, checks).run();
}

}  // namespace ergocast
