// SPDX-License-Identifier: BSD-3-Clause
// Messages in JSON as Foxglove's well-known schemas name and shape them. The texts of the schemas
// are ours; they have the fields that we write.
#pragma once

#include <cstdint>
#include <string>

#include "export/record.h"

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
/// @param basis  what φ² is in
std::string metrics(std::uint64_t time_ns, const MetricsRow& row, const std::string& basis);

}  // namespace ergocast::foxglove
