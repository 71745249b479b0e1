// SPDX-License-Identifier: BSD-3-Clause
// Selects the values of mission and record that the page needs, with no more digits than it shows.
#include "report/page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/measure/detection.h"
#include "core/mission/end_schedule.h"
#include "core/mission/half_life.h"
#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/vehicle.h"
#include "core/motion/way_home.h"
#include "report/base64.h"
#include "report/markup.h"
#include "report/track_grid.h"
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

std::string point_text(const Eigen::Vector2d& x_m) {
  const auto tenth = [](double value) { return readable(std::round(value * 10) / 10); };
  return '(' + tenth(x_m.x()) + ", " + tenth(x_m.y()) + ')';
}

std::string law_text(const ControlLaw& law) {
  const bool relative = law.regularization == Regularization::kRelative;
  std::string text = "u_max = " + readable(law.u_max_mps) + " m/s";
  text += ", ε = " + readable(law.epsilon) + (relative ? " × the residual gradient’s RMS" : "");
  text += ", σ = " + readable(law.noise_intensity);
  if (law.perturbation == Perturbation::kAdaptive) text += " to " + readable(law.noise_ceiling);
  text += " m/√s";
  text += ", k = " + readable(law.contraction_gain_per_s) + " /s";
  if (law.memory_half_life_s > 0)
    text += ", half-life of coverage " + readable(law.memory_half_life_s) + " s";
  if (law.history == TargetHistory::kKeep) text += ", all time counts against the present target";
  if (law.contraction_gain_per_s == 0) return text;
  return text + " towards " + point_text(law.contraction_center_m.head<2>()) + " m";
}

std::string vehicle_text(const VehicleLimits& vehicle) {
  const std::string turn = "turn by at most " + readable(vehicle.max_turn_radps) + " rad/s";
  switch (vehicle.kind) {
    case VehicleKind::kAcceleration:
      return "accelerate by at most " + readable(vehicle.max_acceleration_mps2) + " m/s²";
    case VehicleKind::kUnicycle:
      return turn + ", also on the spot";
    case VehicleKind::kFixedWing:
      return turn + ", and fly at " + readable(vehicle.min_speed_mps) + " m/s or faster";
    case VehicleKind::kPoint:
      break;
  }
  return "take every velocity at once";
}

std::string kind_text(const AgentKind& kind) {
  std::string text = kind.name + ": " + std::to_string(kind.count) +
                     (kind.count == 1 ? " agent" : " agents") +
                     ", u_max = " + readable(kind.u_max_mps) + " m/s";
  if (kind.footprint_sigma_m > 0)
    text += ", sees a Gaussian of " + readable(kind.footprint_sigma_m) + " m";
  if (kind.quality != 1) text += ", quality " + readable(kind.quality);
  if (kind.band_from > 0 || kind.band_to > 0) {
    text += ", steers by |k| from " + readable(kind.band_from);
    if (kind.band_to > 0) text += " to " + readable(kind.band_to);
  }
  if (kind.speed_limit_mps > 0) text += ", limited to " + readable(kind.speed_limit_mps) + " m/s";
  if (kind.vehicle) text += ", vehicles that " + vehicle_text(*kind.vehicle);
  return text;
}

std::string weights_text(const Basis& basis) {
  const bool squared = basis.sobolev_form == SobolevForm::kSquaredNorm;
  return std::string("λₖ = (1 + |k|") + (squared ? "²" : "") + ")^−" +
         readable(basis.sobolev_exponent) + ", |k|² = m² + n²" + (basis.planar() ? "" : " + l²");
}

