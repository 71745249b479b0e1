// SPDX-License-Identifier: BSD-3-Clause
// Reads the polygons of a KML file, as ground stations and Google Earth write it.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "target/geo/geo_polygon.h"
#include "target/geo/polygon_file.h"

namespace ergocast {

/// All polygons of all placemarks, at least one; heights and styles are not used. Other shapes,
/// misspelt ones, links to other files and impossible coordinates are problems: GDAL leaves most of
/// them out without a word.
Result<std::vector<GeoPolygon>, PolygonFileProblem> read_kml(const std::filesystem::path& file);
Result<std::vector<GeoPolygon>, PolygonFileProblem> parse_kml(std::string_view text);

}  // namespace ergocast
