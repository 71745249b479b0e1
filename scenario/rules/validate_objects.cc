// SPDX-License-Identifier: BSD-3-Clause
// Checks the objects of the simulated world, and the sensors that find them.
#include "scenario/rules/validate_objects.h"

#include <algorithm>

#include "core/measure/detection.h"
#include "core/measure/drift.h"
#include "core/motion/walls.h"
#include "scenario/parse/convert.h"
#include "text/shortest.h"

namespace ergocast {
namespace {

void validate_places(const proto::Scenario& scenario, Checks& checks) {
  const proto::Objects& objects = scenario.world().objects();
  if (objects.places_size() > kMaxObjects) {
    checks.problem("world.objects",
                   std::to_string(objects.places_size()) + " objects are above the limit " +
                       std::to_string(kMaxObjects),
                   "leave out " + std::to_string(objects.places_size() - kMaxObjects));
  }
  if (!checks.sound("domain")) return;
  const Box domain = domain_of(scenario.domain());
  const bool walls_known = checks.sound("world.walls") && checks.sound("target.keep_outs");
  const IndexedRings walls = walls_known ? mission_of(scenario).walls : IndexedRings();
  for (int i = 0; i < objects.places_size(); ++i) {
    const std::string path = indexed("world.objects.places", i);
    if (!checks.sound(path)) continue;
    const Eigen::Vector3d x_m(objects.places(i).x_m(), objects.places(i).y_m(), 0);
    if (!domain.contains(x_m)) {
      checks.problem(path, "is outside the domain", "move it inside");
    } else if (solid_at(walls, x_m.head<2>())) {
      checks.problem(path, "is in a wall", "move it away");
    }
  }
}

void validate_end(const proto::Scenario& scenario, Checks& checks) {
  const proto::Objects& objects = scenario.world().objects();
  if (!objects.has_end_when_found()) return;
  const int total = objects.places_size() > 0 ? objects.places_size() : objects.count();
  if (total > 0 && objects.end_when_found() > total) {
    checks.problem("world.objects.end_when_found",
                   std::to_string(objects.end_when_found()) + " is above the number of objects, " +
                       std::to_string(total),
                   "write at most " + std::to_string(total));
  }
  const auto& kinds = scenario.agents().kind();
  if (std::ranges::any_of(kinds, [](const auto& kind) { return kind.station_size() > 0; })) {
    checks.problem("world.objects.end_when_found",
                   "the agents would have no time to go to their stations",
                   "remove it, or the stations of the kinds");
  }
}

/// Drifting objects have room for a step, and not too many legs (core/measure/drift.h).
void validate_motion(const proto::Scenario& scenario, Checks& checks) {
  const proto::Objects& objects = scenario.world().objects();
  if (!objects.has_motion() || !checks.sound("world.objects") || !checks.sound("domain") ||
      !checks.sound("time"))
    return;
  const Mission mission = mission_of(scenario);
  const double most_mps = max_drift_mps(mission.domain, mission.timing.dt_s);
  if (mission.objects.motion.speed_mps > most_mps) {
    checks.problem(
        "world.objects.motion.speed_mps",
        "objects would move by more than an eighth of the domain's shorter side in a "
        "step",
        "write at most " + shortest(rounded_down(most_mps)) + ", or a shorter time.dt_s");
  } else if (const std::int64_t legs = drift_legs(mission); legs > kMaxLegs) {
    checks.problem("world.objects.motion",
                   std::to_string(legs) + " legs of all objects are above the limit " +
                       std::to_string(kMaxLegs),
                   "write a longer persistence_s, a lower speed_mps, fewer objects or a shorter "
                   "time.duration_s");
  }
}

/// What false alarms need.
void validate_sensor(const proto::Scenario& scenario, Checks& checks) {
  if (!scenario.has_sensor() || !checks.sound("sensor") || !checks.sound("domain")) return;
  const proto::Sensor& sensor = scenario.sensor();
  Mission mission;
  mission.domain = domain_of(scenario.domain());
  mission.sensor.radius_m = sensor.radius_m();
  const double most_m = sensor_radius_m(mission) / 2;
  if (sensor.position_error_m() > most_m)
    checks.problem("sensor.position_error_m",
                   shortest(sensor.position_error_m()) + " m is above half of the sensor's radius",
                   "write at most " + shortest(rounded_down(most_m)));
  if (!(sensor.false_alarms_per_s() > 0)) return;
  if (scenario.domain().has_size_z_m())
    checks.problem("sensor.false_alarms_per_s",
                   "reports belong to a plane, and the domain is a box",
                   "remove it, or domain.size_z_m");
  if (scenario.world().objects().has_end_when_found())
    checks.problem("world.objects.end_when_found",
                   "with false alarms no agent knows at once whether an object is found",
                   "remove it, or sensor.false_alarms_per_s");
}

}  // namespace

void validate_objects(const proto::Scenario& scenario, Checks& checks) {
  validate_sensor(scenario, checks);
  if (!scenario.world().has_objects() || !checks.sound("world.objects")) return;
  const proto::Objects& objects = scenario.world().objects();
  if (scenario.domain().has_size_z_m()) {
    if (checks.sound("domain"))
      checks.problem("world.objects", "objects belong to a plane, and the domain is a box",
                     "remove them, or domain.size_z_m");
    return;
  }
  if (objects.has_count() && objects.places_size() > 0) {
    checks.problem("world.objects.count", "has no effect with places",
                   "remove it to place the objects, or the places to have them drawn");
  } else if (!objects.has_count() && objects.places_size() == 0) {
    checks.missing("world.objects", "there are none",
                   "add count: 1 to 32, or places { x_m: … y_m: … }");
  }
  validate_places(scenario, checks);
  validate_end(scenario, checks);
  validate_motion(scenario, checks);
}

}  // namespace ergocast
