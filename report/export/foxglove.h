// SPDX-License-Identifier: BSD-3-Clause
// JSON messages with the names and fields of Foxglove's well-known schemas. The texts of the
// schemas are ours; they have the fields that we write.
#pragma once

#include <cstdint>
#include <string>

#include "report/export/record.h"

namespace ergocast::foxglove {

struct Schema {
  std::string name, text;
};
const Schema& pose_schema();      ///< foxglove.PoseInFrame
const Schema& location_schema();  ///< foxglove.LocationFix
const Schema& grid_schema();      ///< foxglove.Grid
const Schema& log_schema();       ///< foxglove.Log
/// ergocast.Metrics is ours: Foxglove has no schema for a row of numbers.
const Schema& metrics_schema();

/// x is east, y north; the heading is that of the velocity.
std::string pose(std::uint64_t time_ns, const TrackPoint& point);
std::string location(std::uint64_t time_ns, const GeoPlace& place, double height_m);
std::string grid(std::uint64_t time_ns, const DensityCells& cells, const Mission& mission);
std::string log(const ExportedLine& line);
/// @param basis  the basis of φ²
std::string metrics(std::uint64_t time_ns, const MetricsRow& row, const std::string& basis);

}  // namespace ergocast::foxglove