/// The values that determine φ² and the page's drawing, for a mission in cosines.
Json conventions(const Mission& mission, bool free_domain) {
  const Basis& basis = mission.basis;
  Json list = Json::array();
  const auto add = [&list](const char* name, const std::string& text) {
    list.push_back(Json::array({name, text}));
  };
  if (!mission.domain.planar()) {
    add("view",
        "slices show the sum of the modes in their plane; xy, xz and yz are averages along the "
        "third axis");
  }
  if (free_domain) {
    add("free domain",
        "agents steer by the modes of the domain without its walls, and φ² over time is of these: "
        "λₖ = (1 + νₖ L²/π²)^−s, mean fₖ² = ¼; maps and what follows are of cosines");
  }
  add("metric", std::string("φ² = Σ λₖ (cₖ − μₖ)²") + (basis.normalized ? " / hₖ²" : ""));
  add("weights", weights_text(basis));
  add("basis",
      "f = cos(mπx/Lx) cos(nπy/Ly) from the domain’s lower left corner, m = 0 … " +
          std::to_string(basis.modes_x - 1) + ", n = 0 … " + std::to_string(basis.modes_y - 1) +
          (basis.planar() ? ""
                          : "; times cos(lπz/Lz), l = 0 … " + std::to_string(basis.modes_z - 1)));
  add("hₖ", basis.normalized ? "√(Π Lᵢ · (½)^[kᵢ > 0])" : "not used: f is not normalised");
  add("control", law_text(mission.law));
  for (const AgentKind& kind : mission.kinds) add("kind", kind_text(kind));
  if (!Sensors(mission).uniform())
    add("seen", "coverage and φ² are of what the agents’ sensors have seen, weighted by quality");
  if (HalfLife(mission).any())
    add("memory", "coverage and φ² are of what is remembered: halved once in each half-life");
  if (mission.speed_limit_mps > 0) {
    add("speed limit", readable(mission.speed_limit_mps) + " m/s; faster commands are cut to it");
  }
  const bool all_have_own = std::ranges::all_of(
      mission.kinds, [](const AgentKind& kind) { return kind.vehicle.has_value(); });
  if (mission.kinds.empty() || !all_have_own) add("vehicles", vehicle_text(mission.vehicle));
  if (keeps_distance(mission)) {
    add("distance", readable(mission.separation.distance_m) + " m between any two bodies");
  }
  add("sensor", "finds an object within " + readable(sensor_radius_m(mission)) + " m at the rate " +
                    readable(mission.sensor.detections_per_s) + " /s, through walls");
  add("time step", readable(mission.timing.dt_s) + " s");
  add("maps", "Σ cₖ fₖ with f of unit norm, in multiples of the uniform density");
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

/// All rows of a short mission; the first and then every few rows of a long one.
Json metrics(const RunData& run) {
  constexpr std::size_t kFirst = 500, kMost = 4000;
  const std::size_t every = run.metrics.size() / kMost + 1;
  Json t = Json::array(), phi = Json::array(), found = Json::array(), spread = Json::array(),
       age = Json::array(), received = Json::array(), lost = Json::array();
  for (std::size_t i = 0; i < run.metrics.size(); ++i) {
    if (i > kFirst && i % every != 0 && i + 1 != run.metrics.size()) continue;
    const MetricsRow& row = run.metrics[i];
    t.push_back(page_number(row.t_s, 9));
    phi.push_back(page_number(row.ergodic_metric));
    found.push_back(page_number(row.detection_probability));
    spread.push_back(page_number(row.spread, 3));
    age.push_back(page_number(row.max_staleness_s, 4));
    received.push_back(row.received);
    lost.push_back(row.lost);
  }
  return {{"t", std::move(t)},           {"phi", std::move(phi)}, {"found", std::move(found)},
          {"spread", std::move(spread)}, {"age", std::move(age)}, {"received", std::move(received)},
          {"lost", std::move(lost)}};
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
  }
  return list;
}

/// The first tick at which the track's positions send the agent home; nullopt if there is none.
std::optional<Tick> home_from(const RunData& run, const Mission& mission, AgentId id,
                              const Track& track) {
  WayHome way(mission, id);
  const EndSchedule ends(mission, run.holds(), run.amendments.ends());
  std::optional<Tick> since;
  for (const TrackPoint& at : track) {
    if (is_held(run.holds(), at.tick)) continue;
    const Tick counted = counted_ticks(run.holds(), at.tick);
    way.set_rest(ends.rest_from(mission, id, counted));
    const bool goes = way.begun(counted, at.x_m);
    if (!goes) since.reset();  // a later end was named
    if (goes && !since) since = at.tick;
  }
  return since;
}

