// SPDX-License-Identifier: BSD-3-Clause
// Files that GDAL reads for us: GeoPackages, shapefiles, GeoTIFF, in any reference system.
//
// GDAL runs in a bounded child process, with a driver for the kind that the name says and no other.
// Whatever it reports is a problem.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/result.h"
#include "target/geo/geo_polygon.h"
#include "target/geo/polygon_file.h"
#include "target/maps/map_file.h"

namespace ergocast {

/// Cells of a GeoTIFF along a side of the domain.
/// Limit (Files of a scenario): columns and rows of a GeoTIFF in the domain. Beyond it: the
/// scenario is refused.
inline constexpr int kMaxGeoTiffSide = 4096;

/// The name under which GDAL opens a file, and nothing else: it is absolute. Nothing for files in
/// folders that GDAL takes for virtual ones.
std::optional<std::string> gdal_name(const std::filesystem::path& file);

/// Whether read_gdal_polygons() reads a file of this name: .gpkg and .shp.
bool is_gdal_polygons(const std::filesystem::path& file);

/// All polygons of all layers, at least one; heights are not used. Features without a geometry or
/// with another one, and layers that do not say where on the earth they lie, are problems.
Result<std::vector<GeoPolygon>, PolygonFileProblem> read_gdal_polygons(
    const std::filesystem::path& file);

/// The part of a GeoTIFF that meets the domain, on cells of the file's size at the domain's centre.
/// Each has the value of the file's cell at its centre: 0 outside the file, where its mask is, and
/// where it has no data.
/// @param origin  the place of the scenario's (0, 0)
OpenedMap open_geotiff(const std::filesystem::path& file, const GeoPlace& origin,
                       const Box& domain);

}  // namespace ergocast
