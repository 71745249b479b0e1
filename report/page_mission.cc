// SPDX-License-Identifier: BSD-3-Clause
// Selects the values of a mission that the page needs, with no more digits than it shows.
#include "report/page_mission.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/measure/detection.h"
#include "core/mission/half_life.h"
#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/home.h"
#include "core/motion/vehicle.h"
#include "report/base64.h"
#include "report/conventions.h"
#include "report/web_page.h"

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

template <class Values>
Json rounded_list(const Values& values, int digits = 6) {
  Json list = Json::array();
  for (const double value : values) list.push_back(page_number(value, digits));
  return list;
}

/// The end of the colour scale. 0.2 % of the cells are above it, so that one peak does not make all
/// other cells white. It is at least twice the uniform density.
Json encoded_density(const Field& density) {
  if (density.size() == 0) return nullptr;
  std::vector<double> cells(density.data(), density.data() + density.size());
  const auto at =
      cells.begin() + static_cast<std::ptrdiff_t>(0.998 * static_cast<double>(cells.size() - 1));
  std::nth_element(cells.begin(), at, cells.end());
  const double full = std::max(2.0, *at);
  std::string bytes;
  for (Eigen::Index j = density.cols(); j-- > 0;) {
    for (Eigen::Index i = 0; i < density.rows(); ++i) {
      const double level = density(i, j) > 0 ? std::min(density(i, j) / full, 1.0) : 0.0;
      // only a density of 0 becomes 0: no agent is wanted there
      bytes += static_cast<char>(level > 0 ? std::max(1L, std::lround(level * 255)) : 0);
    }
  }
  return {{"width", density.rows()},
          {"height", density.cols()},
          {"full", page_number(full)},
          {"data", base64(bytes)}};
}

/// How the page computes what is found, core/measure/detection.h.
Json sensor(const Mission& mission) {
  const Cells cells = measure_cells(mission);
  return {{"radius_m", sensor_radius_m(mission)},
          {"detections_per_s", mission.sensor.detections_per_s},
          {"cells", {cells.count.x(), cells.count.y(), cells.count.z()}},
          {"ticks_per_look", ticks_per_look(mission, cells)}};
}

/// The values that a position of each kind adds to the sums: quality and q g.
Json seen(const Mission& mission, const Sensors& sensors) {
  Json list = Json::array();
  for (std::size_t i = 0; i < mission.kinds.size(); ++i) {
    const Sensor& sensor = sensors.of(static_cast<int>(i));
    Coefficients share = Coefficients::Constant(mission.basis.mode_count(), sensor.quality);
    if (sensor.g.size() > 0) share = share.cwiseProduct(sensor.g);
    list.push_back({{"count", mission.kinds[i].count},
                    {"quality", sensor.quality},
                    {"qg", rounded_list(share)}});
  }
  return list;
}

/// How many agents of each kind there are, and which vehicles they are.
Json vehicles_of(const Mission& mission) {
  const auto name = [](VehicleKind kind) {
    switch (kind) {
      case VehicleKind::kAcceleration:
        return "ACCELERATION";
      case VehicleKind::kUnicycle:
        return "UNICYCLE";
      case VehicleKind::kFixedWing:
        return "FIXED_WING";
      case VehicleKind::kPoint:
        break;
    }
    return "POINT";
  };
  if (mission.kinds.empty())
    return {{{"count", mission.starts_m.size()}, {"vehicle", name(mission.vehicle.kind)}}};
  Json list = Json::array();
  for (std::size_t i = 0; i < mission.kinds.size(); ++i) {
    const Motion motion = motion_of_kind(mission, static_cast<int>(i));
    list.push_back({{"count", mission.kinds[i].count}, {"vehicle", name(motion.vehicle.kind)}});
  }
  return list;
}

double fastest_command_mps(const Mission& mission) {
  double fastest_mps = mission.kinds.empty() ? mission.law.u_max_mps : 0;
  for (const AgentKind& kind : mission.kinds) fastest_mps = std::max(fastest_mps, kind.u_max_mps);
  return fastest_mps;
}

/// The walls' corners, relative to the domain's corner.
Json rings_of(const Mission& mission) {
  Json rings = Json::array();
  for (const Ring& ring : mission.walls) {
    Json corners = Json::array();
    for (const Eigen::Vector2d& corner_m : ring)
      corners.push_back(rounded_list(corner_m - mission.domain.origin_m.head<2>(), 9));
    rings.push_back(std::move(corners));
  }
  return rings;
}

/// The agents' stations at the end, and the ticks from which they rest there.
Json stations_of(const Mission& mission) {
  Json list = Json::array();
  const int axes = mission.domain.planar() ? 2 : 3;
  for (std::size_t i = 0; i < mission.starts_m.size(); ++i) {
    const auto id = static_cast<AgentId>(i);
    const auto station_m = station_of(mission, id);
    if (!station_m) continue;
    list.push_back({{"id", id},
                    {"at_m", rounded_list((*station_m - mission.domain.origin_m).head(axes), 9)},
                    {"rest_from", rest_from(mission, id)}});
    if (battery_of(mission, id) == nullptr) continue;
    list.back()["battery"] = true;
    // Without velocities the page cannot see where a fixed wing circles.
    if (motion_of(mission, id).vehicle.kind == VehicleKind::kFixedWing) continue;
    list.back()["charges"] = {{"within_m", home_m(mission, id)},
                              {"below_mps", home_speed_mps(mission, id) / 2}};
  }
  return list;
}

}  // namespace

