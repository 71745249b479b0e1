// SPDX-License-Identifier: BSD-3-Clause
// GeoJSON (RFC 7946): longitude before latitude, outlines counter-clockwise, holes clockwise.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

#include "core/base/rings.h"
#include "core/mission/end_schedule.h"
#include "core/mission/station.h"
#include "report/export/exports.h"

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

Json position_of(const LocalPlane& plane, const Eigen::Vector2d& x_m) {
  const GeoPlace place = plane.to_place(x_m);
  return Json::array({place.longitude_deg, place.latitude_deg});
}

Json feature(Json geometry, Json properties) {
  return {{"type", "Feature"},
          {"properties", std::move(properties)},
          {"geometry", std::move(geometry)}};
}

Json domain_feature(const LocalPlane& plane, const ExportRecord& record) {
  const Eigen::Vector2d low = record.mission.domain.origin_m.head<2>();
  const Eigen::Vector2d high = low + record.mission.domain.size_m.head<2>();
  Json ring = Json::array();
  for (const Eigen::Vector2d& corner :
       {low, Eigen::Vector2d(high.x(), low.y()), high, Eigen::Vector2d(low.x(), high.y()), low}) {
    ring.push_back(position_of(plane, corner));
  }
  Json properties = {{"kind", "domain"}, {"scenario", record.mission.name}};
  if (record.summary.is_object()) {
    for (const char* key : {"run_id", "result", "started", "seed", "ticks", "amendments"}) {
      if (record.summary.contains(key)) properties[key] = record.summary[key];
    }
  }
  return feature({{"type", "Polygon"}, {"coordinates", Json::array({ring})}}, properties);
}

/// Twice the area, below 0 if the corners go clockwise [m²].
double signed_area_m2(const Ring& ring) {
  double sum = 0;
  for_segments({ring}, [&sum](const Segment& edge) {
    sum += edge.from_m.x() * edge.to_m.y() - edge.to_m.x() * edge.from_m.y();
  });
  return sum;
}

Json ring_json(const LocalPlane& plane, Ring ring, bool is_hole) {
  if ((signed_area_m2(ring) < 0) != is_hole) std::reverse(ring.begin(), ring.end());
  ring.push_back(ring.front());
  Json places = Json::array();
  for (const Eigen::Vector2d& corner : ring) places.push_back(position_of(plane, corner));
  return places;
}

/// A polygon for each wall, with the rooms inside as its holes.
void add_walls(const LocalPlane& plane, const Rings& walls, Json& features) {
  const std::vector<int> depth = depths(walls);
  for (std::size_t outer = 0; outer < walls.size(); ++outer) {
    if (depth[outer] % 2 != 0) continue;
    Json rings = Json::array({ring_json(plane, walls[outer], false)});
    for (std::size_t room = 0; room < walls.size(); ++room) {
      const bool within =
          depth[room] == depth[outer] + 1 && contains(walls[outer], walls[room].front());
      if (within) rings.push_back(ring_json(plane, walls[room], true));
    }
    features.push_back(
        feature({{"type", "Polygon"}, {"coordinates", std::move(rings)}}, {{"kind", "wall"}}));
  }
}

void add_stations(const LocalPlane& plane, const ExportRecord& record, Json& features) {
  const Mission& mission = record.mission;
  const EndSchedule ends(mission, record.run.holds(), record.run.amendments.ends());
  constexpr Tick kAtTheEnd = std::numeric_limits<Tick>::max();
  for (AgentId agent = 0; agent < static_cast<AgentId>(mission.starts_m.size()); ++agent) {
    const auto station_m = station_of(mission, agent);
    if (!station_m) continue;
    Json place = position_of(plane, station_m->head<2>());
    if (!mission.domain.planar()) place.push_back(station_m->z());
    const double from_s =
        static_cast<double>(ends.rest_from(mission, agent, kAtTheEnd)) * mission.timing.dt_s;
    features.push_back(feature({{"type", "Point"}, {"coordinates", std::move(place)}},
                               {{"kind", "station"}, {"agent", agent}, {"rests_from_s", from_s}}));
  }
}

/// A polygon for each zone that was received, with the times of world's ticks as tracks have them.
void add_zones(const LocalPlane& plane, const ExportRecord& record, Json& features) {
  const auto t_s = [&record](Tick tick) {
    return static_cast<double>(tick) * record.mission.timing.dt_s;
  };
  for (const ReceivedAmendment& one : record.run.amendments.all()) {
    if (!one.zone || one.is_void) continue;
    const Zone& zone = *one.zone;
    Json properties = {{"kind", "zone"},
                       {"amendment", zone.number},
                       {"closed_from_s", t_s(zone.closed)},
                       {"free_from_s", t_s(zone.from)},
                       {"until_s", t_s(zone.end())}};
    if (zone.cancelled >= 0) properties["cancelled"] = true;
    if (zone.high_m > zone.low_m) properties["heights_m"] = {zone.low_m, zone.high_m};
    Json rings = Json::array({ring_json(plane, zone.corners_m, false)});
    features.push_back(
        feature({{"type", "Polygon"}, {"coordinates", std::move(rings)}}, std::move(properties)));
  }
}

Json track_feature(const LocalPlane& plane, const ExportRecord& record, AgentId agent,
                   const Track& track) {
  Json line = Json::array();
  for (const TrackPoint& point : track) {
    line.push_back(position_of(plane, point.x_m.head<2>()));
    if (!record.mission.domain.planar()) line.back().push_back(point.x_m.z());
  }
  const Json properties = {{"kind", "track"},
                           {"agent", agent},
                           {"from_s", track.front().t_s},
                           {"until_s", track.back().t_s}};
  // A line needs two positions.
  if (track.size() == 1) return feature({{"type", "Point"}, {"coordinates", line[0]}}, properties);
  return feature({{"type", "LineString"}, {"coordinates", line}}, properties);
}

}  // namespace

std::optional<std::string> write_geojson(const ExportRecord& record,
                                         const std::filesystem::path& file) {
  const LocalPlane plane(record.origin.value());
  Json features = Json::array({domain_feature(plane, record)});
  add_walls(plane, record.mission.walls, features);
  add_stations(plane, record, features);
  add_zones(plane, record, features);
  for (const auto& [agent, track] : record.run.tracks)
    features.push_back(track_feature(plane, record, agent, track));
  std::ofstream out(file, std::ios::binary);
  out << Json{{"type", "FeatureCollection"}, {"features", std::move(features)}}.dump(
             -1, ' ', false, Json::error_handler_t::replace)
      << '\n';
  out.close();
  if (!out) return file.string() + ": " + std::strerror(errno);
  return std::nullopt;
}

}  // namespace ergocast
