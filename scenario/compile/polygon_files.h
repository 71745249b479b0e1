// SPDX-License-Identifier: BSD-3-Clause
// Replaces the names of files of polygons by the polygons in them, in metres.
#pragma once

#include <filesystem>
#include <vector>

#include "scenario/compile/map_rooms.h"
#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Whether the name is one of GeoJSON, KML, a GeoPackage or a shapefile.
bool is_geodata(const std::filesystem::path& file);
/// Whether it is geodata or a drawing.
bool is_polygon_file(const std::filesystem::path& file);

struct PolygonFiles {
  std::vector<std::filesystem::path> files;  ///< all, also the pictures of occupancy maps
  std::vector<MapRooms> maps;                ///< of occupancy maps
};

/// Reads the file of each polygon that has one. The first polygon in it takes the place of the
/// name, the others follow at the end of the list; those that lie apart from the domain are left
/// out. The polygons of a region share its weight by their areas. Reports problems of a file with
/// its member; the name of such a file stays.
/// @pre the defaults are filled in
PolygonFiles read_polygon_files(proto::Scenario& scenario, Checks& checks, Findings& findings);

}  // namespace ergocast
