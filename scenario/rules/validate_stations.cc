// SPDX-License-Identifier: BSD-3-Clause
// Checks stations against the domain, the walls, each other and the mission's time.
#include "scenario/rules/validate_stations.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/charge.h"
#include "core/motion/filter_rules.h"
#include "core/motion/home.h"
#include "core/motion/starts.h"
#include "core/motion/walls.h"
#include "core/motion/way_home.h"
#include "scenario/parse/convert.h"

namespace ergocast {
namespace {

/// The path of the station of agent `id`, or of its whole kind.
std::string station_path(const Mission& mission, AgentId id) {
  const int kind = planned_kind(mission, id);
  int place = id;
  for (int i = 0; i < kind; ++i) place -= mission.kinds[static_cast<std::size_t>(i)].count;
  const auto stations =
      static_cast<int>(mission.kinds[static_cast<std::size_t>(kind)].stations_m.size());
  return indexed(indexed("agents.kind", kind) + ".station", std::min(place, stations - 1));
}

class StationRules {
 public:
  StationRules(const proto::Scenario& scenario, Checks& checks)
      : scenario_(scenario), kinds_(scenario.agents().kind()), checks_(checks) {}

  void run() {
    for (int i = 0; i < kinds_.size(); ++i) {
      count(i);
      reserve(i);
      battery(i);
    }
    const std::array parts = {"domain", "basis", "law",     "time",
                              "agents", "world", "vehicle", "separation"};
    if (!std::ranges::all_of(parts, [&](const char* part) { return checks_.sound(part); })) return;
    const Mission mission = mission_of(scenario_);
    if (!any_station(mission)) return;
    for (AgentId id = 0; id < planned(); ++id) stay(mission, id);
    apart(mission);
  }

 private:
  int planned() const {
    return scenario_.agents().starts_size() + scenario_.agents().random_count();
  }

  void count(int i) {
    const std::string path = indexed("agents.kind", i);
    const int stations = kinds_[i].station_size(), agents = kinds_[i].count();
    if (stations <= 1 || stations == agents || !checks_.sound(path + ".count")) return;
    checks_.problem(indexed(path + ".station", 1),
                    "the kind has " + std::to_string(agents) + " agents and " +
                        std::to_string(stations) + " stations",
                    "write one station for each of its agents, or one for all");
  }

  void reserve(int i) {
    const std::string path = indexed("agents.kind", i) + ".reserve_s";
    if (!kinds_[i].has_reserve_s() || !checks_.sound(path)) return;
    if (kinds_[i].station_size() == 0) return without_station(path);
    const double duration_s = scenario_.time().duration_s();
    if (!checks_.sound("time") || kinds_[i].reserve_s() < duration_s) return;
    checks_.problem(path,
                    shortest(kinds_[i].reserve_s()) + " is no less than the mission's " +
                        shortest(duration_s) + " s: its agents would never cover anything",
                    "write less, or a longer time.duration_s");
  }

  void battery(int i) {
    if (!kinds_[i].has_battery() || kinds_[i].station_size() > 0) return;
    without_station(indexed("agents.kind", i) + ".battery");
  }

  void without_station(const std::string& path) {
    checks_.problem(path, "has no effect without a station",
                    "remove it, or add station { x_m: … y_m: … }");
  }

  void stay(const Mission& mission, AgentId id) {
    const auto home_m = station_of(mission, id);
    if (!home_m) return;
    const std::string path = station_path(mission, id);
    if (!checks_.sound(path)) return;
    const Box& domain = mission.domain;
    if (!domain.contains(*home_m)) {
      const Eigen::Vector3d high_m = domain.origin_m + domain.size_m;
      return checks_.problem(
          path, "is outside the domain",
          "write x " + shortest(domain.origin_m.x()) + " to " + shortest(high_m.x()) + ", y " +
              shortest(domain.origin_m.y()) + " to " + shortest(high_m.y()) +
              (domain.planar()
                   ? ""
                   : ", z " + shortest(domain.origin_m.z()) + " to " + shortest(high_m.z())));
    }
    const Motion motion = motion_of(mission, id);
    if (!room_to_begin(motion).contains(*home_m)) {
      return checks_.problem(path,
                             "is nearer to an edge than the radius of the circle that a fixed "
                             "wing flies there, " +
                                 shortest(rounded_up(loiter_radius_m(motion))) + " m",
                             "move it inside");
    }
    walls(mission, id, *home_m, path);
  }

