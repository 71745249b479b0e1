// SPDX-License-Identifier: BSD-3-Clause
// Checks the vehicles of each kind against their limits, the domain and the separation.
#include "scenario/rules/validate_vehicle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/mission/kinds.h"
#include "core/motion/filter_rules.h"
#include "core/motion/vehicle.h"
#include "scenario/parse/convert.h"

namespace ergocast {
namespace {

/// The limits that a vehicle needs, and no others.
class LimitRules {
 public:
  LimitRules(const proto::Vehicle& vehicle, std::string path, Checks& checks)
      : vehicle_(vehicle), path_(std::move(path)), checks_(checks) {}

  void run(bool planar) {
    const proto::Vehicle::Kind kind = vehicle_.kind();
    const bool has_wings = kind == proto::Vehicle::FIXED_WING;
    const bool turns = has_wings || kind == proto::Vehicle::UNICYCLE;
    limit("max_acceleration_mps2", kind == proto::Vehicle::ACCELERATION,
          vehicle_.has_max_acceleration_mps2());
    limit("max_turn_radps", turns, vehicle_.has_max_turn_radps());
    limit("min_speed_mps", has_wings, vehicle_.has_min_speed_mps());
    if (turns && !planar) {
      checks_.problem(path_ + ".kind", word() + " belongs to a plane, and the domain is a box",
                      "remove domain.size_z_m, or write kind: ACCELERATION");
    }
  }

 private:
  std::string word() const { return proto::Vehicle::Kind_Name(vehicle_.kind()); }

  void limit(const std::string& name, bool needed, bool given) {
    if (needed && !given) {
      checks_.missing(path_ + "." + name, "is missing", "add it, or write kind: POINT");
    } else if (given && !needed) {
      checks_.problem(path_ + "." + name, "has no effect with kind: " + word(),
                      "remove it, or write another kind");
    }
  }

  const proto::Vehicle& vehicle_;
  std::string path_;
  Checks& checks_;
};

/// How the agents of one kind, or all of a team without kinds, move in the domain.
class MotionRules {
 public:
  /// @param kind  the kind's number; −1: the team has no kinds
  MotionRules(const proto::Scenario& scenario, const Mission& mission, int kind, Checks& checks)
      : mission_(mission),
        kind_(kind),
        motion_(motion_of_kind(mission, kind)),
        checks_(checks),
        of_kind_(kind < 0 ? "" : indexed("agents.kind", kind) + ".") {
    const bool own_vehicle = kind >= 0 && scenario.agents().kind(kind).has_vehicle();
    const bool own_limit = kind >= 0 && scenario.agents().kind(kind).has_speed_limit_mps();
    const bool own_speed = kind >= 0 && mission.kinds[at()].u_max_mps != mission.law.u_max_mps;
    vehicle_ = (own_vehicle ? of_kind_ : "") + "vehicle.";
    limit_ = own_limit ? of_kind_ + "speed_limit_mps" : "world.speed_limit_mps";
    u_max_ = own_speed ? of_kind_ + "u_max_mps" : "law.u_max_mps";
  }

  void run() {
    if (motion_.is_point()) return;
    if (motion_.speed_limit_mps == 0) {
      checks_.missing("world.speed_limit_mps", "is missing, and all kinds but POINT rely on it",
                      "add the hard limit of the vehicles, or write kind: POINT");
      return;
    }
    if (motion_.has_inertia()) room_to_brake();
    if (loiter_radius_m(motion_) > 0) wings();
  }

 private:
  std::size_t at() const { return static_cast<std::size_t>(kind_); }
  double most_m() const { return mission_.domain.shortest_side_m() / 4; }

  void room_to_brake() {
    const double way_m = longest_braking_path_m(motion_);
    if (way_m <= most_m()) return;
    checks_.problem(vehicle_ + "max_acceleration_mps2",
                    shortest(motion_.vehicle.max_acceleration_mps2) + " stops a vehicle after " +
                        shortest(rounded_up(way_m)) +
                        " m, above the limit, a quarter of the domain's shorter side, " +
                        shortest(most_m()),
                    "write more, or a smaller " + limit_);
  }

  void wings() {
    const double speed_mps = motion_.vehicle.min_speed_mps;
    const double limit_mps = std::min(motion_.speed_limit_mps, law_of(mission_, kind_).u_max_mps);
    if (speed_mps >= limit_mps) {
      checks_.problem(vehicle_ + "min_speed_mps",
                      shortest(speed_mps) + " is not below " + u_max_ + " and " + limit_ + ", " +
                          shortest(limit_mps),
                      "write less");
    }
    const double radius_m = loiter_radius_m(motion_);
    if (radius_m > most_m()) {
      checks_.problem(
          vehicle_ + "max_turn_radps",
          shortest(motion_.vehicle.max_turn_radps) +
              " turns a vehicle on a circle with a radius of " + shortest(rounded_up(radius_m)) +
              " m, above the limit, a quarter of the domain's shorter side, " + shortest(most_m()),
          "write more, or a smaller " + vehicle_ + "min_speed_mps");
      return;
    }
    starts(radius_m);
  }

  void starts(double radius_m) {
    const Box room = room_to_begin(motion_);
    for (AgentId id = 0; id < std::ssize(mission_.starts_m); ++id) {
      const bool its = kind_ < 0 || planned_kind(mission_, id) == kind_;
      if (!its || room.contains(mission_.starts_m[static_cast<std::size_t>(id)])) continue;
      checks_.problem(indexed("agents.starts", id),
                      "is nearer to an edge than the radius of a turning circle, " +
                          shortest(rounded_up(radius_m)) + " m",
                      "move it inside");
    }
  }

  const Mission& mission_;
  int kind_;
  Motion motion_;
  Checks& checks_;
  std::string of_kind_, vehicle_, limit_, u_max_;  // paths
};

void validate_knowledge(const Mission& mission, Checks& checks) {
  if (!any_but_points(mission) || sure_of_bodies(mission)) return;
  checks.problem("separation",
                 "allows errors, disturbances, late vehicles or commands that the world does not "
                 "filter: with these, a distance is proven only for points",
                 "write disturbance_m, position_error_m and response_s: 0, and guard: true, or "
                 "vehicle.kind: POINT");
}

}  // namespace

void validate_vehicle(const proto::Scenario& scenario, Checks& checks) {
  const std::array parts = {"domain", "basis", "law",     "time",
                            "agents", "world", "vehicle", "separation"};
  const auto sound = [&] {
    return std::ranges::all_of(parts, [&](const char* part) { return checks.sound(part); });
  };
  if (!sound()) return;
  const bool planar = !scenario.domain().has_size_z_m();
  const auto& kinds = scenario.agents().kind();
  if (scenario.has_vehicle()) LimitRules(scenario.vehicle(), "vehicle", checks).run(planar);
  for (int kind = 0; kind < kinds.size(); ++kind) {
    if (!kinds[kind].has_vehicle()) continue;
    LimitRules(kinds[kind].vehicle(), indexed("agents.kind", kind) + ".vehicle", checks)
        .run(planar);
  }
  if (!sound()) return;
  const Mission mission = mission_of(scenario);
  for (int kind = kinds.empty() ? -1 : 0; kind < kinds.size(); ++kind)
    MotionRules(scenario, mission, kind, checks).run();
  if (scenario.has_separation() && sound()) validate_knowledge(mission, checks);
}

}  // namespace ergocast
