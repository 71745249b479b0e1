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
    const proto::Vehicle& vehicle = scenario_.vehicle();
    const bool has_inertia = kind_ == proto::Vehicle::ACCELERATION;
    const bool has_wings = kind_ == proto::Vehicle::FIXED_WING;
    limit("max_acceleration_mps2", has_inertia, vehicle.has_max_acceleration_mps2());
    limit("max_turn_radps", turns(), vehicle.has_max_turn_radps());
    limit("min_speed_mps", has_wings, vehicle.has_min_speed_mps());
    if (kind_ == proto::Vehicle::POINT) return;
    if (!scenario_.world().has_speed_limit_mps()) {
      checks_.missing("world.speed_limit_mps", "is missing, and all kinds but POINT rely on it",
                      "add the hard limit of the vehicles, or write kind: POINT");
    }
    if (turns() && scenario_.domain().has_size_z_m()) {
      checks_.problem("vehicle.kind", word() + " belongs to a plane, and the domain is a box",
                      "remove domain.size_z_m, or write kind: ACCELERATION");
    }
    if (!checks_.sound("vehicle") || !checks_.sound("world")) return;
    if (has_inertia) room_to_brake();
    if (has_wings) wings();
    if (scenario_.has_separation()) knowledge();
  }

 private:
  std::string word() const { return proto::Vehicle::Kind_Name(kind_); }
  bool turns() const {
    return kind_ == proto::Vehicle::UNICYCLE || kind_ == proto::Vehicle::FIXED_WING;
  }

  void limit(const std::string& name, bool needed, bool given) {
    if (needed && !given) {
      checks_.missing("vehicle." + name, "is missing", "add it, or write kind: POINT");
    } else if (given && !needed) {
      checks_.problem("vehicle." + name, "has no effect with kind: " + word(),
                      "remove it, or write another kind");
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

  void wings() {
    const Mission mission = mission_of(scenario_);
    const double speed_mps = mission.vehicle.min_speed_mps;
    const double limit_mps = std::min(mission.speed_limit_mps, mission.law.u_max_mps);
    if (speed_mps >= limit_mps) {
      checks_.problem("vehicle.min_speed_mps",
                      shortest(speed_mps) +
                          " is not below law.u_max_mps and world.speed_limit_mps, " +
                          shortest(limit_mps),
                      "write less");
    }
    const double radius_m = loiter_radius_m(mission);
    const double most_m = mission.domain.shortest_side_m() / 4;
    if (radius_m > most_m) {
      checks_.problem(
          "vehicle.max_turn_radps",
          shortest(mission.vehicle.max_turn_radps) +
              " turns a vehicle on a circle with a radius of " + shortest(rounded_up(radius_m)) +
              " m, above the limit, a quarter of the domain's shorter side, " + shortest(most_m),
          "write more, or a smaller vehicle.min_speed_mps");
      return;
    }
    const Box room = room_to_begin(mission);
    for (std::size_t i = 0; i < mission.starts_m.size(); ++i) {
      if (room.contains(mission.starts_m[i])) continue;
      checks_.problem(indexed("agents.starts", static_cast<int>(i)),
                      "is nearer to an edge than the radius of a turning circle, " +
                          shortest(rounded_up(radius_m)) + " m",
                      "move it inside");
    }
  }

  void knowledge() {
    if (sure_of_bodies(mission_of(scenario_))) return;
    checks_.problem(
        "separation",
        "allows errors, disturbances, late vehicles or commands that the world does not "
        "filter: no distance is proven for that, but of points",
        "write disturbance_m, position_error_m and response_s: 0, and guard: true, or "
        "vehicle.kind: POINT");
  }

  const proto::Scenario& scenario_;
  Checks& checks_;
  proto::Vehicle::Kind kind_ = scenario_.vehicle().kind();
};

}  // namespace

void validate_vehicle(const proto::Scenario& scenario, Checks& checks) {
  const std::array parts = {"domain", "basis", "law",     "time",
                            "agents", "world", "vehicle", "separation"};
  if (!std::ranges::all_of(parts, [&](const char* part) { return checks.sound(part); })) return;
  VehicleRules(scenario, checks).run();
}

}  // namespace ergocast