  void walls(const Mission& mission, AgentId id, const Eigen::Vector3d& home_m,
             const std::string& path) {
    const double spare_m = spare_at_home_m(mission, id, home_m);
    if (spare_m >= 0) return;
    const double kept_m = kept_from_walls_m(mission, motion_of(mission, id));
    checks_.problem(path,
                    solid_at(mission.walls, home_m.head<2>())
                        ? std::string("is in a wall")
                        : "is " + shortest(rounded_down(std::max(0.0, spare_m + kept_m))) +
                              " m from a wall, nearer than the " + shortest(rounded_up(kept_m)) +
                              " m that the vehicle keeps",
                    "move it away");
  }

  void apart(const Mission& mission) {
    if (!keeps_distance(mission)) return;
    const auto pair = too_near_at_home(mission, planned());
    if (!pair || !checks_.sound(station_path(mission, pair->first)) ||
        !checks_.sound(station_path(mission, pair->second)))
      return;
    const auto [one, other] = *pair;
    const double apart_m = (*station_of(mission, one) - *station_of(mission, other)).norm();
    checks_.problem(station_path(mission, one),
                    "agents " + std::to_string(other) + " and " + std::to_string(one) +
                        " have stations " + shortest(rounded_down(apart_m)) +
                        " m apart, nearer than the distance at rest, " +
                        shortest(rounded_up(start_distance_m(mission, one, other))),
                    "move it away, and write one station for each agent");
  }

  const proto::Scenario& scenario_;
  const google::protobuf::RepeatedPtrField<proto::Kind>& kinds_;
  Checks& checks_;
};

}  // namespace

void validate_stations(const proto::Scenario& scenario, Checks& checks) {
  if (scenario.agents().kind_size() > 0) StationRules(scenario, checks).run();
}

void validate_ways_home(const Mission& mission, Checks& checks) {
  std::optional<WayHome> way;
  std::string way_path;
  for (AgentId id = 0; id < std::ssize(mission.starts_m); ++id) {
    const std::optional<Eigen::Vector3d> home_m = station_of(mission, id);
    if (!home_m || !checks.sound(station_path(mission, id))) continue;
    const std::string path = station_path(mission, id);
    // All agents of a kind with one station use the same table of ways.
    if (!way || path != way_path) way.emplace(mission, id);
    way_path = path;
    const double needed_s = way->needed_s(mission.starts_m[static_cast<std::size_t>(id)]);
    const double left_s = static_cast<double>(rest_from(mission, id)) * mission.timing.dt_s;
    if (std::isinf(needed_s)) {
      checks.problem(station_path(mission, id),
                     "cannot be reached from the start of agent " + std::to_string(id) +
                         ": no way that keeps the clearance from the walls leads there",
                     "move the station, or open a passage");
    } else if (needed_s >= left_s) {
      checks.problem(station_path(mission, id),
                     "is " + shortest(rounded_up(needed_s)) + " s away from the start of agent " +
                         std::to_string(id) +
                         ", and from there the mission without its reserve "
                         "is " +
                         shortest(rounded_down(left_s)) + " s",
                     "move the station nearer, write a smaller reserve_s or a longer "
                     "time.duration_s");
    } else if (const Battery* const battery = battery_of(mission, id);
               battery != nullptr && needed_s >= endurance_s(*battery)) {
      const std::string its = indexed("agents.kind", planned_kind(mission, id)) + ".battery";
      if (!checks.sound(its)) continue;
      checks.problem(its,
                     "lasts for " + shortest(rounded_down(endurance_s(*battery))) +
                         " s without its reserve, and from the start of agent " +
                         std::to_string(id) + " the station is " + shortest(rounded_up(needed_s)) +
                         " s away",
                     "write a greater capacity_wh, a smaller power_w or reserve, or move the "
                     "station nearer");
    }
  }
}

}  // namespace ergocast