Json homes_from(const RunData& run, const Mission& mission) {
  Json list = Json::object();
  for (const auto& [id, track] : run.tracks) {
    if (!station_of(mission, id)) continue;
    if (const auto tick = home_from(run, mission, id, track)) list[std::to_string(id)] = *tick;
  }
  return list;
}

/// The amendments of the record, and the targets that it has.
void add_amendments(const ReceivedAmendments& heard, const Mission& mission, Json& record) {
  if (heard.empty()) return;
  std::vector<Amendment> list;
  std::vector<Zone> zones;
  std::vector<LawChange> laws;
  Json targets = Json::object();
  for (const ReceivedAmendment& one : heard.all()) {
    if (one.is_void) continue;
    list.push_back(one.amendment);
    if (one.target) targets[page_target_name(one.amendment.hash)] = page_target(*one.target);
    if (one.zone) zones.push_back(*one.zone);
    if (one.law) laws.push_back(*one.law);
  }
  record["amendments"] = page_amendments(list, laws, mission);
  record["targets"] = std::move(targets);
  if (!zones.empty()) record["zones"] = page_zones(zones, mission.domain);
}

/// The agents that stand in the last state that the record has of them.
Json standing_at_the_end(const RunData& run, const Mission& mission) {
  Json list = Json::array();
  for (const auto& [agent, track] : run.tracks)
    if (stands(motion_of(mission, agent), track.back().v_mps)) list.push_back(agent);
  return list;
}

/// The command of a vehicle that turns is its velocity at the tick's end.
void put(TrackGrid& grid, AgentId agent, const Track& track) {
  const TrackPoint* before = nullptr;
  for (const TrackPoint& point : track) {
    const bool follows = before != nullptr && before->tick + 1 == point.tick;
    grid.put(agent, point.tick, point.x_m, follows ? before->v_mps : point.v_mps);
    before = &point;
  }
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
                     const Mission& mission) {
  Json json = Json::array();
  for (const Amendment& one : list) {
    Json entry = {{"number", one.number}, {"kind", to_string(one.kind)}, {"from", one.from}};
    if (one.kind == AmendmentKind::kTarget) entry["hash"] = page_target_name(one.hash);
    if (one.kind == AmendmentKind::kEnd) entry["tick_count"] = one.hash;
    if (one.kind == AmendmentKind::kReopen) entry["zone"] = one.hash;
    const auto law = std::ranges::find(laws, one.number, &LawChange::number);
    if (law != laws.end()) entry["law"] = law_text(*law, mission);
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

Json page_record(const RunData& run, const Mission& mission, const Json& summary,
                 const Field& density, const Json& team) {
  Tick ticks = 0;
  for (const auto& [agent, track] : run.tracks) ticks = std::max(ticks, track.back().tick + 1);
  TrackGrid grid(mission.domain, run.tracks.size(), any_that_turn(mission));
  for (const auto& [agent, track] : run.tracks) put(grid, agent, track);
  const auto law = fit_last_decade(run);
  Json record = {{"mission", page_mission(mission, density)},
                 {"summary", summary},
                 {"metrics", metrics(run)},
                 {"slope", law ? page_number(law->slope, 3) : Json(nullptr)},
                 {"ticks", ticks},
                 {"stride", grid.stride()},
                 {"rows", grid.rows()},
                 {"tracks", grid.encode(0, grid.rows())},
                 {"standing", standing_at_the_end(run, mission)},
                 {"team", team}};
  if (team.is_null() && any_station(mission)) record["home_from"] = homes_from(run, mission);
  add_amendments(run.amendments, mission, record);
  return record;
}

std::string report_page(const RunData& run, const Mission& mission, const Json& summary,
                        const Field& density, const Json& team) {
  return html_file(run_web_page(), title_of(mission),
                   {{"record", page_record(run, mission, summary, density, team)}});
}

}  // namespace ergocast
