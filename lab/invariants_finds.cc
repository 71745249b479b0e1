// SPDX-License-Identifier: BSD-3-Clause
// Checks what sensors detect, and that the record has what the world's states have.
#include <algorithm>
#include <string>
#include <vector>

#include "core/measure/detection.h"
#include "core/mission/end_by_finding.h"
#include "core/mission/station.h"
#include "lab/invariants.h"

namespace ergocast::lab {

void Invariants::check_detections(double t_s, const WorldState& world) {
  worlds_.insert(world.header.incarnation);
  const double radius_m = objects_.places_m().empty() ? 0 : sensor_radius_m(mission_);
  objects_.move_to(world.header.tick);
  const std::vector<Eigen::Vector3d>& objects_m = objects_.places_m();
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    if (vehicle.reported_cell != kNoCell) reports_[vehicle.id].insert(world.header.tick);
    for (int object = 0; object < kMaxObjects; ++object) {
      if ((vehicle.detected >> object & 1) == 0) continue;
      detections_[object].emplace(world.header.tick, vehicle.id);
      const bool exists = object < std::ssize(objects_m);
      if (exists && (vehicle.position_m - objects_m[static_cast<std::size_t>(object)]).norm() <=
                        radius_m * (1 + 1e-9))
        continue;
      violate(t_s, Invariant::kDetectionsInReach, "vehicle " + std::to_string(vehicle.id),
              text("object ", object, " at tick ", world.header.tick));
    }
  }
}

/// Whether each vehicle was a member that covers at each tick, and each row is recorded.
bool Invariants::all_states_count(Tick excused) const {
  const bool steady = std::ranges::all_of(truth_.roster(), [](const RosterEntry& entry) {
    return entry.active_from == 0 && entry.active_until < 0 && !entry.recalled();
  });
  return steady && excused == 0 && truth_.holds().empty() && !any_station(mission_) &&
         mission_.timing.pace == Pace::kLockstep;
}

/// Each find is a detection. If all detections count, it is the first of its object. With false
/// alarms it is a detection or comes after one.
void Invariants::check_finds(double t_s, const Finds& finds, Tick excused) {
  const Tick ticks = ticks_of(mission_, &truth_.amendments());
  std::string wrong;
  std::map<int, std::pair<Tick, AgentId>> recorded;
  for (const Find& find : finds.list()) {
    recorded[find.object] = {find.tick, find.agent};
    const auto& known = detections_[find.object];
    const bool confirmed =
        mission_.sensor.has_false_alarms() && !known.empty() && known.begin()->first <= find.tick;
    if (!confirmed && !known.contains({find.tick, find.agent}))
      wrong = text("object ", find.object, " was not detected at tick ", find.tick);
  }
  for (const auto& [object, all] : detections_) {
    if (mission_.sensor.has_false_alarms() || !all_states_count(excused) || all.empty() ||
        all.begin()->first >= ticks)
      continue;
    const auto find = recorded.find(object);
    if (find == recorded.end() || find->second != *all.begin())
      wrong = text("object ", object, " was detected at tick ", all.begin()->first);
  }
  if (!wrong.empty()) violate(t_s, Invariant::kFindsAreRecorded, "the logger", wrong);
  check_end_by_finding(t_s, excused);
}

/// If all detections count, an end that is named by finding is named in time, and for a find. A
/// restarted world may not know at once what was found.
void Invariants::check_end_by_finding(double t_s, Tick excused) {
  const int wanted = mission_.objects.end_when_found;
  if (wanted == 0 || !all_states_count(excused)) return;
  std::vector<Tick> found;
  for (const auto& [object, all] : detections_)
    if (!all.empty()) found.push_back(all.begin()->first);
  std::ranges::sort(found);
  const Tick ticks = ticks_of(mission_, &truth_.amendments());
  const bool enough = std::ssize(found) >= wanted;
  const Tick last = enough ? found[static_cast<std::size_t>(wanted - 1)] : ticks;
  const bool named = std::ranges::find(truth_.amendments().recent, kByFinding, &Amendment::by) !=
                     truth_.amendments().recent.end();
  if (named && last >= ticks)
    violate(t_s, Invariant::kEndsOnceFound, "the coordinator",
            text("names an end, and ", found.size(), " objects are found"));
  if (worlds_.size() == 1 && last + 3 < ticks)
    violate(t_s, Invariant::kEndsOnceFound, "the coordinator",
            text("names no end at tick ", last, ", and the mission has ", ticks, " ticks"));
}

}  // namespace ergocast::lab
