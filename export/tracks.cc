// SPDX-License-Identifier: BSD-3-Clause
// GeoJSON (RFC 7946): longitude before latitude, outlines counter-clockwise.
#include <cerrno>
#include <cstring>
#include <fstream>

#include "export/exports.h"

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
    for (const char* key : {"run_id", "result", "started", "seed", "ticks"}) {
      if (record.summary.contains(key)) properties[key] = record.summary[key];
    }
  }
  return feature({{"type", "Polygon"}, {"coordinates", Json::array({ring})}}, properties);
}

Json track_feature(const LocalPlane& plane, AgentId agent, const Track& track) {
  Json line = Json::array();
  for (const TrackPoint& point : track) line.push_back(position_of(plane, point.x_m));
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
  for (const auto& [agent, track] : record.run.tracks)
    features.push_back(track_feature(plane, agent, track));
  std::ofstream out(file, std::ios::binary);
  out << Json{{"type", "FeatureCollection"}, {"features", std::move(features)}}.dump(
             -1, ' ', false, Json::error_handler_t::replace)
      << '\n';
  out.close();
  if (!out) return file.string() + ": " + std::strerror(errno);
  return std::nullopt;
}

}  // namespace ergocast
