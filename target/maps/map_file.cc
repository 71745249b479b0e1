// SPDX-License-Identifier: BSD-3-Clause
// Chooses the reader by the extension of the file's name, and checks size and dimensions first.
#include "target/maps/map_file.h"

#include <algorithm>

#include "target/maps/ascii_grid.h"
#include "target/maps/csv_map.h"
#include "target/maps/picture_map.h"
#include "target/maps/png_map.h"
#include "text/input_file.h"

namespace ergocast {
namespace fs = std::filesystem;

std::optional<MapProblem> why_unreadable(const fs::path& file) {
  InputFile in(file);
  if (const auto& problem = in.problem()) {
    if (problem->kind == FileProblem::Kind::kMissing) {
      return MapProblem{file.string() + ": there is no such file",
                        "check the name; it counts from the scenario file's folder"};
    }
    const bool other = problem->kind == FileProblem::Kind::kNoFile;
    return MapProblem{file.string() + ' ' + problem->what,
                      other ? "name the map itself" : problem->remedy};
  }
  const int first = in.peek();
  if (first == InputFile::traits_type::eof())
    return MapProblem{file.string() + " is empty", "write the map again"};
  if (first == 0xff || first == 0xfe)
    return MapProblem{file.string() + " is in UTF-16",
                      "convert it: iconv -f UTF-16 -t UTF-8 in > out"};
  if (first == 0xef)
    return MapProblem{file.string() + " begins with a byte order mark",
                      "remove it: sed -i '1s/^\\xEF\\xBB\\xBF//' FILE"};
  return {};
}

std::optional<MapKind> map_kind(const fs::path& file) {
  std::string end = file.extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (end == ".png") return MapKind::kPng;
  if (end == ".pgm") return MapKind::kPgm;
  if (end == ".yaml" || end == ".yml") return MapKind::kOccupancy;
  if (end == ".csv") return MapKind::kCsv;
  if (end == ".asc") return MapKind::kAsciiGrid;
  if (end == ".tif" || end == ".tiff") return MapKind::kGeoTiff;
  return {};
}

OpenedMap open_map(const fs::path& file) {
  if (auto problem = why_unreadable(file)) return failure(*problem);
  switch (map_kind(file).value()) {
    case MapKind::kPng:
      return open_png_map(file);
    case MapKind::kPgm:
      return open_pgm_map(file);
    case MapKind::kOccupancy:
      return open_occupancy_target(file);
    case MapKind::kCsv:
      return open_csv_map(file);
    default:
      return open_ascii_grid(file);
  }
}

std::optional<MapProblem> check_dimensions(const fs::path& file, long long columns,
                                           long long rows) {
  if (columns >= 1 && rows >= 1 && columns <= kMaxMapSide && rows <= kMaxMapSide) return {};
  const std::string limit = std::to_string(kMaxMapSide);
  return MapProblem{file.string() + " has " + std::to_string(columns) + " columns and " +
                        std::to_string(rows) + " rows; the limits are 1 and " + limit,
                    "scale it to at most " + limit + " x " + limit};
}

}  // namespace ergocast
