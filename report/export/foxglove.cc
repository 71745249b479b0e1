// SPDX-License-Identifier: BSD-3-Clause
// Times are {sec, nsec}, bytes are base64, enumerations are numbers.
#include "report/export/foxglove.h"

#include <bit>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "report/base64.h"

namespace ergocast::foxglove {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFrame = "ergocast";
constexpr int kFloat32 = 7;  // one of Foxglove's numeric types

Json time_of(std::uint64_t time_ns) {
  constexpr std::uint64_t kSecond_ns = 1'000'000'000;
  return {{"sec", time_ns / kSecond_ns}, {"nsec", time_ns % kSecond_ns}};
}

Json pose_at(const Eigen::Vector3d& x_m, double heading_rad) {
  return {{"position", {{"x", x_m.x()}, {"y", x_m.y()}, {"z", x_m.z()}}},
          {"orientation",
           {{"x", 0.0},
            {"y", 0.0},
            {"z", std::sin(heading_rad / 2)},
            {"w", std::cos(heading_rad / 2)}}}};
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// ---- JSON Schemas ----

const Json kText = {{"type", "string"}}, kNumber = {{"type", "number"}},
           kInteger = {{"type", "integer"}};

Json object_of(Json properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}};
}
Json list_of(const Json& element) { return {{"type", "array"}, {"items", element}}; }

const Json kPose = object_of(
    {{"position", object_of({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}})},
     {"orientation", object_of({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}, {"w", kNumber}})}});

/// A schema with a time stamp before these properties.
Schema schema_of(const char* name, const Json& properties) {
  Json all = {{"timestamp", object_of({{"sec", kInteger}, {"nsec", kInteger}})}};
  all.update(properties);
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", name}};
  schema.update(object_of(std::move(all)));
  return {name, text_of(schema)};
}

/// Little-endian; rows from south to north, each from west to east.
std::string bytes_of(const DensityCells& cells) {
  std::string bytes;
  for (Eigen::Index j = 0; j < cells.cols(); ++j) {
    for (Eigen::Index i = 0; i < cells.rows(); ++i) {
      const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(cells(i, j)));
      for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<char>(bits >> shift & 0xff));
    }
  }
  return bytes;
}

}  // namespace

const Schema& pose_schema() {
  static const Schema schema =
      schema_of("foxglove.PoseInFrame", {{"frame_id", kText}, {"pose", kPose}});
  return schema;
}

const Schema& location_schema() {
  static const Schema schema =
      schema_of("foxglove.LocationFix", {{"frame_id", kText},
                                         {"latitude", kNumber},
                                         {"longitude", kNumber},
                                         {"altitude", kNumber},
                                         {"position_covariance", list_of(kNumber)},
                                         {"position_covariance_type", kInteger}});
  return schema;
}

const Schema& grid_schema() {
  static const Json field = object_of({{"name", kText}, {"offset", kInteger}, {"type", kInteger}});
  static const Schema schema =
      schema_of("foxglove.Grid", {{"frame_id", kText},
                                  {"pose", kPose},
                                  {"column_count", kInteger},
                                  {"cell_size", object_of({{"x", kNumber}, {"y", kNumber}})},
                                  {"row_stride", kInteger},
                                  {"cell_stride", kInteger},
                                  {"fields", list_of(field)},
                                  {"data", {{"type", "string"}, {"contentEncoding", "base64"}}}});
  return schema;
}

const Schema& log_schema() {
  static const Schema schema = schema_of("foxglove.Log", {{"level", kInteger},
                                                          {"message", kText},
                                                          {"name", kText},
                                                          {"file", kText},
                                                          {"line", kInteger}});
  return schema;
}

const Schema& metrics_schema() {
  static const Schema schema = schema_of("ergocast.Metrics", {{"tick", kInteger},
                                                              {"t_s", kNumber},
                                                              {"ergodic_metric", kNumber},
                                                              {"basis", kText},
                                                              {"detection_probability", kNumber},
                                                              {"metric_spread", kNumber},
                                                              {"max_staleness_s", kNumber},
                                                              {"contributions_received", kNumber},
                                                              {"contributions_lost", kNumber},
                                                              {"blocked_share", kNumber}});
  return schema;
}

std::string pose(std::uint64_t time_ns, const TrackPoint& point) {
  return text_of({{"timestamp", time_of(time_ns)},
                  {"frame_id", kFrame},
                  {"pose", pose_at(point.x_m, std::atan2(point.v_mps.y(), point.v_mps.x()))}});
}

std::string location(std::uint64_t time_ns, const GeoPlace& place, double height_m) {
  return text_of({{"timestamp", time_of(time_ns)},
                  {"frame_id", kFrame},
                  {"latitude", place.latitude_deg},
                  {"longitude", place.longitude_deg},
                  {"altitude", height_m},
                  {"position_covariance", std::vector<double>(9, 0.0)},
                  {"position_covariance_type", 0}});
}

std::string grid(std::uint64_t time_ns, const DensityCells& cells, const Mission& mission) {
  const Eigen::Vector2d size_m = mission.domain.size_m.head<2>();
  constexpr int kBytes = 4;
  return text_of(
      {{"timestamp", time_of(time_ns)},
       {"frame_id", kFrame},
       {"pose", pose_at(mission.domain.origin_m, 0)},
       {"column_count", cells.rows()},
       {"cell_size",
        {{"x", size_m.x() / static_cast<double>(cells.rows())},
         {"y", size_m.y() / static_cast<double>(cells.cols())}}},
       {"row_stride", cells.rows() * kBytes},
       {"cell_stride", kBytes},
       {"fields", Json::array({{{"name", "density"}, {"offset", 0}, {"type", kFloat32}}})},
       {"data", base64(bytes_of(cells))}});
}

std::string log(const ExportedLine& line) {
  static const std::map<std::string, int> kLevels = {{"trace", 1},   {"debug", 1}, {"info", 2},
                                                     {"warning", 3}, {"error", 4}, {"critical", 5}};
  const auto level = kLevels.find(line.level);
  return text_of({{"timestamp", time_of(line.time_ns)},
                  {"level", level == kLevels.end() ? 0 : level->second},
                  {"message", line.text},
                  {"name", line.process},
                  {"file", ""},
                  {"line", 0}});
}

std::string metrics(std::uint64_t time_ns, const MetricsRow& row, const std::string& basis) {
  return text_of({{"timestamp", time_of(time_ns)},
                  {"tick", row.tick},
                  {"t_s", row.t_s},
                  {"ergodic_metric", row.ergodic_metric},
                  {"basis", basis},
                  {"detection_probability", row.detection_probability},
                  {"metric_spread", row.spread},
                  {"max_staleness_s", row.max_staleness_s},
                  {"contributions_received", row.received},
                  {"contributions_lost", row.lost},
                  {"blocked_share", row.blocked_share}});
}

}  // namespace ergocast::foxglove
