// SPDX-License-Identifier: BSD-3-Clause
// Writes a record in the formats of other tools; docs/export.md describes each file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "report/export/record.h"

namespace ergocast {

/// One MCAP file with poses, densities, metrics, amendments and log lines. Returns nullopt on
/// success, else the error.
std::optional<std::string> write_mcap(const ExportRecord& record,
                                      const std::filesystem::path& file);

/// The same with messages of ROS 2, on the topics of `ergocast-ros2`.
std::optional<std::string> write_ros2_mcap(const ExportRecord& record,
                                           const std::filesystem::path& file);

/// A folder with trajectory.csv, metrics.csv, density.csv, log.csv and, if the mission changed,
/// amendments.csv.
std::optional<std::string> write_tables(const ExportRecord& record,
                                        const std::filesystem::path& folder);

/// One FeatureCollection with the domain, its walls, the stations and each agent's track.
/// @pre the record has an origin
std::optional<std::string> write_geojson(const ExportRecord& record,
                                         const std::filesystem::path& file);

}  // namespace ergocast