bool any_that_turn(const Mission& mission) {
  const auto turns = [](const VehicleLimits& vehicle) {
    return vehicle.kind == VehicleKind::kUnicycle || vehicle.kind == VehicleKind::kFixedWing;
  };
  const auto kind_turns = [&](const AgentKind& kind) {
    return turns(kind.vehicle.value_or(mission.vehicle));
  };
  return mission.kinds.empty() ? turns(mission.vehicle)
                               : std::ranges::any_of(mission.kinds, kind_turns);
}

std::string title_of(const Mission& mission) {
  return mission.name.empty() ? "unnamed mission" : mission.name;
}

Json page_mission(const Mission& flown, const Field& density) {
  // The page computes only cosines; it has no table of other modes.
  const Mission mission = in_cosines(flown);
  const Basis& basis = mission.basis;
  const Box& domain = mission.domain;
  const int axes = domain.planar() ? 2 : 3;
  Json modes = {basis.modes_x, basis.modes_y};
  if (axes == 3) modes.push_back(basis.modes_z);
  Json page = {{"name", title_of(mission)},
               {"seed", std::to_string(mission.seed)},
               {"origin_m", rounded_list(domain.origin_m.head(axes), 12)},
               {"size_m", rounded_list(domain.size_m.head(axes), 12)},
               {"modes", std::move(modes)},
               {"target", rounded_list(mission.target_coefficients)},
               {"weights", rounded_list(sobolev_weights(basis, domain))},
               {"dt_s", mission.timing.dt_s},
               {"tick_count", mission.timing.tick_count},
               {"agents", mission.starts_m.size()},
               {"u_max_mps", page_number(fastest_command_mps(mission))},
               {"radio_range_m", mission.radio_range_m},
               {"goal", mission.goal_ergodic_metric},
               {"sensor", sensor(mission)},
               {"free_domain", flown.basis.free_domain},
               {"conventions", conventions(mission, flown.basis.free_domain)},
               {"density", encoded_density(density)}};
  if (const Sensors sensors(mission); !sensors.uniform()) page["seen"] = seen(mission, sensors);
  if (any_but_points(mission)) page["vehicles"] = vehicles_of(mission);
  if (!mission.walls.empty()) page["walls"] = rings_of(mission);
  if (keeps_distance(mission)) page["body_radius_m"] = mission.separation.distance_m / 2;
  if (any_station(mission)) page["stations"] = stations_of(mission);
  if (const int objects = mission.objects.total(); objects > 0) page["objects"] = objects;
  if (const HalfLife half_life(mission); half_life.any())
    page["half_life_ticks"] = half_life.ticks();
  if (mission.law.history == TargetHistory::kKeep) page["keeps_history"] = true;
  return page;
}

Json page_amendments(std::span<const Amendment> list, std::span<const LawChange> laws,
                     std::span<const SearchNote> notes, const Mission& mission) {
  Json json = Json::array();
  for (const Amendment& one : list) {
    Json entry = {{"number", one.number}, {"kind", to_string(one.kind)}, {"from", one.from}};
    if (one.kind == AmendmentKind::kTarget) entry["hash"] = page_target_name(one.hash);
    if (one.kind == AmendmentKind::kEnd) entry["tick_count"] = one.hash;
    if (one.kind == AmendmentKind::kReopen) entry["zone"] = one.hash;
    const auto law = std::ranges::find(laws, one.number, &LawChange::number);
    if (law != laws.end()) entry["law"] = law_text(*law, mission);
    const auto note = std::ranges::find(notes, one.number, &SearchNote::number);
    if (note != notes.end()) entry["text"] = to_text(*note);
    if (!one.by.empty()) entry["by"] = one.by;
    json.push_back(std::move(entry));
  }
  return json;
}

Json page_zones(std::span<const Zone> zones, const Box& domain) {
  Json list = Json::array();
  for (const Zone& zone : zones) {
    Json corners = Json::array();
    for (const Eigen::Vector2d& corner_m : zone.corners_m)
      corners.push_back(rounded_list(corner_m - domain.origin_m.head<2>(), 9));
    list.push_back({{"number", zone.number},
                    {"closed", zone.closed},
                    {"from", zone.from},
                    {"until", zone.end()},
                    {"corners_m", std::move(corners)}});
    if (!domain.planar())
      list.back()["heights_m"] = {zone.low_m - domain.origin_m.z(),
                                  zone.high_m - domain.origin_m.z()};
  }
  return list;
}

std::string page_target_name(std::uint64_t hash) { return to_hex(hash); }

Json page_target(const TargetChange& change) { return rounded_list(change.in_cosines()); }

}  // namespace ergocast
