// SPDX-License-Identifier: BSD-3-Clause
// Reads the polygons of a GeoJSON file (RFC 7946).
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "target/geo/geo_polygon.h"
#include "target/geo/polygon_file.h"

namespace ergocast {

/// All Polygons and MultiPolygons of a FeatureCollection, a Feature or a geometry, at least one
/// with rings; features with a null geometry and empty polygons have none. Heights are not used.
/// Anything else is a problem: other geometries, another reference system, rings that are not
/// closed or have fewer than four positions, impossible coordinates.
Result<std::vector<GeoPolygon>, PolygonFileProblem> read_geojson(const std::filesystem::path& file);
Result<std::vector<GeoPolygon>, PolygonFileProblem> parse_geojson(std::string_view text);

}  // namespace ergocast
